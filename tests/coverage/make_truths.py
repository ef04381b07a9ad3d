"""Makes truths.csv: the values that the problems of problems.py draw towards, by a solver of another kind than springproof's.

usage: make_truths.py OUT.csv [NAME ...]    with names, these problems alone are made anew
       make_truths.py --verify              patch test, a uniaxial stretch in closed form, the law against its energy

Each problem is solved on levels (order of the elements, layers of the grading towards lines where the solution is singular); spaces of
a level contain those of the level before. A truth is the value on the last level, its uncertainty the larger of its last change and
1e-9 of it. As energies bound: under loads the stored energy of a linear body grows from level to level, under prescribed displacements it falls;
where it does not, the program stops. Needs Debian's python3-numpy, python3-scipy and libcholmod3 (suitesparse).
"""

import csv
import datetime
import os
import platform
import sys
import time

for threads in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[threads] = "1"

sys.dont_write_bytecode = True

import numpy as np
import scipy

from elements import Body
from laws import LAWS
from problems import PROBLEMS, box, elastic, face, moved, ogden, problem, reaction, traction, u

# The tangent of some Ogden bodies becomes indefinite at clamped edges with more layers.
LINEAR_LEVELS, FINITE_LEVELS = [(3, 1), (4, 2), (5, 2)], [(3, 1), (4, 1), (5, 1)]
COLUMNS = ["case", "measure", "unit", "truth", "uncertainty", "how"]


def solve(p):
    """Values of each measure by level, and what the levels were."""
    levels, before, results, told = p["levels"], None, [], []
    if levels is None:
        levels = LINEAR_LEVELS if p["formulation"] == "small_strain" else FINITE_LEVELS
    for order, layers in levels:
        began, body = time.time(), Body(p, order, layers)
        start = None
        if before is not None and p["formulation"] != "small_strain":
            sampled = before.grid.sample(before.u, body.grid.positions).reshape(-1, 3)[body.grid.used]
            start = np.where(body.held, body.prescribed(1), sampled)
        try:
            body.solve(start)
        except ArithmeticError:  # too far from equilibrium: in steps from rest
            body = Body(p, order, layers).solve()
        results.append([body.measure(m) for m in p["measures"]])
        told.append(f"p = {order}, {layers} layers of 0.15, {body.unknowns} unknowns")
        print(f"{p['name']}: {told[-1]}: {time.time() - began:.1f} s, {body.iterations} iterations;",
              *(f"{m['name']} {value:.9g}" for m, value in zip(p["measures"], results[-1])), flush=True)
        before = body
    check_bounds(p, results)
    return np.array(results), told


def check_bounds(p, results):
    names = [m["name"] for m in p["measures"]]
    if "energy" not in names or p["formulation"] != "small_strain" or (p["load"] and p["move"]):
        return
    energies = [values[names.index("energy")] for values in results]
    sign = 1 if p["load"] else -1
    for coarse, fine in zip(energies, energies[1:]):
        if sign * (fine - coarse) < -1e-9 * abs(fine):
            sys.exit(f"{p['name']}: the energies {energies} do not bound")


