"""The study of the head: what its README says of the CT in Debian's package invesalius-examples.

usage: head_test.py SPRINGPROOF SOURCE_FOLDER FOLDER

Without the package nothing is solved, and CTest counts the test as skipped.
"""

import json
import pathlib
import subprocess
import sys

PROGRAM, SOURCE, FOLDER = (pathlib.Path(word).resolve() for word in sys.argv[1:])
STUDY = SOURCE / "cases/studies/maxillofacial"
PICTURE = pathlib.Path("/usr/share/doc/invesalius-examples/examples/Cranium.inv3")
LEAST_OF_THESIS = 0.37  # mm: the smallest mean of table 6.1, the simulation against the operated face


def run(case, *options):
    done = subprocess.run([PROGRAM, "run", STUDY / case, "--json", *options], capture_output=True, text=True, check=False)
    assert done.returncode == 0, (case, done.returncode, done.stderr)
    return json.loads(done.stdout)["cases"][0]


def check_head():
    out = FOLDER / "out"
    head = run("head.toml", "--out", out, "--report")
    for side in ("fem", "msm"):
        assert head[side]["status"] == "converged" and head[side]["unknowns"] == 631668, head[side]
        assert head[side]["residual"] <= 1e-9, head[side]
    assert len(head["landmarks"]) == 8
    for landmark in head["landmarks"]:
        assert landmark["n_rays"] == 5 and landmark["mean"] < LEAST_OF_THESIS, landmark
    moved = {landmark["name"]: landmark["moved"] for landmark in head["landmarks"]}
    plan = (3**2 + 2**2) ** 0.5  # mm: skin follows the bone, and hardly where bone is held
    assert all(0.8 * plan < moved[name] < 1.1 * plan for name in moved if not name.startswith("cheekbone")), moved
    assert all(moved[name] < 0.2 * plan for name in moved if name.startswith("cheekbone")), moved
    assert (out / "maxillofacial-head.html").stat().st_size > 1_000_000


def check_refinement():
    """The finite elements' own error on the crop is far below the springs'."""
    coarse, fine = (run("head_crop.toml", "--set", f"fem.refine={n}") for n in (0, 1))
    for before, after in zip(coarse["measures"], fine["measures"]):
        assert abs(after["fem"] / before["fem"] - 1) < 0.005, (before, after)


def main():
    if not PICTURE.exists():
        print(f"{PICTURE} is not here (package invesalius-examples): nothing was compared")
        return
    FOLDER.mkdir(parents=True, exist_ok=True)
    check_refinement()
    check_head()
    print("the head is as its README says")


if __name__ == "__main__":
    main()
