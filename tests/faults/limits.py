"""The program without memory, disk, standard output, workers or ranks.

usage: limits.py SPRINGPROOF SOURCE_FOLDER

Each command ends in time, in the exit status that it should, with one line on standard error that says why; then the same command
without the limit completes in the same folder. The full disk needs the right to mount; without it that part is left out, and said to be.
Only Python's standard library and prlimit are used.
"""

import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROGRAM, SOURCE = (str(Path(argument).resolve()) for argument in sys.argv[1:3])
CUBE = f"{SOURCE}/cases/thesis/linear_elastic/cube_shear_small.toml"
EXACT = f"{SOURCE}/cases/gates/uniaxial_exact.toml"
ALLOWED_SECONDS = 120
ALONE = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
faults = 0


def check(what, statuses, done, lines=1):
    """Says what happened, and counts it if it should not have."""
    global faults
    said = done.stderr.decode(errors="replace").splitlines() if done.stderr else []
    said = [line for line in said if not line.endswith(" s")]  # tables says what it took
    is_good = done.returncode in statuses and (done.returncode == 0 or len(said) <= lines)
    faults += not is_good
    print(f"{'ok   ' if is_good else 'FAULT'} {what}: exit {done.returncode}, {len(said)} lines: {said[:1]}", flush=True)


def run(words, prefix=(), **options):
    try:
        return subprocess.run([*prefix, PROGRAM, *words], env=ALONE, timeout=ALLOWED_SECONDS,
                              **{"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, **options})
    except subprocess.TimeoutExpired as slow:
        return subprocess.CompletedProcess(slow.cmd, f"none after {ALLOWED_SECONDS} s", stderr=slow.stderr)


def memory():
    """Too little ends with a message, enough with success; nothing between."""
    for megabytes in (400, 700, 1000, 1400, 2000, 3000, 4000):
        limit = ("prlimit", f"--as={megabytes * 2 ** 20}")
        for cells in (10, 24):
            words = ["run", CUBE, "--set", f"body.cells=[{cells},{cells},{cells}]"]
            check(f"{cells}^3 cells in {megabytes} MB", (0, 1, 2, 127), run(words, limit))


def standard_output():
    for redirection in (">/dev/full", ">&-"):
        for words in (f"run {EXACT}", f"gate {EXACT}", "tables 4.1", "design --young 0.3 --poisson 0.3", "eigen --poisson 0.3", "--version"):
            done = subprocess.run(f"{PROGRAM} {words} {redirection}", shell=True, env=ALONE, stderr=subprocess.PIPE, timeout=ALLOWED_SECONDS)
            check(f"{words} {redirection}", (2,), done)


def disk(folder):
    small = folder / "small"
    small.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=48k", "tmpfs", small], stderr=subprocess.DEVNULL).returncode == 0
    if not mounted:
        print("no right to mount: the full disk is left out")
        return
    try:
        for name, words in (("run", ["run", CUBE]), ("gate", ["gate", EXACT]), ("tables", ["tables", "4.1"]), ("eigen", ["eigen", "--poisson", "0.3"]),
                            ("design", ["design", "--neo-hookean", "0.04", "--method", "nonlinear_method"])):
            (small / "filler").write_bytes(b"x" * 40_000)
            check(f"{name} --out on a full disk", (2,), run([*words, "--out", small / name]), lines=2)
            subprocess.run(["mount", "-o", "remount,size=64m", small], check=True)
            check(f"{name} again with room", (0,), run([*words, "--out", small / name]))
            for path in small.iterdir():
                subprocess.run(["rm", "-r", path], check=True)
            subprocess.run(["mount", "-o", "remount,size=48k", small], check=True)
    finally:
        subprocess.run(["umount", small], check=True)


def children_of(pid):
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def killed_worker(folder):
    process = subprocess.Popen([PROGRAM, "gate", CUBE, EXACT, "--workers", "2", "--out", folder / "workers", "--set", "body.cells=[16,16,16]"],
                               env=ALONE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    end = time.monotonic() + 20
    while time.monotonic() < end and process.poll() is None and not children_of(process.pid):
        time.sleep(0.01)
    for child in children_of(process.pid):
        os.kill(child, signal.SIGKILL)
    _, said = process.communicate(timeout=ALLOWED_SECONDS)
    check("killed workers", (1, 2), subprocess.CompletedProcess([], process.returncode, stderr=said), lines=3)


def killed_rank():
    process = subprocess.Popen(["mpirun", "-n", "2", PROGRAM, "run", CUBE, "--set", "body.cells=[16,16,16]"], env=ALONE,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    end = time.monotonic() + 20
    while time.monotonic() < end and len(children_of(process.pid)) < 2:
        time.sleep(0.01)
    time.sleep(0.5)
    os.kill(children_of(process.pid)[-1], signal.SIGKILL)
    _, said = process.communicate(timeout=ALLOWED_SECONDS)
    check("a killed rank", tuple(range(1, 256)), subprocess.CompletedProcess([], process.returncode, stderr=said), lines=20)  # mpirun's words


def main():
    with tempfile.TemporaryDirectory() as name:
        memory()
        standard_output()
        disk(Path(name))
        killed_worker(Path(name))
        killed_rank()
    sys.exit(1 if faults else 0)


main()
