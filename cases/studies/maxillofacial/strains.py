"""The largest principal strain of the sample's cells, both methods in both models, on the deformed block seen from the side.

usage: strains.py OUT    after `springproof run sample_sdm_4.toml --out OUT` and the same of sample_rm_4.toml

Writes OUT/strains.png. Needs gnuplot and Python's standard library.
"""

import pathlib
import re
import struct
import subprocess
import sys

HERE, OUT = pathlib.Path(__file__).resolve().parent, pathlib.Path(sys.argv[1])


def arrays_of(path):
    """The arrays of a .vtu with raw appended data: name -> numbers."""
    content = path.read_bytes()
    begin = content.index(b"_", content.index(b"<AppendedData")) + 1
    arrays = {}
    for tag in re.findall(rb"<DataArray[^>]*>", content[:begin]):
        of = dict(re.findall(rb'(\w+)="([^"]*)"', tag))
        at = begin + int(of[b"offset"])
        code = {b"Float64": "d", b"Float32": "f", b"Int64": "q", b"UInt8": "B"}[of[b"type"]]
        size = struct.unpack_from("<Q", content, at)[0]
        arrays[of[b"Name"].decode()] = struct.unpack_from(f"<{size // struct.calcsize(code)}{code}", content, at + 8)
    return arrays


def largest_principal(strain):
    """Largest principal value of xx, yy, zz, xy, yz, xz; both sides of the block are held in y, so that y is a principal direction."""
    xx, yy, zz, _, _, xz = strain
    return max(yy, (xx + zz) / 2 + ((xx - zz)**2 / 4 + xz**2) ** 0.5)


def front_of(path, model):
    """Blocks for gnuplot's pm3d: of every cell at y = 0 its face's corners, x and z deformed, and its strain."""
    arrays = arrays_of(path)
    points, moved = ([values[3 * n:3 * n + 3] for n in range(len(values) // 3)] for values in
                     (arrays["rest position"], arrays[f"{model}_displacement"]))
    cells, width = arrays["connectivity"], 8
    strain = arrays[f"{model}_strain"]
    for c in range(len(cells) // width):
        front = sorted((n for n in cells[width * c:width * (c + 1)] if abs(points[n][1]) < 1e-9), key=lambda n: points[n][::-1])
        if len(front) != 4:
            continue
        rows = [f"{points[n][0] + moved[n][0]:.5f} {points[n][2] + moved[n][2]:.5f} {largest_principal(strain[6 * c:6 * c + 6]):.6f}" for n in front]
        yield "\n".join([*rows[:2], "", *rows[2:], "", ""])


for method in ("sdm", "rm"):
    for model in ("fem", "msm"):
        (OUT / f"{method}_{model}.dat").write_text("\n".join(front_of(OUT / f"sample-{method}-4.vtu", model)))
subprocess.run(["gnuplot", "-e", f"out='{OUT}'", HERE / "strains.gp"], check=True)
