"""The Python module where a script does what no command line can: motions, threads, objects that outlive others, arrays as settings, Ctrl-C, the end
of Python in the midst of a solve. install/python_test.py has the rest.

module_test.py SOURCE PROGRAM

Looked for the same kind of defect (numbers that are read where there are none, and a solve that goes around the program's pipeline): every
property of a Solution of a motion, of springs without cells, of another Case; `compare`, which had the pipeline already; `design`, which went
around the checks of the command's options.
"""

import gc
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import warnings

import numpy as np
import springproof

source, program = pathlib.Path(sys.argv[1]), sys.argv[2]
bar, block = source / "cases/studies/released_bar.toml", source / "examples/library/block.toml"


def message(function):
    try:
        function()
    except springproof.InputError as error:
        return str(error)
    raise AssertionError("no InputError")


def printed(*words):
    """What the program prints of a case."""
    return json.loads(subprocess.run([program, "run", "--json", *words], capture_output=True, text=True, check=True).stdout)["cases"][0]


def check_motions():
    """A motion is solved and measured as by the program; what it does not have is refused."""
    case = springproof.read_case(bar)
    of_program = {measure["name"]: measure for measure in printed(bar)["measures"]}
    assert case.units["frequency"] == "Hz" and ", in time" in repr(case), case
    for side in ("msm", "fem"):
        motion = case.solve(side)
        for name, value in case.measure(motion).items():
            assert np.isclose(value, of_program[name][side], rtol=1e-9), (side, name, value, of_program[name])  # printed in full; BLAS may differ
        assert motion.times.shape == (301,) and np.isclose(motion.times[-1], 0.6) and motion.trajectory.shape == (301, 1, 3)
        assert motion.bodies.shape == (len(motion.body_times), len(case.nodes), 3)
        assert (motion.bodies[-1] == motion.displacement).all() and (motion.trajectory[-1, 0] == motion.displacement[motion.watched_nodes[0]]).all()
        assert motion.volumes.size == 0 and "300 steps to 0.6 s" in repr(motion), motion
        for name in ("reaction", "stress", "strain", "strain_energy"):
            assert "is a motion" in message(lambda: getattr(motion, name))
    resting = springproof.read_case(block).solve("msm")
    for name in ("times", "trajectory", "watched_nodes", "volumes", "bodies", "body_times"):
        assert "is an equilibrium" in message(lambda: getattr(resting, name))
    # What does not swing has no frequency, and no number in its place.
    still = springproof.read_case(bar, {"dynamics.end": 0.004})
    assert still.measure(still.solve("msm"))["frequency"] is None


def check_other_cases():
    """A solution of another case is not measured, be its mesh larger, smaller or the same."""
    case = springproof.read_case(block)
    for settings in ({"body.cells": [2, 2, 4]}, {"body.cells": [6, 6, 12]}, {}):
        other = springproof.read_case(block, settings)
        solution = other.solve("msm")
        assert "is not of this Case" in message(lambda: case.measure(solution))
        assert solution.case is other and other.measure(solution)["volume"] > 128


def check_lifetimes():
    """Arrays keep their solution, a solution its case; none can be written to."""
    case = springproof.read_case(block)
    solution = case.solve("msm")
    arrays = {name: getattr(solution, name) for name in ("displacement", "reaction", "cell_volume", "stress", "strain")}
    copies = {name: array.copy() for name, array in arrays.items()}
    shown = case.measure(solution)
    del case
    gc.collect()
    assert solution.case.measure(solution) == shown and solution.case.nodes.shape == (225, 3)
    del solution
    gc.collect()
    trash = [np.full(n, np.nan) for n in range(1, 4000)]  # overwrites whatever was freed
    for name, array in arrays.items():
        assert (array == copies[name]).all() and not array.flags.writeable, name
    del trash


def check_settings():
    """Arrays, tuples, paths, truths and tables as settings; what is none is refused with its key."""
    by_lists = springproof.read_case(block, {"body.cells": [2, 2, 4], "load[0].value": [0, 0, 0.003]})
    read = springproof.read_case(block, {"body.cells": np.array([2, 2, 4]), "load[0].value": (0, np.float32(0), np.float64(0.003)), "description": "of \"arrays\"",
                                         "material": {"model": "linear_elastic", "youngs_modulus": np.int64(1), "poissons_ratio": 0.3}})
    assert (read.nodes == by_lists.nodes).all() and read.description == "of \"arrays\"", read
    assert np.isclose(read.solve("msm").reaction[:, 2].sum(), by_lists.solve("msm").reaction[:, 2].sum())
    for value in (None, {1, 2}, object(), [1, None]):
        assert message(lambda: springproof.read_case(block, {"fem.refine": value})).startswith("fem.refine: is ")
    for value in (np.array([1, 2]), np.nan, np.inf, 2.5, True, "x"):
        assert "fem.refine: is " in message(lambda: springproof.read_case(block, {"fem.refine": value}))
    # The options of `design` are the command's, and so are their checks.
    for words in ({"young": 0, "poisson": 0.3}, {"young": 1, "poisson": np.inf}, {"young": 1, "poisson": 0.3, "edge": np.nan}, {"young": "--help"}, {"help": True},
                  {"young": 1}, {"young": 1, "poisson": 0.3, "method": "best"}, {"young": 1, "poisson": 0.3, "colour": 1}):
        assert message(lambda: springproof.design(**words)), words
    ogden = springproof.design(ogden_mu=np.array([0.01, -0.002]), ogden_alpha=[2, -2], method="multi_load", springs_only=True)
    assert ogden["stiffness_N_per_m"] != springproof.design(ogden_mu=[0.01, -0.002], ogden_alpha=[2, -2], method="multi_load")["stiffness_N_per_m"]


