"""A new user's first afternoon: from a template to a gate, a comparison of designs, a foreign result, an export and a page.

usage: first_afternoon.py SPRINGPROOF FOLDER

A block of liver that a round patch presses. FOLDER receives what the user would have at the end, pictures of the page among it. Only
Python's standard library and Chromium are used.
"""

import base64
import json
import shutil
import struct
import subprocess
import sys
import xml.etree.ElementTree as xml
import zlib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "report"))
from chromium import DARK, find_chromium, run_chromium  # noqa: E402

AS_IT_IS = ("--set", "fem.accuracy=none")  # the limit of this case takes 10 s each time
PROGRAM, FOLDER = Path(sys.argv[1]).resolve(), Path(sys.argv[2]).resolve()

BODY = """
[body]
shape = "box"
size = [60, 40, 20]
cells = [12, 8, 4]

[material]
model = "linear_elastic"
youngs_modulus = 0.008
poissons_ratio = 0.45

[[fixed]]
region = "z-"

[[moved]]
near = [30, 20, 20]
radius = 6
displacement = [0, 0, -2]

[msm]
design = "hybrid"

[[measure]]
name = "surface" # a point of the top, 15 mm beside the patch
kind = "displacement"
node = "near 30 35 20"
component = "z"

[[measure]]
name = "grip" # the force that presses
kind = "reaction"
near = [30, 20, 20]
radius = 6
component = "z"

[[measure]]
name = "bed" # the force that the table answers with
kind = "reaction"
region = "z-"
component = "z"

[[measure]]
name = "pressure" # below the patch
kind = "stress"
point = [30, 20, 10]
component = "zz"
"""

EXPECTATIONS = """
[[expect]]
measure = "grip"
error_percent = [-50, 50]
reference = "converged"
reason = "Half the force either way: what the hand still takes for liver."

[[expect]]
measure = "surface"
error_percent = [-1, 1]
reference = "converged"
reason = "More than these springs can keep."
"""


def springproof(*words, status=0):
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=FOLDER, capture_output=True, text=True, timeout=900)
    assert done.returncode == status, (words, done.returncode, done.stdout[-3000:], done.stderr[-3000:])
    return done.stdout


def write_the_case():
    """A template, filled in."""
    assert "liver.toml" in springproof("new", "liver")
    template = (FOLDER / "liver.toml").read_text()
    springproof("run", "liver.toml")  # a template runs as it is
    head = template[:template.index("[body]")].replace("One sentence on what it shows.", "A block of liver is pressed by a round patch")
    (FOLDER / "liver.toml").write_text(head + BODY)


def read_the_answer():
    """Reactions and errors, with their bars, and both fields."""
    said = springproof("run", "liver.toml", "--converge=3", "--out", "out", "--json")
    [case] = json.loads(said)["cases"]
    assert case["status"] == "converged", case
    measures = {measure["name"]: measure for measure in case["measures"]}
    for name, unit in (("surface", "mm"), ("grip", "N"), ("bed", "N"), ("pressure", "MPa")):
        measure = measures[name]
        assert measure["unit"] == unit, measure
        assert abs(measure["fem"]) > 0 and abs(measure["msm"]) > 0, measure
        # Three meshes show no limit of the pressure yet, and a note says so.
        assert measure["error_uncertainty_percent"] or (name == "pressure" and measure["fem_limit_note"]), measure
    # The tool presses down, the table up: together nothing, in either model.
    for side in ("fem", "msm"):
        grip, bed = measures["grip"][side], measures["bed"][side]
        assert grip < 0 < bed and abs(grip + bed) <= 1e-6 * bed, (side, grip, bed)
    text = springproof("run", "liver.toml", "--converge=3", "--out", "out")  # solved already
    for line in text.splitlines():
        if line.split()[:1] == ["grip"] and "+-" in line:
            break
    else:
        raise AssertionError(text)
    assert (FOLDER / "out/liver.vtu").stat().st_size > 0 and (FOLDER / "out/liver_springs.vtu").stat().st_size > 0
    return measures


def compare_designs():
    said = springproof("run", "liver.toml", *AS_IT_IS, "--designs", "hybrid,matched,moduli")
    assert all(design in said for design in ("hybrid", "matched", "moduli")), said
    return said


