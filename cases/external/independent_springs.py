#!/usr/bin/env python3
"""An in-house solver as others have them, in plain Python: the springs of pulled_bar.toml, and nothing else.

    python3 independent_springs.py > pulled_bar.csv

It shares no line with springproof: points and springs are listed one by one, the tangent is dense, and Newton's
method is solved by elimination. Its file is what `--msm-displacements` reads: x,y,z,ux,uy,uz in mm.
"""
import itertools
import math

N_CELLS = (2, 2, 4)  # cubes of 1 mm
STIFFNESS = {1: 0.031, 2: 0.047, 3: 0.033}  # N/mm, by the number of axes that a spring runs along
FORCE = (0.0015, 0.0, 0.004)  # N on every node of the far end


def springs_of(points):
    """{(i, j): stiffness}: every pair of a cell's vertices, added up over the cells."""
    number = {point: index for index, point in enumerate(points)}
    springs = {}
    for cell in itertools.product(*(range(n) for n in N_CELLS)):
        corners = [tuple(c + d for c, d in zip(cell, corner)) for corner in itertools.product((0, 1), repeat=3)]
        for a, b in itertools.combinations(corners, 2):
            n_axes = sum(x != y for x, y in zip(a, b))
            pair = tuple(sorted((number[a], number[b])))
            springs[pair] = springs.get(pair, 0.0) + STIFFNESS[n_axes]
    return springs


def residual_and_tangent(points, position, springs):
    """Sum of forces on every degree of freedom (N), and minus its derivative (N/mm)."""
    n = 3 * len(points)
    force = [FORCE[d % 3] if points[d // 3][2] == N_CELLS[2] else 0.0 for d in range(n)]
    tangent = [[0.0] * n for _ in range(n)]
    for (i, j), stiffness in springs.items():
        vector = [position[3 * j + a] - position[3 * i + a] for a in range(3)]
        length = math.sqrt(sum(v * v for v in vector))
        rest = math.dist(points[i], points[j])
        tension = stiffness * (length - rest)
        for a in range(3):
            force[3 * i + a] += tension * vector[a] / length
            force[3 * j + a] -= tension * vector[a] / length
            for b in range(3):
                along = vector[a] * vector[b] / length**2
                block = stiffness * along + tension / length * ((a == b) - along)
                tangent[3 * i + a][3 * i + b] += block
                tangent[3 * j + a][3 * j + b] += block
                tangent[3 * i + a][3 * j + b] -= block
                tangent[3 * j + a][3 * i + b] -= block
    return force, tangent


def eliminate(matrix, right):
    """Solves a symmetric positive definite system."""
    n = len(right)
    for k in range(n):
        for i in range(k + 1, n):
            factor = matrix[i][k] / matrix[k][k]
            if factor:
                for j in range(k, n):
                    matrix[i][j] -= factor * matrix[k][j]
                right[i] -= factor * right[k]
    for k in reversed(range(n)):
        right[k] = (right[k] - sum(matrix[k][j] * right[j] for j in range(k + 1, n))) / matrix[k][k]
    return right


def main():
    points = list(itertools.product(*(range(n + 1) for n in N_CELLS)))
    springs = springs_of(points)
    position = [float(x) for point in points for x in point]
    free = [d for d in range(len(position)) if points[d // 3][2] > 0]
    for _ in range(30):
        force, tangent = residual_and_tangent(points, position, springs)
        step = eliminate([[tangent[r][c] for c in free] for r in free], [force[d] for d in free])
        for d, change in zip(free, step):
            position[d] += change
        if max(map(abs, step)) < 1e-13:
            break
    else:
        raise SystemExit("Newton's method has not converged")
    print("x,y,z,ux,uy,uz")
    for index, point in enumerate(points):
        moved = [position[3 * index + a] - point[a] for a in range(3)]
        print(",".join([str(x) for x in point] + [f"{u:.15g}" for u in moved]))


if __name__ == "__main__":
    main()
