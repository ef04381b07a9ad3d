"""Commands with --out killed (SIGKILL) at any moment, and run again.

usage: kills.py SPRINGPROOF SOURCE_FOLDER [KILLS]

After a kill each file under its final name is whole, and none is what an undisturbed run does not write. Another run of the command then
ends with the exit status and leaves the bytes of an undisturbed run, but for files that hold times: what is equal in three undisturbed runs
must be equal here. Only Python's standard library is used.
"""

import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree
from pathlib import Path

PROGRAM, SOURCE = (Path(argument).resolve() for argument in sys.argv[1:3])
CUBE, BOX = SOURCE / "cases/thesis/linear_elastic/cube_shear_small.toml", SOURCE / "tests/compare/sweep/tiny.toml"
COMMANDS = {
    "run": ["run", CUBE, SOURCE / "cases/gates/sheared_cube.toml"],
    "gate": ["gate", SOURCE / "cases/gates/sheared_cube.toml", SOURCE / "cases/gates/uniaxial_exact.toml"],
    "tables": ["tables", "4.1"],
    "sweep": ["sweep", "--quick", BOX],
    "design": ["design", "--neo-hookean", "0.04", "--method", "nonlinear_method"],
    "export": ["export", CUBE, "--to", "csv"],
    "eigen": ["eigen", "--poisson", "0.35"],
}


def command_of(words, out):
    return [PROGRAM, *map(str, words), "--out", str(out)]


def files_in(folder):
    """Content by path, but for what a command that goes on keeps for itself."""
    return {str(p.relative_to(folder)): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def is_own(name):
    """Locks, temporary files and kept results: the program's own, checked when they are read."""
    path = Path(name)
    return path.parts[0] == "solved" or path.name.startswith(".")


def has_grown(name, content, expected):
    """run, gate and sweep write their table anew after each case, so that what is finished is there."""
    return name in ("comparison.csv", "sweep.csv") and content.endswith(b"\n") and expected.startswith(content)


def why_not_whole(name, content):
    """An empty text if a file of this ending is whole."""
    ending = Path(name).suffix
    try:
        if ending == ".json":
            json.loads(content)
        elif ending in (".svg", ".xml"):
            xml.etree.ElementTree.fromstring(content)
        elif ending == ".png" and not content.endswith(b"IEND\xaeB`\x82"):
            return "a picture without its end"
        elif ending == ".vtu" and not content.rstrip().endswith(b"</VTKFile>"):
            return "a grid without its end"
        elif ending == ".html" and not content.rstrip().endswith(b"</html>"):
            return "a page without its end"
        elif ending in (".csv", ".txt") and not content.endswith(b"\n"):
            return "a text without its last line"
    except (ValueError, xml.etree.ElementTree.ParseError) as error:
        return str(error)
    return ""


def undisturbed(words, folder):
    """An undisturbed run's exit status and files, which of them are the same in every run, and the seconds it takes."""
    runs, statuses, seconds = [], set(), 0
    for number in (1, 2, 3):
        out = folder / f"undisturbed_{number}"
        begin = time.monotonic()
        statuses.add(subprocess.run(command_of(words, out), capture_output=True).returncode)
        seconds = time.monotonic() - begin
        runs.append(files_in(out))
    assert all(run.keys() == runs[0].keys() for run in runs), [sorted(run) for run in runs]
    (status,) = statuses
    # A busy machine may take longer than sweep's budget for a first solve, and then leaves the second one out of the picture.
    constant = {name for name in runs[0] if runs[0][name] == runs[1][name] == runs[2][name] and not name.endswith("_again.gp")}
    return status, runs[0], constant, seconds


def faults_of_kill(words, out, moment, status, expected, constant):
    """What is wrong after one kill and one run more."""
    process = subprocess.Popen(command_of(words, out), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
    time.sleep(moment)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    left = {name: content for name, content in files_in(out).items() if not is_own(name)} if out.exists() else {}
    faults = [f"{name}: {why_not_whole(name, content)}" for name, content in left.items() if why_not_whole(name, content)]
    faults += [f"{name}: cut" for name, content in left.items()
               if name in constant and content != expected[name] and not has_grown(name, content, expected[name])]
    again = subprocess.run(command_of(words, out), capture_output=True)
    if again.returncode != status:
        return faults + [f"the rerun ends with {again.returncode}: {again.stderr[-300:]!r}"]
    after = files_in(out)
    faults += [f"{name}: missing after the rerun" for name in expected.keys() - after.keys()]
    faults += [f"{name}: left by the killed run" for name in after.keys() - expected.keys()]
    faults += [f"{name}: other bytes after the rerun" for name in constant & after.keys()
               if after[name] != expected[name] and not is_own(name)]
    return faults


def main():
    kills = int(sys.argv[3]) if len(sys.argv) > 3 else 100
    chance = random.Random(20261122)
    n_faults = 0
    with tempfile.TemporaryDirectory() as name:
        for command, words in COMMANDS.items():
            folder = Path(name) / command
            status, expected, constant, seconds = undisturbed(words, folder)
            n = -(-kills // len(COMMANDS))
            for number in range(n):
                moment = chance.uniform(0, 1.05 * seconds)
                for fault in faults_of_kill(words, folder / f"killed_{number}", moment, status, expected, constant):
                    n_faults += 1
                    print(f"{command}, killed after {moment:.3f} s: {fault}")
            print(f"{command}: {n} kills of runs of {seconds:.1f} s, {len(expected)} files, {len(constant)} the same in every run", flush=True)
    sys.exit(1 if n_faults else 0)


main()