def make_the_gate():
    """One expectation that these springs meet and one that they miss: the exit status and the JUnit file say which."""
    (FOLDER / "gated.toml").write_text((FOLDER / "liver.toml").read_text() + EXPECTATIONS)
    springproof("gate", "gated.toml", "--junit", "gates.xml", status=1)
    cases = list(xml.parse(FOLDER / "gates.xml").getroot().iter("testcase"))
    failed = [case.get("name") for case in cases if case.find("failure") is not None]
    assert len(cases) >= 2 and len(failed) == 1 and "surface" in failed[0], (cases, failed)


def foreign_result(measures):
    """Our own springs' answer as another program would leave it: compressed, in base64, in single precision."""
    points, displacement = arrays_of((FOLDER / "out/liver.vtu").read_bytes(), ("rest position", "msm_displacement"))

    def packed(code, values):
        raw = struct.pack(f"<{len(values)}{code}", *values)
        block = zlib.compress(raw)
        head = struct.pack("<4I", 1, len(raw), len(raw), len(block))  # blocks, sizes, compressed size
        return (base64.b64encode(head) + base64.b64encode(block)).decode()

    n = len(points) // 3
    (FOLDER / "foreign.vtu").write_text(f"""<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian" header_type="UInt32" compressor="vtkZLibDataCompressor">
<UnstructuredGrid><Piece NumberOfPoints="{n}" NumberOfCells="{n}">
<Points><DataArray type="Float32" Name="Points" NumberOfComponents="3" format="binary">{packed("f", points)}</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="binary">{packed("q", range(n))}</DataArray>
<DataArray type="Int64" Name="offsets" format="binary">{packed("q", range(1, n + 1))}</DataArray>
<DataArray type="UInt8" Name="types" format="binary">{packed("B", [1] * n)}</DataArray></Cells>
<PointData><DataArray type="Float32" Name="u" NumberOfComponents="3" format="binary">{packed("f", displacement)}</DataArray></PointData>
</Piece></UnstructuredGrid></VTKFile>
""")
    geometry = FOLDER / "motion.toml"  # a displacement alone tells no force
    text = (FOLDER / "liver.toml").read_text()
    geometry.write_text(text[:text.index('[[measure]]\nname = "grip"')])
    [case] = json.loads(springproof("run", "motion.toml", *AS_IT_IS, "--msm-displacements", "foreign.vtu", "--json"))["cases"]
    [surface] = case["measures"]
    assert abs(surface["msm"] - measures["surface"]["msm"]) <= 1e-6 * 2, (surface, measures["surface"])


def arrays_of(content, names):
    """Doubles of a .vtu that keeps them raw."""
    head, _, raw = content.partition(b'<AppendedData encoding="raw">')
    raw = raw[raw.index(b"_") + 1:]
    found = []
    for name in names:
        at = head.index(b'Name="' + name.encode() + b'"')
        words = head[head.rindex(b"<DataArray", 0, at):head.index(b">", at)]
        offset = int(words.split(b'offset="')[1].split(b'"')[0])
        (size,) = struct.unpack_from("<Q", raw, offset)
        found.append(struct.unpack_from(f"<{size // 8}d", raw, offset + 8))
    return found


def export():
    """SOFA's scene has the volume terms, which SOFA itself has not, in numpy beside it."""
    springproof("export", "liver.toml", "--to", "sofa", "--out", "sofa")
    assert (FOLDER / "sofa/forces.py").exists() and (FOLDER / "sofa/check.csv").exists()
    scene = json.loads((FOLDER / "sofa/scene.json").read_text())
    assert len(scene["positions"]) == 13 * 9 * 5 and scene["start"], scene.keys()
    springproof("export", "liver.toml", "--to", "csv", "--out", "csv")


def open_the_page():
    """The case's page, with its designs, as wide and narrow screens show it by day and by night."""
    springproof("run", "liver.toml", "--converge=3", "--out", "out", "--report", "--designs", "hybrid,matched")
    page = FOLDER / "out" / "liver.html"
    assert (FOLDER / "out" / "liver_bodies" / "bodies.png").stat().st_size > 1000
    if not find_chromium():
        return
    for width in (1400, 400):
        for name, options in (("light", ()), ("dark", (DARK,))):
            picture = FOLDER / f"page_{width}_{name}.png"
            run_chromium(page, f"--window-size={width},1000", f"--screenshot={picture}", "--virtual-time-budget=5000", *options)
            assert picture.stat().st_size > 10_000, picture


def main():
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    write_the_case()
    measures = read_the_answer()
    compare_designs()
    make_the_gate()
    foreign_result(measures)
    export()
    open_the_page()


main()
