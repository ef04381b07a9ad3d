"""A replay gives the same bytes twice, and how far both models' surfaces are apart is what their nodes say.

usage: replay_test.py SPRINGPROOF CASE FOLDER
"""

import json
import math
import subprocess
import sys
from pathlib import Path

CORNERS = ((0, 0, 60), (40, 0, 60), (0, 40, 60))  # nodes of the block: the surface's vertices


def write_case(source, folder):
    (folder / "top.stl").write_text("solid top\nfacet normal 0 0 1\nouter loop\n" +
                                    "".join("vertex {} {} {}\n".format(*corner) for corner in CORNERS) + "endloop\nendfacet\nendsolid\n")
    measures = "".join(f'[[measure]]\nname = "{i}{axis}"\nkind = "displacement"\nnode = "near {x} {y} {z}"\ncomponent = "{axis}"\nover_time = "end"\n'
                       for i, (x, y, z) in enumerate(CORNERS) for axis in "xyz")
    text = source.read_text().replace("end = 1", "end = 0.3\nwrite_every = 1").replace("[[measure]]", '[surface]\nfile = "top.stl"\n\n[[measure]]')
    (folder / "case.toml").write_text(text + measures)
    rows = [f"{step},{step * 0.01:.17g},0,0,60,3,{0.002 * step:.17g},0,{0.001 * math.sin(step):.17g}" for step in range(3, 26)]
    (folder / "pulls.csv").write_text("step,time,x,y,z,radius,fx,fy,fz\n" + "\n".join(rows) + "\n")


def replay(springproof, folder, out):
    done = subprocess.run([springproof, "run", "case.toml", "--replay", "pulls.csv", "--json", "--out", out], cwd=folder, capture_output=True,
                          text=True, check=False)
    assert done.returncode == 0, (done.returncode, done.stdout[-2000:], done.stderr)
    return json.loads(done.stdout)["cases"][0]["motion"]


def check_surface(motion):
    """Against the displacements of the three nodes, which are measures of their own."""
    course = {measure["name"]: measure for measure in motion["measures"]}
    surface = motion["surface"]
    assert surface["time"] == motion["time"]
    squares = {"fem": [], "difference": []}
    for step in range(len(motion["time"])):
        of_fem = [[course[f"{i}{axis}"]["fem"][step] for axis in "xyz"] for i in range(3)]
        of_msm = [[course[f"{i}{axis}"]["msm"][step] for axis in "xyz"] for i in range(3)]
        apart = [math.dist(a, b) for a, b in zip(of_fem, of_msm)]
        squares["fem"].append(sum(math.hypot(*u) ** 2 for u in of_fem) / 3)
        squares["difference"].append(sum(value ** 2 for value in apart) / 3)
        assert math.isclose(surface["largest_difference"][step], max(apart), rel_tol=1e-9, abs_tol=1e-12), step
        for name, values in squares.items():
            assert math.isclose(surface[name][step], math.sqrt(values[-1]), rel_tol=1e-9, abs_tol=1e-12), (name, step)
    trapezoids = {name: sum(values) - (values[0] + values[-1]) / 2 for name, values in squares.items()}
    expected = 100 * math.sqrt(trapezoids["difference"] / trapezoids["fem"])
    assert expected > 0.1 and math.isclose(surface["error_percent"], expected, rel_tol=1e-9), (surface["error_percent"], expected)
    assert any(note.startswith("surface: ") for note in motion["notes"]), motion["notes"]


def check_methods(springproof, folder, motion):
    """`judge` has a row for every method under the same pulls, with the surface's error over time; what fails is a row with its reason."""
    methods = ("implicit_euler:1000", "xpbd:1:8", "symplectic_euler", "fem.corotational:30", "symplectic_euler::1")
    words = [springproof, "judge", "case.toml", "--replay", "pulls.csv", *(word for method in methods for word in ("--method", method))]
    done = subprocess.run([*words, "--json"], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 1, (done.returncode, done.stderr)  # one has failed
    rows = {row["model"]: row for row in json.loads(done.stdout)["cases"][0]["rows"]}
    assert list(rows) == ["finite elements", "springs", *methods], list(rows)
    own = rows["springs"]["surface"]
    assert own == motion["surface"], "judge's springs are not run's"
    solved = rows["implicit_euler:1000"]["surface"]
    assert math.isclose(solved["error_percent"], own["error_percent"], rel_tol=1e-4), (solved["error_percent"], own["error_percent"])
    assert rows["implicit_euler:1000"]["residual_percent"] < 1e-2 < rows["xpbd:1:8"]["residual_percent"], rows
    assert not math.isclose(rows["xpbd:1:8"]["surface"]["error_percent"], own["error_percent"], rel_tol=1e-3), rows["xpbd:1:8"]
    elements = rows["fem.corotational:30"]["surface"]
    assert elements["error_percent"] < own["error_percent"] / 2, "the elements' own method is no nearer to them than springs"
    for method in methods[:4]:
        assert rows[method]["status"] == "answered" and rows[method]["keeps_60_hz"] == (rows[method]["milliseconds_a_step"] <= 1000 / 60), rows[method]
    failed = rows["symplectic_euler::1"]
    assert failed["status"] == "failed" and "steps in real time" in failed["reason"] and failed["surface"] is None, failed
    text = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False).stdout
    assert "surface %" in text and "left %" in text and "60 Hz" in text and max(map(len, text.splitlines())) <= 100, text


def check_designs(springproof, folder, motion):
    """`--designs` ranks springs under the pulls: the case's own design errs as `run` says, and what is proposed next keeps the recording."""
    words = [springproof, "run", "case.toml", "--replay", "pulls.csv"]
    done = subprocess.run([*words, "--designs", "hybrid,matched", "--json"], cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, (done.returncode, done.stderr)
    rows = {row["design"]: row["errors_percent"] for row in json.loads(done.stdout)["cases"][0]["designs"]}
    assert math.isclose(rows["hybrid"]["surface"], motion["surface"]["error_percent"], rel_tol=1e-6), (rows, motion["surface"])
    assert not math.isclose(rows["matched"]["surface"], rows["hybrid"]["surface"], rel_tol=1e-3), rows
    text = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False).stdout
    next_lines = [line for line in text.splitlines() if "springproof run" in line or "--designs" in line]
    assert next_lines and all("--replay" in line for line in next_lines), text


def main():
    springproof, source, folder = (Path(word).resolve() for word in sys.argv[1:])
    folder.mkdir(parents=True, exist_ok=True)
    write_case(source, folder)
    motions = [replay(springproof, folder, out) for out in ("first", "second")]
    assert motions[0] == motions[1]
    written = sorted(path.relative_to(folder / "first") for pattern in ("*_motion.csv", "*.pvd", "*/*.vtu") for path in (folder / "first").glob(pattern))
    assert len(written) == 2 + 31, written
    for name in written:
        assert (folder / "first" / name).read_bytes() == (folder / "second" / name).read_bytes(), name
    check_surface(motions[0])
    check_methods(springproof, folder, motions[0])
    check_designs(springproof, folder, motions[0])
    print(f"{len(written)} files of two replays are the same; the surfaces are {motions[0]['surface']['error_percent']:.3g} % apart")


if __name__ == "__main__":
    main()
