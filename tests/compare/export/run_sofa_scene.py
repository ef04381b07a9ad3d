"""Solves an exported scene as SOFA does, with its components' equations and thresholds, from the scene's own numbers.

run_sofa_scene.py FOLDER N_STEPS

Prints the displacement (mm) of each node, a line each, after so many steps of the animation. StaticSolver finds the equilibrium;
BDFOdeSolver of order 1 or 2 solves a x_1 + ... = h b v_1, M (a v_1 + ...) = h b f_1, both with NewtonRaphsonSolver, which ends when the residual
has the absolute size that the scene asks for. Damping is -rayleighMass M v + rayleighStiffness df/dx v, of the body as it is.
Only Python's standard library and what scene.py itself uses are used.
"""

import math
import sys
from pathlib import Path

import sofa_objects


class Scene:
    def __init__(self, folder):
        objects = sofa_objects.scene_of(folder)
        of = lambda component: [data for name, data in objects if name == component]
        (self.state,), (self.newton,) = of("MechanicalObject"), of("NewtonRaphsonSolver")
        assert of("SparseLDLSolver")
        self.springs = list(sofa_objects.springs_of(of("SpringForceField")))
        self.loads, self.controllers, self.fields = of("ConstantForceField"), of("Controller"), of("ForceField")
        self.skin = of("OglModel")
        n = len(self.state["position"])
        fixed = [[0] * 3 for _ in range(n)]
        for support in of("PartialFixedProjectiveConstraint"):
            for node in support["indices"]:
                fixed[node] = support["fixedDirections"]
        self.free = [3 * node + a for node in range(n) for a in range(3) if not fixed[node][a]]
        self.x = [list(place) for place in self.state["position"]]
        self.state["position"] = self.x  # what a controller writes to
        self.step = objects[0][1]["dt"]
        if self.step:
            (ode,), (mass,), (topology,) = of("BDFOdeSolver"), of("DiagonalMass"), of("EdgeSetTopologyContainer")
            assert len(mass["vertexMass"]) == len(topology["position"]) == n and len(topology["edges"]) >= len(self.springs)
            self.mass, self.order = mass["vertexMass"], ode["order"]
            self.alpha, self.beta = ode["rayleighMass"], ode["rayleighStiffness"]
        else:
            assert of("StaticSolver")

    def forces(self, x):
        """mN, and df/dx, on free degrees of freedom."""
        place = {d: row for row, d in enumerate(self.free)}
        force = [0.0] * len(self.free)
        slope = [[0.0] * len(self.free) for _ in self.free]
        for load in self.loads:
            for node, f in zip(load["indices"], load["forces"]):
                for a in range(3):
                    if 3 * node + a in place:
                        force[place[3 * node + a]] += f[a]
        for field in self.fields:
            for node, f in enumerate(field.forces(x)):
                for a in range(3):
                    if 3 * node + a in place:
                        force[place[3 * node + a]] += f[a]
            for i, j, value in field.slope(len(x)):
                if i in place and j in place:
                    slope[place[i]][place[j]] += value
        for i, j, stiffness, rest_length in self.springs:
            d = [b - a for a, b in zip(x[i], x[j])]
            length = math.sqrt(sum(c * c for c in d))
            e = [c / length for c in d]
            tension = stiffness * (length - rest_length)
            for sign, node in ((1, i), (-1, j)):
                for a in range(3):
                    row = place.get(3 * node + a)
                    if row is None:
                        continue
                    force[row] += sign * tension * e[a]
                    for other_sign, other in ((1, j), (-1, i)):
                        for b in range(3):
                            column = place.get(3 * other + b)
                            if column is not None:
                                k = stiffness * e[a] * e[b] + tension / length * ((a == b) - e[a] * e[b])
                                slope[row][column] += sign * other_sign * k
        return force, slope

    def newton_solve(self, evaluate, update):
        """evaluate() gives a residual and the matrix that its negative is divided by."""
        for _ in range(self.newton["maxNbIterationsNewton"] + 1):
            residual, matrix = evaluate()
            if math.sqrt(sum(r * r for r in residual)) <= self.newton["absoluteResidualStoppingThreshold"]:
                return
            update(solve(matrix, [-r for r in residual]))
        raise AssertionError("no convergence")

    def add(self, to, step):
        for d, value in zip(self.free, step):
            to[d // 3][d % 3] += value

    def equilibrium(self):
        def evaluate():
            force, slope = self.forces(self.x)
            return [-f for f in force], [[-k for k in row] for row in slope]
        self.newton_solve(evaluate, lambda step: self.add(self.x, step))

    def move(self, n_steps):
        h = self.step
        before = []  # positions and velocities, the latest last
        v = [0.0] * len(self.free)
        for n in range(n_steps):
            for controller in self.controllers:
                if hasattr(controller, "onAnimateBeginEvent"):
                    controller.onAnimateBeginEvent({})
            before.append(([self.x[d // 3][d % 3] for d in self.free], v))
            order = min(self.order, n + 1)
            back, b = {1: ([1.0], 1.0), 2: ([4 / 3, -1 / 3], 2 / 3)}[order]
            known_x, known_v = ([sum(c * state[part][i] for c, state in zip(back, reversed(before[-order:]))) for i in range(len(self.free))]
                                for part in (0, 1))
            v = list(v)
            mass = [self.mass[d // 3] for d in self.free]

            def place():
                for i, d in enumerate(self.free):
                    self.x[d // 3][d % 3] = known_x[i] + h * b * v[i]

            def evaluate():
                place()
                force, slope = self.forces(self.x)
                for i, row in enumerate(slope):
                    force[i] += self.beta * sum(k * w for k, w in zip(row, v)) - self.alpha * mass[i] * v[i]
                residual = [m * (w - w0) - h * b * f for m, w, w0, f in zip(mass, v, known_v, force)]
                matrix = [[-h * b * (self.beta + h * b) * k for k in row] for row in slope]
                for i, m in enumerate(mass):
                    matrix[i][i] += m * (1 + h * b * self.alpha)
                return residual, matrix

            def update(step):
                for i, value in enumerate(step):
                    v[i] += value
            self.newton_solve(evaluate, update)
            place()
            before = before[-2:]


def solve(matrix, right):
    """Gauss, of a symmetric positive definite matrix."""
    rows = [list(row) + [r] for row, r in zip(matrix, right)]
    n = len(rows)
    for i in range(n):
        pivot = rows[i]
        assert pivot[i] > 0
        for lower in rows[i + 1:]:
            if lower[i] != 0:
                factor = lower[i] / pivot[i]
                for c in range(i, n + 1):
                    lower[c] -= factor * pivot[c]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][c] * x[c] for c in range(i + 1, n))) / rows[i][i]
    return x


def main():
    scene = Scene(Path(sys.argv[1]))
    if scene.step:
        scene.move(int(sys.argv[2]))
    else:
        scene.equilibrium()
    for controller in scene.controllers:
        if hasattr(controller, "onAnimateEndEvent"):
            controller.onAnimateEndEvent({})
    for skin in scene.skin:  # every vertex of a block without a surface of its own is at a node
        assert all(min(math.dist(vertex, place) for place in scene.x) < 1e-9 for vertex in skin["position"]), "another skin"
    for place, rest in zip(scene.x, scene.state["rest_position"]):
        print(",".join(repr(x - r) for x, r in zip(place, rest)))


main()
