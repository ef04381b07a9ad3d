"""Limits by this program's finite elements and by GetFEM, on the cases of cases/peers: each program refines its own meshes.

usage: second_code_test.py SPRINGPROOF SOURCE [--write] [NAME[:X,Y,Z] ...]

With names, these cases alone, with X, Y and Z cells in place of their own.

Of both measures of a case the two limits have to agree within the sum of their bars, and within 0.2 %. All twelve cases together are
also held against the table of docs/developing/verification.md; --write puts the rows there. Exit status 77, "nothing was compared":
GetFEM is not installed.
"""

import json
import math
import os
import re
import subprocess
import sys
import time
from pathlib import Path

APART_PERCENT = 0.2  # the bound asked of a second code
SAME_ROW = 1e-4  # relative to a limit: residuals of 1e-7 of the loads, in extrapolated values, on another machine
PAGE = "docs/developing/verification.md"
HEADER = ["case", "law, nu", "cells", "load", "limit, mm", "GetFEM's limit, mm", "apart, %", "of the field, %"]

# The case, the meshes that this program solves (the body's own and those made by halving its cells), and what the table says of it.
CASES = [
    ("sheared_block", 5, "small strain, 0.3", "hexahedra", "traction"),
    ("bonded_pad_04999", 5, "small strain, 0.4999", "hexahedra", "moved by 10 %"),
    ("layered_block", 5, "small strain, 0.3 below 0.2", "hexahedra", "traction"),
    ("gripped_bar", 6, "Saint Venant-Kirchhoff, 0.3", "hexahedra", "moved by 15 %"),
    ("bent_bar_tetrahedra", 4, "Saint Venant-Kirchhoff, 0.3", "tetrahedra", "traction"),
    ("twisted_bar", 5, "log strain, 0.3", "hexahedra", "torque, traction"),
    ("sheared_block_neo_hookean", 5, "neo-Hookean, 0.3", "hexahedra", "traction"),
    ("pressed_block_0499", 5, "neo-Hookean, 0.499", "hexahedra", "traction on a part"),
    ("layered_bar_0499", 5, "neo-Hookean, 0.499 below 0.49", "hexahedra", "traction"),
    ("turned_bar_0499_tetrahedra", 4, "neo-Hookean, 0.499", "tetrahedra", "turned by 60°"),
    ("hanging_bar_049_tetrahedra", 4, "Ogden, 0.49", "tetrahedra", "gravity"),
    ("pulled_bar_04999", 5, "Ogden, 0.4999", "hexahedra", "traction"),
]  # fmt: skip


def solve(program, source, name, meshes, cells):
    """What `run --peer getfem` says.  Returns the study by GetFEM, or the reason why there is none."""
    command = [program, "run", f"cases/peers/{name}.toml", "--only", "fem", f"--converge={meshes}", "--peer", "getfem", "--json"]
    command += ["--set", f"body.cells=[{cells}]"] if cells else []
    done = subprocess.run(command, cwd=source, capture_output=True, text=True, check=False)
    if not done.stdout:
        return None, f"exit status {done.returncode}: {done.stderr[-600:]}"
    study = json.loads(done.stdout)["cases"][0]["peer_study"]
    if study["status"] != "converged" or done.returncode != 0:
        return None, f"exit status {done.returncode}, {study['status']}: {study['message']} {done.stderr[-600:]}"
    return study, ""


def with_bar(value, uncertainty):
    """Returns the value to the second digit of its bar."""
    if value is None:
        return "-"
    decimals = 6 if uncertainty <= 0 else max(0, 1 - math.floor(math.log10(uncertainty)))
    return f"{value:.{decimals}f} ± {uncertainty:.{decimals}f}"


def row_of(name, texts, study):
    place, field = study["measures"]
    apart = ["-" if m["difference_percent"] is None else f"{m['difference_percent']:+.3f}" for m in (place, field)]
    limits = [with_bar(place[key], place[f"{key}_uncertainty"]) for key in ("fem_limit", "limit")]
    return [f"`{name}`", *texts, *limits, *apart]


def misses_of(name, study):
    """Returns a sentence for each measure whose limits do not agree."""
    return [
        f"{name}, {m['measure']}: {m['fem_limit']} ± {m['fem_limit_uncertainty']} and {m['limit']} ± {m['limit_uncertainty']}, "
        f"{m['difference_percent']} % apart. {m['note']}"
        for m in study["measures"]
        if not m["within_bars"] or not abs(m["difference_percent"]) <= APART_PERCENT
    ]


def line_of(cells):
    return "| " + " | ".join(cells) + " |"


def rows_of_page(page):
    """Returns the lines before the table's rows, its rows as lists of cells, and the lines after it."""
    lines = page.read_text(encoding="utf-8").split("\n")
    first = lines.index(line_of(HEADER)) + 2
    last = next(n for n in range(first, len(lines)) if not lines[n].startswith("|"))
    return lines[:first], [line.strip("| ").split(" | ") for line in lines[first:last]], lines[last:]


def are_alike(cells, others):
    """Whether two rows have the same words, and limits that differ by rounding alone."""
    if len(cells) != len(others) or cells[:4] != others[:4]:
        return False
    for ours, theirs in zip(cells[4:6], others[4:6]):
        ours, theirs = (re.findall(r"[-\d.]+", text) for text in (ours, theirs))
        last_digit = 10.0 ** -len(ours[0].partition(".")[2])
        if not abs(float(ours[0]) - float(theirs[0])) <= SAME_ROW * abs(float(ours[0])) + last_digit:
            return False
    return True


def main():
    program, source = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    is_writing = "--write" in sys.argv[3:]
    names = dict((word + ":").split(":")[:2] for word in sys.argv[3:] if word != "--write")
    unknown = set(names) - {case[0] for case in CASES}
    assert not unknown, f"no such cases: {unknown}"
    assert not (is_writing and any(names.values())), "the table's rows have the cells of the case files"
    assert {case[0] for case in CASES} == {path.stem for path in (source / "cases/peers").glob("*.toml")}
    rows, misses = [], []
    for name, meshes, *texts in CASES:
        if names and name not in names:
            continue
        begin, began = time.monotonic(), sum(os.times()[2:4])
        study, reason = solve(program, source, name, meshes, names.get(name))
        if study is None and "is not installed" in reason:
            print("nothing was compared:", reason)
            return 77
        used = f"{sum(os.times()[2:4]) - began:.0f} s of processor time, {time.monotonic() - begin:.0f} s"
        if study is None:
            print(f"{name}: {reason}; {used}", flush=True)
            misses.append(f"{name}: {reason}")
            continue
        found = misses_of(name, study)
        rows.append(row_of(name, texts, study))
        misses += found
        print(line_of(rows[-1]), f"{used}, up to {study['meshes'][-1]['unknowns']} unknowns", *found, sep="\n  ", flush=True)
    page = source / PAGE
    before, written, after = rows_of_page(page)
    if is_writing:
        by_case = {row[0]: row for row in written + rows}
        written = [by_case[f"`{case[0]}`"] for case in CASES if f"`{case[0]}`" in by_case]
        page.write_text("\n".join(before + [line_of(row) for row in written] + after), encoding="utf-8")
    elif not names and not misses and (len(written) != len(rows) or not all(map(are_alike, rows, written))):
        misses.append(f"the table of {PAGE} has other values; `{Path(sys.argv[0]).name} SPRINGPROOF SOURCE --write` writes it")
    print("\n".join(["missed:"] + misses) if misses else f"the limits of {len(rows)} cases agree")
    return 1 if misses else 0


if __name__ == "__main__":
    sys.exit(main())
