"""The program without memory, disk, standard output, workers or ranks.

usage: limits.py SPRINGPROOF SOURCE_FOLDER [PART ...]

Parts: memory, output, disk, workers, ranks, signals; all of them when left out. Each command ends in time, in the exit status that it
should, with one line on standard error that says why; then the same command without the limit completes in the same folder. The disk needs
the right to mount; without it that part is left out, and said to be. Only Python's standard library and prlimit are used.
"""

import json
import os
import shutil
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


def memory(folder):
    """Too little ends with a message, enough with a solution of both models; nothing between."""
    for megabytes in (400, 700, 1000, 1400, 2000, 3000, 4000):
        for cells in (10, 24, 60):
            if cells == 60 and megabytes > 1000:
                continue  # it fits, and takes its time
            words = ["run", "--json", CUBE, "--set", f"body.cells=[{cells},{cells},{cells}]"]
            done = run(words, ("prlimit", f"--as={megabytes * 2 ** 20}"), stdout=subprocess.PIPE)
            is_enough = megabytes >= 1000 and cells < 60
            if done.returncode in (0, 1):  # 1: what the case expects of 10 x 10 x 10 cells
                [answer] = json.loads(done.stdout)["cases"]
                sides = [answer[side] for side in ("fem", "msm")]
                solved = all(side["status"] == "converged" for side in sides)
                if not (solved if is_enough else all(side["status"] == "converged" or side["message"] for side in sides)):
                    done.returncode = f"{done.returncode} with {sides}"
            check(f"{cells}^3 cells in {megabytes} MB", (0, 1) if is_enough else (0, 1, 2, 127), done)


def output(folder):
    for redirection in (">/dev/full", ">&-"):
        for words in (f"run {EXACT}", f"gate {EXACT}", "tables 4.1", "design --young 0.3 --poisson 0.3", "eigen --poisson 0.3", "--version", "gate --help"):
            done = subprocess.run(f"{PROGRAM} {words} {redirection}", shell=True, env=ALONE, stderr=subprocess.PIPE, timeout=ALLOWED_SECONDS)
            check(f"{words} {redirection}", (2,), done)


def disk(folder):
    """A disk that is full or read-only is found before anything is solved; one that fills up later ends the command; with room it completes."""
    small = folder / "small"
    small.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=64m", "tmpfs", small]
    if subprocess.run(mount, stderr=subprocess.DEVNULL).returncode != 0:
        print("no right to mount: the disk is left out")
        return

    def remount(options):
        subprocess.run(["mount", "-o", f"remount,{options}", small], check=True)

    try:
        for name, words in (("run", ["run", CUBE]), ("gate", ["gate", CUBE]), ("tables", ["tables", "4.1"]), ("eigen", ["eigen", "--poisson", "0.3"]),
                            ("design", ["design", "--neo-hookean", "0.04", "--method", "nonlinear_method"])):
            words = [*words, "--out", small / name]
            remount("size=64m,ro")
            check(f"{name} --out on a read-only disk", (2,), run(words))
            remount("size=64m,rw")
            check(f"{name} again", (0,), run(words))
            needed = sum(path.stat().st_size for path in small.rglob("*") if path.is_file())
            shutil.rmtree(small / name)
            remount(f"size={max(needed // 2, 100_000) // 4096 * 4}k")
            check(f"{name} --out on a disk that fills up", (2,), run(words), lines=2)
            check_whole(small / name)
            remount("size=64m")
            check(f"{name} again with room", (0,), run(words))
            shutil.rmtree(small / name)
            remount("size=48k")
            (small / "filler").write_bytes(b"x" * 40_000)
            check(f"{name} --out on a full disk", (2,), run(words))
            remount("size=64m")
            check(f"{name} again", (0,), run(words))
            shutil.rmtree(small / name)
            (small / "filler").unlink()
    finally:
        subprocess.run(["umount", small], check=True)


def check_whole(folder):
    """A command that has ended by itself leaves nothing unfinished."""
    global faults
    for path in folder.rglob("*.springproof-part"):
        faults += 1
        print(f"FAULT {path}: is left")


def children_of(pid):
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def workers(folder):
    process = subprocess.Popen([PROGRAM, "gate", CUBE, EXACT, "--workers", "2", "--out", folder / "workers", "--set", "body.cells=[16,16,16]"],
                               env=ALONE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    end = time.monotonic() + 20
    while time.monotonic() < end and process.poll() is None and not children_of(process.pid):
        time.sleep(0.01)
    for child in children_of(process.pid):
        os.kill(child, signal.SIGKILL)
    _, said = process.communicate(timeout=ALLOWED_SECONDS)
    check("killed workers", (1, 2), subprocess.CompletedProcess([], process.returncode, stderr=said), lines=3)


def ranks(folder):
    process = subprocess.Popen(["mpirun", "-n", "2", PROGRAM, "run", CUBE, "--set", "body.cells=[16,16,16]"], env=ALONE,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    end = time.monotonic() + 20
    while time.monotonic() < end and len(children_of(process.pid)) < 2:
        time.sleep(0.01)
    time.sleep(0.5)
    os.kill(children_of(process.pid)[-1], signal.SIGKILL)
    _, said = process.communicate(timeout=ALLOWED_SECONDS)
    check("a killed rank", tuple(range(1, 256)), subprocess.CompletedProcess([], process.returncode, stderr=said), lines=20)  # mpirun's words


def signals(folder):
    """CalculiX and its temporary folder go with the program that called it, however that ends."""
    global faults
    if not shutil.which("ccx"):
        print("CalculiX (ccx) is not installed: the signals are left out")
        return
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGKILL):
        place = folder / number.name
        place.mkdir()
        process = subprocess.Popen([PROGRAM, "run", "--peer", "ccx", CUBE, "--set", "body.cells=[16,16,16]", "--set", "fem.formulation=small_strain",
                                    "--set", "fem.element=q1"], env=dict(ALONE, TMPDIR=str(place)), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   # A shell's background commands ignore SIGINT, and what they start with them.
                                   preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        end = time.monotonic() + ALLOWED_SECONDS
        while time.monotonic() < end and process.poll() is None and not (called := processes_in(place)):
            time.sleep(0.01)
        process.send_signal(number)
        process.wait()
        while time.monotonic() < end and (processes_in(place) or any(place.iterdir())):
            time.sleep(0.01)
        left = [*processes_in(place), *place.iterdir()]
        is_good = called and not left and process.returncode == -number
        faults += not is_good
        print(f"{'ok   ' if is_good else 'FAULT'} {number.name} while CalculiX runs: {called} ran, {left} left, status {process.returncode}", flush=True)


def processes_in(folder):
    """Those whose working folder is in this one."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if str(folder) in os.readlink(process / "cwd"):
                found.append(int(process.name))
        except OSError:  # it has ended
            pass
    return found


def main():
    parts = [memory, output, disk, workers, ranks, signals]
    asked = sys.argv[3:] or [part.__name__ for part in parts]
    assert set(asked) <= {part.__name__ for part in parts}, asked
    for part in parts:
        if part.__name__ in asked:
            with tempfile.TemporaryDirectory() as name:
                part(Path(name))
    sys.exit(1 if faults else 0)


main()
