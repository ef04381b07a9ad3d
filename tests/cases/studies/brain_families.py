"""Methods of simulators on the brain under its recorded pulls: how many iterations or substeps fit in a time a step, and what they leave.

usage: brain_families.py SPRINGPROOF CASE PULLS FOLDER [MILLISECONDS [STEPS]]

Each method is given its whole time in iterations of one substep, and in substeps of one iteration. The search begins with one, and takes as many more as
the time allows by what the last took, four times at most; kept is the largest number whose steps take at most MILLISECONDS (16) in the mean. A time is
scaled by the part of the run in which the process had a processor. The distance is from the same springs, solved: root mean square over nodes and time,
percent of their displacement. STEPS shortens the recording. Only Python's standard library is used.
"""

import json
import os
import subprocess
import sys
import time
import tomllib
from pathlib import Path

from motions_apart import frames, root_mean_square, squared_distances

PROGRAM, CASE, PULLS, FOLDER = sys.argv[1], *map(Path, sys.argv[2:5])
MILLISECONDS = float(sys.argv[5]) if len(sys.argv) > 5 else 16.0
STEPS = int(sys.argv[6]) if len(sys.argv) > 6 else None
STEP = 0.02  # s
WAYS = (("xpbd", "iterations"), ("xpbd", "substeps"), ("projective_dynamics", "iterations"), ("projective_dynamics", "substeps"),
        ("vertex_block_descent", "iterations"), ("vertex_block_descent", "substeps"), ("implicit_euler", "iterations"), ("implicit_euler", "substeps"),
        ("symplectic_euler", "substeps"))


def recording():
    """The pulls of the first steps, and their end."""
    header, *rows = PULLS.read_text().splitlines()
    if STEPS is None:
        return PULLS, None
    short = FOLDER / "pulls.csv"
    short.write_text("\n".join([header] + [row for row in rows if int(row.split(",")[0]) <= STEPS]) + "\n")
    return short, STEP * STEPS


def run(*settings, out=None):
    """The springs' record, and the milliseconds of a step."""
    pulls, end = recording()
    words = [PROGRAM, "run", CASE, "--only", "msm", "--json", "--replay", pulls]
    words += [word for setting in settings + ((f"dynamics.end={end}",) if end else ()) for word in ("--set", setting)]
    before, begin = os.times(), time.monotonic()
    done = subprocess.run(words + (["--out", out] if out else []), capture_output=True, text=True, check=False)
    after = os.times()
    assert done.returncode in (0, 1), (words, done.stderr)
    answer = json.loads(done.stdout)["cases"][0]
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    had = min(1.0, spent / (time.monotonic() - begin))
    side, times = answer["msm"], (answer.get("motion") or {}).get("time") or []
    milliseconds = 1e3 * had * side["seconds"]["solve"] / (len(times) - 1) if side["status"] == "converged" else None
    return side, milliseconds


def inline(value):
    """TOML of a value."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}={inline(one)}" for key, one in value.items()) + "}"
    return json.dumps(value)


def springs(**more):
    """A setting: the case's springs, with steps that are solved, or others."""
    table = tomllib.loads(CASE.read_text())["msm"]
    table.pop("iterations_per_step", None)
    return "msm=" + inline({**table, **more})


def stepped(method, way, number):
    counts = {"iterations": number, "substeps": 1} if way == "iterations" else {"iterations": 1, "substeps": number}
    if method == "symplectic_euler":
        del counts["iterations"]
    return springs(real_time={"method": method, **counts})


def search(method, way):
    """The largest number that fits, its record and milliseconds, or the first record that does not."""
    best, number, tried = None, 1, set()
    for _ in range(5):
        side, milliseconds = run(stepped(method, way, number))
        tried.add(number)
        print(f"  {method}, {number} {way}: {side['message'] if milliseconds is None else f'{milliseconds:.2f} ms'}", file=sys.stderr)
        fits = milliseconds is not None and milliseconds <= MILLISECONDS
        if fits and (best is None or number > best[0]):
            best = number, side, milliseconds
        if milliseconds is None:  # an explicit one may need more
            number *= 8
        else:
            number = max(1, min(1000, int(0.97 * number * MILLISECONDS / milliseconds)))
        if number in tried:
            break
    return best or (max(tried), side, milliseconds)


def motion_in(folder):
    return [frame.vectors("msm_displacement") for frame in frames(folder)]


def distance(motion, reference):
    nodes = range(len(reference[0]))
    whole = root_mean_square(squared_distances(reference, [[(0.0, 0.0, 0.0)] * len(nodes)] * len(reference), nodes), nodes)
    return 100 * root_mean_square(squared_distances(motion, reference, nodes), nodes) / whole


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    run(springs(), out=FOLDER / "solved")
    solved = motion_in(FOLDER / "solved")
    print("| method | ms a step | from the solved springs, % |\n|---|---:|---:|")
    for iterations in (None, 4):
        setting = springs() if iterations is None else springs(iterations_per_step=iterations)
        _, milliseconds = run(setting)
        run(setting, out=FOLDER / "own")
        print(f"| {'solved' if iterations is None else f'iterations_per_step = {iterations}'} | {milliseconds:.2f} | {distance(motion_in(FOLDER / 'own'), solved):.1f} |", flush=True)
    for method, way in WAYS:
        number, side, milliseconds = search(method, way)
        name = f"{method}, {number} {way}"
        if side["status"] != "converged":
            print(f"| {name} | | {side['message']} |", flush=True)
            continue
        out = FOLDER / f"{method}_{way}"
        run(stepped(method, way, number), out=out)
        print(f"| {name} | {milliseconds:.1f} | {distance(motion_in(out), solved):.1f} |", flush=True)


if __name__ == "__main__":
    main()
