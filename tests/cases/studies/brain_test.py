"""The study of the brain: what its README says of the picture in Debian's package mricron-data.

usage: brain_test.py SPRINGPROOF SOURCE_FOLDER FOLDER body|replay

body: the cubes, masses and springs. replay: the whole recording in both models, with three designs, judged by `gate` against finite elements
on the same cells and on cells that are halved (some minutes each).
Without the package nothing is solved, and CTest counts the test as skipped.
"""

import pathlib
import subprocess
import sys

PROGRAM, SOURCE, FOLDER = (pathlib.Path(word).resolve() for word in sys.argv[1:4])
CASE = SOURCE / "cases/studies/brain/brain.toml"
RECORDING = SOURCE / "cases/studies/brain/pulls.csv"
PICTURE = pathlib.Path("/usr/share/mricron/templates/ch2bet.nii.gz")
# Percent of the finite elements' displacement, of the surface and of the crown; regression pins, as they were first solved. The first are the case's
# own expectations.
SAME_CELLS = {"hybrid": (11.96, 11.91), "matched": (11.07, 10.93)}
HALVED_CELLS = {"given": (34.04, 28.77), "hybrid": (22.64, 22.59), "matched": (21.72, 21.73)}


def run(*words):
    done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 0, (words, done.returncode, done.stdout, done.stderr)
    return done.stdout


def n_rows(path):
    return len(path.read_text().splitlines()) - 1


def check_body():
    out = FOLDER / "springs"
    run("export", CASE, "--to", "csv", "--out", out)
    assert n_rows(out / "nodes.csv") == 706 and n_rows(out / "springs.csv") == 6771, out
    held = [row.split(",")[4] for row in (out / "nodes.csv").read_text().splitlines()[1:]]
    assert held.count("1") == 29, held


def check_replay(design, refine, pins):
    """Within a tenth: instruction sets and the tolerance of a step change far less."""
    settings = [f"fem.refine={refine}"]
    if design != "given":
        settings.append(f'msm={{design="{design}", mass="uniform"}}')
    if pins:
        expected = (f'{{measure="{name}", error_percent=[{0.9 * value}, {1.1 * value}], reference="regression", reason="a tenth"}}'
                    for name, value in zip(("surface", "crown"), pins))
        settings.append(f"expect=[{', '.join(expected)}]")
    run("gate", CASE, "--replay", RECORDING, *(word for setting in settings for word in ("--set", setting)))


def main():
    if not PICTURE.exists():
        print(f"{PICTURE} is not here (package mricron-data): nothing was compared")
        return
    FOLDER.mkdir(parents=True, exist_ok=True)
    if sys.argv[4] == "body":
        check_body()
    else:
        check_replay("given", 0, None)
        for refine, pins_of in enumerate((SAME_CELLS, HALVED_CELLS)):
            for design, pins in pins_of.items():
                check_replay(design, refine, pins)
    print("the brain is as its README says")


if __name__ == "__main__":
    main()