def verify():
    # A linear field on a tapered block is exact.
    patch = problem("patch", "", {"kind": "block", "size": [1, 1, 1], "cells": [2, 2, 2], "corners":
                    [[0, 0, 0], [3, 0, 0], [0, 2, 0], [3, 2, 0], [0, 0, 2], [2.5, 0, 2], [0, 1.5, 2], [2.5, 1.5, 2]]}, elastic(1, 0.3),
                    [], ["0* 1", "0 1*", "0 1"], fixed=())
    body, gradient = Body(patch, 3, 1), np.array([[1, 2, 3], [-1, 0.5, 2], [0.3, 1, -2]]) * 1e-3
    exact = body.rest @ gradient.T
    stress = body.laws[0].stress(gradient)
    forces = body.internal(exact)
    inner = np.all((body.grid.points > 1e-9) & (body.grid.points < 1 - 1e-9), -1)
    volume = 0
    for e in range(len(body.grid.elements)):
        volume += body.element(e)[1].sum()
    virial = np.einsum("ai,aj->ij", forces, body.rest) / volume
    print("patch test:", np.abs(forces[inner]).max(), np.abs(virial - stress).max() / np.abs(stress).max())
    assert np.abs(forces[inner]).max() < 1e-14 and np.abs(virial - stress).max() < 1e-12 * np.abs(stress).max()
    # Uniaxial stretch of an Ogden block: the lateral stretch by bisection.
    material, stretch = ogden([0.1, 0.05], [5, -3], 0.8), 1.3
    law = LAWS["hyperelastic"](material)
    low, high = 0.5, 1.2
    for _ in range(100):
        side = (low + high) / 2
        low, high = (side, high) if law.kirchhoff(np.log(np.array([side, side, stretch])))[0] < 0 else (low, side)
    nominal = law.kirchhoff(np.log(np.array([side, side, stretch])))[2] / stretch
    pulled = problem("uniaxial", "", box([1, 1, 1], [1, 1, 1]), material, [reaction("r", "z-", "z"), u("x", [1, 1, 1], "x")],
                     ["0 1"] * 3, fixed=(), symmetry=("x-", "y-", "z-"), move=[moved(face("z+"), [0, 0, stretch - 1], "z")], steps=3)
    body = Body(pulled, 2, 1).solve()
    force, x = (body.measure(m) for m in pulled["measures"])
    print("uniaxial stretch:", abs(force) / nominal - 1, (1 + x) / side - 1)
    assert abs(abs(force) / nominal - 1) < 1e-8 and abs((1 + x) / side - 1) < 1e-8
    # Every law with an energy: the stress is its derivative.
    h = np.random.default_rng(1).normal(size=(3, 3)) * 0.1
    for name, law in (("small_strain", elastic(1, 0.3)), ("saint_venant_kirchhoff", elastic(1, 0.3)), ("hyperelastic", material)):
        law = LAWS[name](law)
        changes = [[1e-5 * np.outer(i, j) for j in np.eye(3)] for i in np.eye(3)]
        slope = np.array([[(law.energy(h + change) - law.energy(h - change)) / 2e-5 for change in row] for row in changes])
        print(name, np.abs(slope - law.stress(h)).max())
        assert np.abs(slope - law.stress(h)).max() < 1e-8
    # A uniform traction on a block that may contract freely.
    bar = problem("bar", "", box([1, 1, 2], [1, 1, 2]), elastic(2, 0.3), [u("z", [1, 1, 2], "z"), u("x", [1, 1, 2], "x")], ["0* 1", "0 1", "0 2"],
                  fixed=(), symmetry=("x-", "y-", "z-"), load=[traction(face("z+"), [0, 0, 0.1])])
    values = [Body(bar, 3, 1).solve().measure(m) for m in bar["measures"]]
    print("bar:", values)
    assert np.allclose(values, [0.1, -0.015], rtol=1e-10)


def main():
    if sys.argv[1:] == ["--verify"]:
        verify()
        return
    out, names = sys.argv[1], sys.argv[2:]
    rows = []
    if names:
        with open(out, encoding="utf-8") as file:
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    for p in PROBLEMS:
        if names and p["name"] not in names:
            continue
        values, told = solve(p)
        rows = [row for row in rows if row["case"] != p["name"]]
        for m, series in zip(p["measures"], values.T):
            own = max(abs(series[-1] - series[-2]), 1e-9 * abs(series[-1]))
            rows.append({"case": p["name"], "measure": m["name"], "unit": m["unit"], "truth": f"{series[-1]:.10g}", "uncertainty": f"{own:.2g}",
                         "how": f"{told[-1]}; before: {told[-2]}"})
        order = {q["name"]: n for n, q in enumerate(PROBLEMS)}
        rows = sorted((row for row in rows if row["case"] in order), key=lambda row: order[row["case"]])
        with open(out, "w", encoding="utf-8", newline="") as file:
            file.write("# True values of the coverage test's problems (problems.py), by make_truths.py: hexahedra of high order on graded grids.\n"
                       f"# Last made {datetime.date.today()}; python {platform.python_version()}, numpy {np.__version__}, "
                       f"scipy {scipy.__version__}, CHOLMOD of suitesparse 5.\n"
                       "# The uncertainty is the change from the level before.\n")
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
