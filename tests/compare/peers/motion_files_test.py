"""Motions that another program leaves in files: every form gives the inside path's numbers, and no broken one is believed.

usage: motion_files_test.py SPRINGPROOF SOURCE_FOLDER
"""

import csv
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM, SOURCE = (str(Path(argument).resolve()) for argument in sys.argv[1:3])
CASE = f"""{(Path(SOURCE) / "cases/studies/released_bar.toml").read_text()}
[[measure]]
name = "volume"
kind = "volume"
over_time = "peak"

[[expect]]
measure = "course"
error_percent = [0, 100]
reference = "requirement"
reason = "the same motion"
"""
N_STEPS, STEP, SIZE = 10, 0.002, ("--set", "body.cells=[3,1,1]", "--set", "dynamics.end=0.02")
MEASURES = tuple(word for n in (0, 1, 2) for word in ("--set", f"measure[{n}].over_time={('peak', 'peak_time', 'end')[n]}"))


def springproof(*words, case="bar.toml", folder):
    command = [PROGRAM, words[0], case, *SIZE, *MEASURES, *map(str, words[1:])]
    return subprocess.run(command, capture_output=True, text=True, timeout=600, cwd=folder)


def measures(folder, *words):
    done = springproof("run", *words, "--json", folder=folder)
    assert done.returncode == 0, done
    return json.loads(done.stdout)["cases"][0]


def make_motion(folder):
    (folder / "bar.toml").write_text(CASE)
    return measures(folder, "--out", "ours")


def copied(folder, name):
    """Our files, numbered by the steps."""
    shutil.copytree(folder / "ours/released-bar_motion", folder / name)
    return sorted(path.name for path in (folder / name).iterdir())


def bodies():
    """A motion by a formula: rows of every node for each step."""
    nodes = [(x, y, z) for x in (0, 40 / 3, 80 / 3, 40) for y in (0, 10) for z in (0, 10)]
    for k in range(N_STEPS + 1):
        yield STEP * k, [f"{x!r},{y},{z},0,0,{-1e-4 * x * x * k!r}" for x, y, z in reversed(nodes)]


def check_same(ours, theirs, source):
    """The files have all digits; our volume is summed in another order of cells."""
    assert theirs["msm"]["source"] == source and theirs["msm"]["status"] == "converged", theirs["msm"]
    assert len(ours["measures"]) == len(theirs["measures"]) == 5
    for mine, other in zip(ours["measures"], theirs["measures"]):
        for key in ("fem", "msm", "error_percent"):
            assert mine[key] is not None and abs(mine[key] - other[key]) <= 1e-9 * max(1, abs(mine[key])), (mine, other)


def test_forms(folder):
    """A .pvd and folders with and without times are the inside path's motion, in run, gate, JSON and on the page."""
    ours = make_motion(folder)
    pvd = folder / "ours/released-bar.pvd"
    check_same(ours, measures(folder, "--msm-displacements", "ours/released-bar.pvd"), "ours/released-bar.pvd")
    copied(folder, "numbered")
    check_same(ours, measures(folder, "--msm-displacements", "numbered"), "numbered")
    files = copied(folder, "listed")
    assert len(files) == N_STEPS + 1
    # Times twice as fine as the case's: those between are left out.
    fine = [f"{files[k // 2]},{STEP / 2 * k:.6g}" for k in range(2 * N_STEPS + 1)]
    (folder / "listed/times.csv").write_text("\n".join(["file,time", *fine, ""]))
    check_same(ours, measures(folder, "--msm-displacements", "listed"), "listed")
    fem = measures(folder, "--msm-displacements", "numbered", "--array", "fem_displacement")
    assert all(one["msm"] == one["fem"] for one in fem["measures"][:4]), fem["measures"]
    judged = springproof("gate", "--msm-displacements", pvd, "--junit", "gates.xml", folder=folder)
    assert judged.returncode == 0 and judged.stdout.startswith("met"), judged
    paged = springproof("run", "--msm-displacements", "numbered", "--out", "theirs", "--report", folder=folder)
    assert paged.returncode == 0 and "numbered" in (folder / "theirs/released-bar.html").read_text(), paged
    again = measures(folder, "--msm-displacements", "theirs/released-bar.pvd")  # what a run with them writes
    check_same(ours, again, "theirs/released-bar.pvd")


def write_csv(folder, times_and_rows):
    rows = [f"{time!r},{row}" for time, body in times_and_rows for row in body]
    (folder / "motion.csv").write_text("\n".join(["time,x,y,z,ux,uy,uz", *rows, ""]))


def test_csv(folder):
    """A .csv of times and a folder of a .csv for each step give the formula's displacements."""
    (folder / "bar.toml").write_text(CASE)
    write_csv(folder, bodies())
    (folder / "steps").mkdir()
    for k, (_, rows) in enumerate(bodies()):
        (folder / f"steps/step{k}.csv").write_text("\n".join(["x,y,z,ux,uy,uz", *rows, ""]))
    for source in ("motion.csv", "steps"):
        values = {one["name"]: one["msm"] for one in measures(folder, "--msm-displacements", source)["measures"]}
        assert abs(values["drop"] + 1e-4 * 40 * 40 * N_STEPS) < 1e-12, values  # one product of the formula's, rounded
    told = "held displacements are not as the case holds them"
    assert not any(told in text for text in measures(folder, "--msm-displacements", "motion.csv")["warnings"])
    shifted = [(time, [",".join([*line.split(",")[:3], "3", *line.split(",")[4:]]) for line in rows]) for time, rows in bodies()]
    write_csv(folder, shifted)  # the clamped face has moved too
    warnings = measures(folder, "--msm-displacements", "motion.csv")["warnings"]
    assert any(told in text for text in warnings), warnings


