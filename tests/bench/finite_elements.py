#!/usr/bin/env python3
"""Times of the finite elements, each the median of several runs of the program: the second half of ./do bench.

Solves alone (from the start of the load path to the answer; reading, meshing and writing are not counted), by the
program's own clock; memory is the largest resident set of any one process. The machine has to be idle.
"""

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys

LAUNCHER = ["mpirun", "--bind-to", "none", "-n"]
SHEAR = ["cases/sweep/cube_shear.toml", "--only", "fem", "--set", "fem.accuracy=none"]
TENSION = ["cases/thesis/linear_elastic/cube_tensile_large.toml", "--set", "fem.accuracy=none"]
NEARLY_INCOMPRESSIBLE = [
    "--set", 'material={model="ogden",mu=[0.01444,0.01444,0.01444],alpha=[5.7255,5.7255,5.7255],bulk_modulus=43.32}',
    "--set", "fem.formulation=hyperelastic", "--set", "fem.element=q1_p0",
    "--set", "msm={design=\"given\",stiffness=[14,17,63]}",
]  # fmt: skip


def cells(n):
    return ["--set", f"body.cells=[{n},{n},{n}]"]


def load(*value):
    return ["--set", f"load[0].value={list(value)}"]


class Bench:
    def __init__(self, program, runs):
        self.program, self.runs = program, runs

    def sides(self, arguments, ranks=1):
        """What the JSON of each run says of its first case."""
        command = (LAUNCHER + [str(ranks)] if ranks > 1 else []) + [self.program, "run", *arguments, "--json"]
        answers = []
        for _ in range(self.runs):
            done = subprocess.run(command, capture_output=True, text=True)
            if not done.stdout:
                sys.exit(f"{' '.join(command)}: {done.stderr.strip()}")
            answers.append(json.loads(done.stdout)["cases"][0])
        return answers

    def seconds(self, arguments, ranks=1):
        """Median seconds of the finite elements' solves, and the last answer."""
        answers = self.sides(arguments, ranks)
        times = [a["fem"]["seconds"]["solve"] for a in answers]
        return statistics.median(times), answers[-1]["fem"]


def line(what, seconds, fem, more=""):
    print(f"{what:44} {seconds:8.3f} s {fem['unknowns']:>9} unknowns  "
          f"{fem['newton_iterations']:>3} Newton {fem['linear_iterations']:>4} linear  {more}", flush=True)  # fmt: skip


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default="build/springproof")
    parser.add_argument("--runs", type=int, default=3, help="runs of each (3)")
    parser.add_argument("--largest", type=int, default=100, help="cells along an edge of the largest cube (100)")
    arguments = parser.parse_args()
    os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1",
                      OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")  # fmt: skip
    bench = Bench(arguments.program, arguments.runs)

    print("traction shear, log strain, q1_bbar; one thread a rank")
    one_rank, per_unknown = {}, {}
    for n in (20, 30, 40, 60, arguments.largest):
        one_rank[n], fem = bench.seconds(SHEAR + cells(n))
        per_unknown[n] = one_rank[n] / fem["unknowns"]
        line(f"{n}^3, one rank", one_rank[n], fem, f"{1e6 * per_unknown[n]:.2f} us an unknown")
    for n in (40, 60, arguments.largest):
        two, fem = bench.seconds(SHEAR + cells(n), ranks=2)
        line(f"{n}^3, two ranks", two, fem, f"{one_rank[n] / two:.2f} times as fast")
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 2**20
    print(f"largest process so far {peak:.2f} GiB; largest time per unknown over that of 20^3 "
          f"{max(per_unknown.values()) / per_unknown[20]:.2f}, over the smallest "
          f"{max(per_unknown.values()) / min(per_unknown.values()):.2f}")  # fmt: skip

    quadratic, fem = bench.seconds(SHEAR + cells(20) + ["--set", "fem.element=q2"])
    line("q2, 20^3", quadratic, fem, f"{quadratic / one_rank[40]:.2f} times q1_bbar's 40^3")

    seconds, fem = bench.seconds(SHEAR + cells(20) + NEARLY_INCOMPRESSIBLE)
    line("Ogden q1_p0, kappa / mu = 1000, 20^3", seconds, fem,
         f"{fem['linear_iterations'] / fem['newton_iterations']:.1f} iterations a linear solve")  # fmt: skip

    for name, value in (("shear", (0.3, 0, 0)), ("pull", (0, 0, 0.3)), ("press", (0, 0, -0.3))):
        seconds, fem = bench.seconds(SHEAR + cells(20) + load(*value))
        line(f"load that cannot be carried, 20^3, {name}", seconds, fem, f"{fem['load_reached']:.3f} of it reached")

    peer = ["--set", "fem.formulation=saint_venant_kirchhoff", "--set", "fem.element=q1", "--peer", "ccx"]
    answers = bench.sides(TENSION + peer)
    ours = statistics.median(a["fem"]["seconds"]["solve"] for a in answers)
    theirs = statistics.median(a["peer"]["seconds"]["solve"] for a in answers)
    line("Saint Venant-Kirchhoff q1, 10^3", ours, answers[-1]["fem"], f"{ours / theirs:.2f} of CalculiX's {theirs:.2f} s")


main()
