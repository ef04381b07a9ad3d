"""Which springs follow a block of tissue best as it becomes incompressible: errors of three designs against finite elements.

    PYTHONPATH=PREFIX/lib/python3/dist-packages python3 compare_designs.py ../library/block.toml

Writes compare_designs.svg, with gnuplot.
"""

import subprocess
import sys

import numpy as np
import springproof

designs = ["linear_method", "moduli", "matched"]
ratios = [0.25, 0.3, 0.35, 0.4, 0.45]


def error_percent(poissons_ratio, design):
    """Root mean square of the difference of the two displacement fields over that of the finite elements, percent."""
    case = springproof.read_case(sys.argv[1], {"material.poissons_ratio": poissons_ratio, "msm.design": design})
    fem, springs = case.solve("fem"), case.solve("msm")
    return 100 * np.linalg.norm(springs.displacement - fem.displacement) / np.linalg.norm(fem.displacement)


errors = np.array([[error_percent(nu, design) for design in designs] for nu in ratios])
rows = np.column_stack([ratios, errors])
np.savetxt("compare_designs.txt", rows, fmt="%.4g", header="poissons_ratio " + " ".join(designs), comments="")
print(open("compare_designs.txt").read(), end="")

plot = """set terminal svg size 640,400 background 'white'; set output 'compare_designs.svg'
set xlabel "Poisson's ratio"; set ylabel 'error of the displacement field, %'; set key left top noenhanced; set grid
plot for [design=2:4] 'compare_designs.txt' using 1:design with linespoints title columnheader(design)"""
subprocess.run(["gnuplot", "-e", plot.replace("\n", ";")], check=True)