def check_warnings():
    """What the program prints as a warning is one."""
    settings = ["material.poissons_ratio=0.1", "msm.design=hybrid"]  # a volume term below zero
    of_program = printed(block, *(word for setting in settings for word in ("--set", setting)))["msm"]["warnings"]
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        solution = springproof.read_case(block, {"material.poissons_ratio": 0.1, "msm.design": "hybrid"}).solve("msm")
    assert of_program and set(of_program) <= set(solution.warnings), (of_program, solution.warnings)
    assert [str(each.message) for each in caught] == solution.warnings and caught[0].filename == __file__, caught


def check_threads():
    """Sixteen threads solve finite elements, springs and PETSc's springs at once, and have the numbers of one."""
    gate = source / "cases/gates/sheared_cube.toml"
    settings = [{"body.cells": [2, 2, 2]}, {"body.cells": [3, 3, 3], "msm.solver": "snes"}]
    cases = [springproof.read_case(gate, each) for each in settings]
    jobs = [(case, side) for case in cases for side in ("msm", "fem")] * 4
    alone = {job: job[0].measure(job[0].solve(job[1])) for job in jobs[:4]}
    found, failed = [], []

    def solve(job):
        try:
            for _ in range(3):
                found.append((job, job[0].measure(job[0].solve(job[1]))))
        except BaseException as error:
            failed.append(error)

    threads = [threading.Thread(target=solve, args=(job,)) for job in jobs]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not failed and len(found) == 48, failed[:1]
    for job, values in found:
        assert all(np.isclose(value, alone[job][name], rtol=1e-12) for name, value in values.items()), (job, values)


LONG = """
import os, signal, sys, threading, time, springproof
def long(side):
    if side == "snes":
        return springproof.read_case(sys.argv[3], {"body.cells": [20, 20, 40], "msm.design": "uniform", "msm.solver": "snes"}), "msm"
    return springproof.read_case(sys.argv[1], {"dynamics.end": 6000}), side
def solve(side):
    case, name = long(side)
    case.solve(name)
def interrupt():
    threading.Timer(1, os.kill, (os.getpid(), signal.SIGINT)).start()
"""
INTERRUPTED = LONG + """
interrupt()
try: solve(sys.argv[2])
except KeyboardInterrupt: pass
block = springproof.read_case(sys.argv[3])
for side in ("msm", "fem"): assert block.measure(block.solve(side))["volume"] > 128
print("went on")
"""
WAITING = LONG + """
threading.Thread(target=solve, args=(sys.argv[2],), daemon=True).start()
time.sleep(0.5)
interrupt()
try: solve(sys.argv[2])
except KeyboardInterrupt: print("went on")
"""
HANDLER = LONG + """
block = springproof.read_case(sys.argv[3])
def handle(*_):
    if block.measure(block.solve("fem"))["volume"] > 128: raise OSError("enough")
signal.signal(signal.SIGALRM, handle)
signal.alarm(1)
try: solve(sys.argv[2])
except OSError as error: print("went on")
"""


def check_interruptions():
    """Ctrl-C ends a solve and one that waits for another; a handler may solve; Python may end while threads solve. Each solve would take much longer."""
    for script, sides in ((INTERRUPTED, ("msm", "fem", "snes")), (WAITING, ("msm", "fem", "snes")), (HANDLER, ("msm", "fem", "snes"))):
        for side in sides:
            done = subprocess.run([sys.executable, "-W", "ignore", "-c", script, bar, side, block], capture_output=True, text=True, timeout=200)
            assert done.returncode == 0 and done.stdout == "went on\n" and done.stderr == "", (script, side, done)


def check_page():
    """docs/using/python.md names all that there is, and its code runs."""
    page = (source / "docs/using/python.md").read_text()
    names = [name for of in (springproof.Case, springproof.Solution) for name in vars(of) if not name.startswith("_")] + springproof.__all__
    missing = [name for name in names if f"`{name}" not in page and f".{name}" not in page]
    assert not missing, missing
    for code in re.findall(r"```python\n(.*?)```", page, re.DOTALL):
        subprocess.run([sys.executable, "-W", "ignore", "-c", code], cwd=source, check=True, stdout=subprocess.DEVNULL)


for check in (check_motions, check_other_cases, check_lifetimes, check_settings, check_warnings, check_threads, check_interruptions, check_page):
    check()
    print(f"{check.__name__[6:]}: {check.__doc__}")