def test_broken(folder):
    """What is broken is refused before anything is solved: one line that says where, and exit 2."""
    make_motion(folder)
    files = copied(folder, "numbered")

    def refused(path, told, *words):
        done = springproof("run", "--msm-displacements", path, *words, folder=folder)
        assert done.returncode == 2 and not done.stdout and len(done.stderr.splitlines()) == 1, (path, done)
        assert told in done.stderr, (told, done.stderr)

    def pvd(sets):
        lines = "".join(f'<DataSet timestep="{time}" file="{file}"/>' for time, file in sets)
        (folder / "broken.pvd").write_text(f'<VTKFile type="Collection"><Collection>{lines}</Collection></VTKFile>')
        return "broken.pvd"

    good = [(STEP * k, f"numbered/{file}") for k, file in enumerate(files)]
    (folder / "outside.vtu").write_bytes((folder / "numbered" / files[0]).read_bytes())
    (folder / "inner").mkdir()
    (folder / "inner/link.vtu").symlink_to(folder / "outside.vtu")
    inner = '<VTKFile><Collection><DataSet timestep="0" file="{}"/></Collection></VTKFile>'
    for name in ("../outside.vtu", str(folder / "outside.vtu"), "link.vtu", "/etc/passwd"):
        (folder / "inner/a.pvd").write_text(inner.format(name))
        refused("inner/a.pvd", "must name files in its own folder or below")
    refused(pvd([(0, "numbered/none.vtu")]), "names the file 'numbered/none.vtu', which is not there")
    refused(pvd([]), "has no times")
    refused(pvd(good[:-1]), "has no body at 0.02 s")
    refused(pvd([good[0], *good[2:]]), "has no body at 0.002 s")
    refused(pvd([good[1], good[0], *good[2:]]), "times must ascend")
    refused(pvd([good[0], *good]), "times must ascend")
    refused(pvd([("nan", good[0][1])]), "time is 'nan', must be a finite number")
    refused(pvd([("", good[0][1])]), "must be a finite number")
    for text in ("", "<VTKFile>", "<a>" * 400_000, "<VTKFile/>", inner.replace("timestep", "step"), "\0"):
        (folder / "bad.pvd").write_text(text)
        refused("bad.pvd", "bad.pvd")
    refused(pvd(good), "named 'speed'; it has 'fem_displacement', 'msm_displacement'", "--array", "speed")
    refused(pvd(good), "dynamics", "--interpolate")
    refused(f"numbered/{files[0]}", "is of one time, and this case has [dynamics]")
    (folder / "empty").mkdir()
    refused("empty", "has no times")
    (folder / "two").mkdir()
    for name in ("a0.vtu", "b1.vtu"):
        shutil.copy(folder / "outside.vtu", folder / "two" / name)
    refused("two", "has files a*.vtu and b*.vtu")
    (folder / "two/times.csv").write_text("file,time\na0.vtu,soon\n")
    refused("two", "two/times.csv:2: time is 'soon'")
    (folder / "two/times.csv").write_text("a0.vtu,0\n")
    refused("two", "must be the header file,time")
    all_bodies = list(bodies())
    for change, told in ((lambda rows: rows[:-1], "has 15 of the 16 nodes"),
                         (lambda rows: [*rows, rows[0]], "given twice"),
                         (lambda rows: [row.replace(",0,0,", ",nan,0,") for row in rows], "seven finite numbers"),
                         (lambda rows: [row.replace("40,", "41,") for row in rows], "no node"),
                         (lambda rows: [row + ",1" for row in rows], "seven finite numbers")):
        write_csv(folder, [*all_bodies[:4], (all_bodies[4][0], change(all_bodies[4][1])), *all_bodies[5:]])
        refused("motion.csv", told)
    write_csv(folder, [*all_bodies, all_bodies[0]])
    refused("motion.csv", "times must ascend")
    refused("motion.csv", "a .csv has none", "--array", "a")
    (folder / "motion.csv").write_text("x,y,z,ux,uy,uz\n")
    refused("motion.csv", "must be the header time,x,y,z,ux,uy,uz")
    still = subprocess.run([PROGRAM, "run", Path(SOURCE) / "cases/external/pulled_bar.toml", "--msm-displacements", "numbered"],
                           capture_output=True, text=True, cwd=folder)
    assert still.returncode == 2 and "of a case with [dynamics]" in still.stderr, still


def main():
    for name, test in list(globals().items()):
        if not name.startswith("test_"):
            continue
        with tempfile.TemporaryDirectory() as folder:
            test(Path(folder))
        print("passed:", test.__doc__.splitlines()[0])


if __name__ == "__main__":
    main()
