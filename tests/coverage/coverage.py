"""How often the truth lies within the bar of the printed limit, over the problems of problems.py and the truths of truths.csv.

usage: coverage.py SPRINGPROOF FOLDER [NAME ...]   (FOLDER is made; with names, these problems alone, and nothing is judged)
"""

import csv
import json
import shutil
import subprocess
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True

from problems import PROBLEMS, write_case

HERE = Path(__file__).resolve().parent
NEEDED_PERCENT, LEAST_TRUTHS = 95, 100


def read_truths():
    with open(HERE / "truths.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {(row["case"], row["measure"]): (float(row["truth"]), float(row["uncertainty"])) for row in rows}


def solve(program, problem, folder):
    """What `run` says of each measure.  @return by name, fem_limit and its uncertainty among it; and the seconds"""
    out = folder / f"out_{problem['name']}"
    if out.exists():
        shutil.rmtree(out)  # answers are kept there
    case, began = write_case(problem, folder), time.time()
    done = subprocess.run([program, "run", case.name, "--only", "fem", "--out", out.name], cwd=folder, capture_output=True, text=True, check=False)
    (folder / f"{problem['name']}.txt").write_text(done.stdout + done.stderr, encoding="utf-8")
    if done.returncode != 0:
        return None, f"exit status {done.returncode}: {(done.stderr or done.stdout)[-600:]}", time.time() - began
    solved = json.loads((out / "results.json").read_text(encoding="utf-8"))["cases"][0]
    choice = next((c for c in solved["fem"]["choices"] if c.startswith("accuracy")), "")
    return {m["name"]: m for m in solved["measures"]}, choice, time.time() - began


def judge(measured, truth, own):
    """held, missed, or why a truth does not count. The truth is known to within its own uncertainty, which decides where that is below a
    fifth of the bar, or where every value within it lies on the same side of the bar's end."""
    limit, bar = measured.get("fem_limit"), measured.get("fem_limit_uncertainty")
    if limit is None or bar is None:
        return f"no limit: {measured.get('fem_limit_note', '')}"
    off = abs(limit - truth)
    if own > bar / 5 and off - own <= bar < off + own:
        return "the truth is not known well enough"
    return "held" if off <= bar else "missed"


def main():
    program, folder, names = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]), sys.argv[3:]
    folder.mkdir(parents=True, exist_ok=True)
    truths = read_truths()
    counts, lines, began = {"held": 0, "missed": 0}, [], time.time()
    for problem in PROBLEMS:
        if names and problem["name"] not in names:
            continue
        answers, note, seconds = solve(program, problem, folder)
        print(f"{problem['name']}: {seconds:.1f} s; {note}", flush=True)
        for m in problem["measures"]:
            key = (problem["name"], m["name"])
            if key not in truths:
                lines.append(f"{key[0]} {key[1]}: no truth")
                continue
            truth, own = truths[key]
            verdict = "missed" if answers is None else judge(answers[m["name"]], truth, own)
            if verdict in counts:
                counts[verdict] += 1
            detail = f"truth {truth:.8g} +- {own:.1g} {m['unit']}"
            measured = {} if answers is None else answers[m["name"]]
            if measured.get("fem_limit") is not None:
                limit, bar = measured["fem_limit"], measured["fem_limit_uncertainty"]
                how = measured["fem_limit_note"] or "an order that two steps confirm"
                detail += f", limit {limit:.8g} +- {bar:.2g}, {abs(limit - truth) / bar:.2f} bars off ({how})"
            print(f"  {verdict:6} {m['name']}: {detail}", flush=True)
            if verdict != "held":
                lines.append(f"{verdict}: {key[0]} {key[1]}: {detail}")
    decided = counts["held"] + counts["missed"]
    print("\nnot held:", *lines, sep="\n  ")
    print(f"{counts['held']} of {decided} decided truths lie within the bar; {time.time() - began:.0f} s")
    if not names and (decided < LEAST_TRUTHS or 100 * counts["held"] < NEEDED_PERCENT * decided):
        sys.exit(f"at least {LEAST_TRUTHS} truths have to be decided, and {NEEDED_PERCENT} of 100 of them within the bar")


if __name__ == "__main__":
    main()
