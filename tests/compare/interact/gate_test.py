"""A gate of the surface over time judges what `run` says of it, under the pulls of a recording.

usage: gate_test.py SPRINGPROOF CASE FOLDER
"""

import csv
import json
import math
import subprocess
import sys
from pathlib import Path

from replay_test import write_case


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, folder

    def run(self, *words, statuses=(0,)):
        done = subprocess.run([self.path, *words], cwd=self.folder, capture_output=True, text=True, check=False)
        assert done.returncode in statuses, (words, done.returncode, done.stdout[-2000:], done.stderr)
        return done


def expectation(lower, upper):
    return ("--set", f'expect=[{{measure="surface", error_percent=[{lower}, {upper}], reference="regression", reason="a test"}}]')


def gate(program, lower, upper, *words):
    """The gate of the surface's error within bounds, percent; it is met where the exit status says so."""
    done = program.run("gate", *words, "--json", *expectation(lower, upper), statuses=(0, 1))
    judged = json.loads(done.stdout)["gates"][0]
    assert judged["met"] == (done.returncode == 0), judged
    return judged


def check_value(of_run, surface):
    """The measure is the root mean square over time of what the motion's surface has at each body, by trapezoids."""
    measured = next(measure for measure in of_run["measures"] if measure["name"] == "surface")
    assert measured["unit"] == "mm" and measured["error_percent"] == surface["error_percent"], measured
    for side in ("fem", "msm"):
        squares = [value ** 2 for value in surface[side]]
        expected = math.sqrt((sum(squares) - (squares[0] + squares[-1]) / 2) / (len(squares) - 1))
        assert math.isclose(measured[side], expected, rel_tol=1e-9), (side, measured, expected)  # sums in another order
    assert measured["fem"] != measured["msm"], measured
    return measured["error_percent"]


def check_beside_limits(program):
    """The surface is no measure of the case's own, which alone have a limit; in tables and rankings it stands after them."""
    short = ("case.toml", "--set", "dynamics.end=0.02")
    program.run("run", *short, "--converge=3", "--out", "limits")
    rows = list(csv.DictReader((program.folder / "limits/comparison.csv").read_text().splitlines()))
    assert rows[-1]["measure"] == "surface" and rows[-1]["reference"] == "same_mesh", rows[-1]
    assert rows[-1]["fem_discretisation_error_percent"] == "" and float(rows[-1]["error_percent"]) > 0, rows[-1]
    ranked = json.loads(program.run("run", *short, "--designs", "hybrid,matched", "--json").stdout)["cases"][0]
    assert all("surface" in design["errors_percent"] for design in ranked["designs"]), ranked


def main():
    springproof, source, folder = (Path(word).resolve() for word in sys.argv[1:])
    folder.mkdir(parents=True, exist_ok=True)
    write_case(source, folder)
    program = Program(springproof, folder)
    pulled = ("case.toml", "--replay", "pulls.csv")
    of_run = json.loads(program.run("run", *pulled, "--json").stdout)["cases"][0]
    error = check_value(of_run, of_run["motion"]["surface"])
    judged = gate(program, 0.9 * error, 1.1 * error, *pulled)
    assert judged["met"] and judged["value"] == error and judged["unit"] == "%", judged
    assert not gate(program, 1.1 * error, 2 * error, *pulled)["met"]
    still = gate(program, 0.9 * error, 1.1 * error, "case.toml")  # not pulled: moves under its weight alone
    assert not still["met"] and still["value"] != error, still
    for part in ("1", "2"):
        program.run("gate", *pulled, "--shard", f"{part}/2", "--out", f"part{part}", *expectation(0.9 * error, 1.1 * error))
    program.run("merge", "part1", "part2")
    (folder / "other.toml").write_text((folder / "case.toml").read_text().replace('name = "pulled-block"', 'name = "other"'))
    assert "of one case" in program.run("gate", *pulled, "other.toml", statuses=(2,)).stderr
    check_beside_limits(program)
    print(f"the surface's gate is of {error:.3g} %, as run says")


if __name__ == "__main__":
    main()
