"""Hexahedra of any order on graded tensor grids, with CHOLMOD: the independent solver behind make_truths.py.

Lagrange polynomials on Gauss-Lobatto points, full integration, displacements alone; Newton's method, with a tangent by differences of
the stress and the unknowns inside of elements eliminated. Needs numpy, scipy and libcholmod.
"""

import numpy as np
from numpy.polynomial import legendre
from scipy.sparse import coo_matrix, diags

from cholesky import Cholesky
from laws import LAWS
from problems import AXES, patch_rectangle

GRADING = 0.15  # ratio of successive layers' distances from a line towards which the mesh is graded


def lobatto(p):
    inner = legendre.Legendre.basis(p).deriv().roots()
    return np.concatenate([[-1.0], np.sort(inner.real), [1.0]])


def lagrange(nodes, x):
    """Values and derivatives [point, polynomial] of the Lagrange polynomials of some nodes."""
    vandermonde = np.linalg.inv(legendre.legvander(nodes, len(nodes) - 1))
    derivative = np.stack([legendre.legval(x, legendre.legder(row)) for row in np.eye(len(nodes))], -1)
    return legendre.legvander(x, len(nodes) - 1) @ vandermonde, derivative @ vandermonde


def breakpoints(text, layers, longest):
    """Ends of elements: "0* 4 10*" is graded from 0 towards 4 and from 10 towards 4."""
    marks = [(float(word.rstrip("*")), word.endswith("*")) for word in text.split()]
    result = [marks[0][0]]
    for (a, grade_a), (b, grade_b) in zip(marks, marks[1:]):
        near = [(b - a) * GRADING**k for k in range(layers, 0, -1)]
        inner = ([a + d for d in near] if grade_a else []) + ([b - d for d in reversed(near)] if grade_b else []) + [b]
        for x in inner:
            parts = max(1, int(np.ceil((x - result[-1]) / longest - 1e-9)))
            result += list(np.linspace(result[-1], x, parts + 1)[1:])
    return np.array(result)


class Grid:
    """Elements of order p between breakpoints, with the nodes of those that belong to the body."""

    def __init__(self, problem, p, layers):
        body = problem["body"]
        self.body, self.p = body, p
        self.lines = [breakpoints(text, layers, h) for text, h in zip(problem["lines"], problem["h"])]
        centres = [(x[1:] + x[:-1]) / 2 for x in self.lines]
        mesh = np.stack(np.meshgrid(*centres, indexing="ij"), -1)
        inside = np.ones(mesh.shape[:3], bool)
        if body["kind"] == "voxels":
            inside[:] = False
            for low, high in body["boxes"]:
                inside |= np.all((mesh > np.array(low)) & (mesh < np.array(high)), -1)
        self.inside, self.elements = inside, np.argwhere(inside)
        self.nodes_1d = lobatto(p)
        self.positions = [np.append(((x[:-1, None] + x[1:, None]) / 2 + (x[1:, None] - x[:-1, None]) / 2 * self.nodes_1d)[:, :-1].ravel(),
                                    x[-1]) for x in self.lines]
        counts = [len(x) for x in self.positions]
        self.counts = counts
        local = np.arange(p + 1)
        k, j, i = np.meshgrid(local, local, local, indexing="ij")  # x runs fastest
        lattice = np.arange(np.prod(counts)).reshape(counts)
        offset = self.elements * p
        full = lattice[offset[:, 0, None] + i.ravel(), offset[:, 1, None] + j.ravel(), offset[:, 2, None] + k.ravel()]
        self.used, conn = np.unique(full, return_inverse=True)
        self.conn = conn.reshape(full.shape)
        index = np.stack(np.unravel_index(self.used, counts), -1)
        self.points = np.stack([self.positions[d][index[:, d]] for d in range(3)], -1)  # reference coordinates
        self.is_inner = np.all((np.stack([i, j, k], -1).reshape(-1, 3) > 0) & (np.stack([i, j, k], -1).reshape(-1, 3) < p), -1)

    def map(self, points):
        """Places of points of reference, mm, and the map's gradient [..., i, reference axis]."""
        if self.body["kind"] != "block":
            return points, np.broadcast_to(np.eye(3), (*points.shape[:-1], 3, 3))
        x, gradient = np.zeros(points.shape), np.zeros((*points.shape, 3))
        for n, corner in enumerate(np.array(self.body["corners"], float)):
            sides = [(n >> d) & 1 for d in range(3)]
            factors = [points[..., d] if s else 1 - points[..., d] for d, s in enumerate(sides)]
            x += (factors[0] * factors[1] * factors[2])[..., None] * corner
            for d in range(3):
                others = np.prod([f for e, f in enumerate(factors) if e != d], 0) * (1 if sides[d] else -1)
                gradient[..., d] += others[..., None] * corner
        return x, gradient

    def shapes(self, gauss):
        """Values [q, node] and derivatives [q, axis, node] on a tensor grid of points in [-1, 1], x fastest; gauss: three arrays."""
        (vx, dx), (vy, dy), (vz, dz) = (lagrange(self.nodes_1d, g) for g in gauss)

        def product(z, y, x):
            return np.einsum("ck,bj,ai->cbakji", z, y, x).reshape(len(z) * len(y) * len(x), -1)

        return product(vz, vy, vx), np.stack([product(vz, vy, dx), product(vz, dy, vx), product(dz, vy, vx)], 1)

    def geometry(self, element):
        low = np.array([self.lines[d][element[d]] for d in range(3)])
        return low, np.array([self.lines[d][element[d] + 1] for d in range(3)]) - low

    def interpolation(self, axis, x):
        """Values and derivatives of the lattice's polynomials along an axis at points: [point, lattice plane]."""
        lines, p = self.lines[axis], self.p
        cell = np.clip(np.searchsorted(lines, x, side="right") - 1, 0, len(lines) - 2)
        h = lines[cell + 1] - lines[cell]
        value, derivative = lagrange(self.nodes_1d, 2 * (x - lines[cell]) / h - 1)
        values, derivatives = np.zeros((2, len(x), self.counts[axis]))
        rows = np.arange(len(x))[:, None]
        values[rows, cell[:, None] * p + np.arange(p + 1)] = np.where(np.abs(value) < 1e-13, 0, value)
        derivatives[rows, cell[:, None] * p + np.arange(p + 1)] = derivative * 2 / h[:, None]
        return values, derivatives

    def sample(self, u, xs, gradient=False):
        """The displacement [x, y, z, i] on a tensor grid of points of reference, or its gradient [x, y, z, i, reference axis]."""
        full = np.zeros((np.prod(self.counts), 3))
        full[self.used] = u
        full = full.reshape(*self.counts, 3)
        pairs = [self.interpolation(d, np.asarray(x, float)) for d, x in enumerate(xs)]

        def product(which):
            return np.einsum("ai,bj,ck,ijkn->abcn", *(pairs[d][which == d] for d in range(3)), full, optimize=True)

        return np.stack([product(d) for d in range(3)], -1) if gradient else product(3)

    def on_face(self, where):
        """The axis, the side and the rectangle [low, high] of reference of a face or a patch."""
        size = self.body["size"]
        if "face" in where:
            axis, side = AXES.index(where["face"][0]), int(where["face"][1] == "+")
            return axis, side, np.zeros(3), np.array(size, float)
        low, high = np.zeros(3), np.array(size, float)
        for d, a, b in patch_rectangle(self.body, where["near"], where["radius"]):
            low[d], high[d] = a, b
        return 2, 1, low, high

    def nodes_on(self, where):
        axis, side, low, high = self.on_face(where)
        plane = high[axis] if side else 0.0
        tolerance = 1e-9 * max(self.body["size"])
        low[axis] = high[axis] = plane
        return np.flatnonzero(np.all((self.points > low - tolerance) & (self.points < high + tolerance), -1))

    def surface(self, where, n):
        """Index of each element with a face there, its shape values [q, node], places [q, i] and areas [q] of Gauss points."""
        axis, side, low, high = self.on_face(where)
        plane = high[axis] if side else 0.0
        g, w = legendre.leggauss(n)
        others = [d for d in range(3) if d != axis]
        gauss = [g, g, g]
        gauss[axis] = np.array([2.0 * side - 1])
        values = self.shapes(gauss)[0]
        weights = np.outer(w, w).ravel()
        xi = np.stack(np.meshgrid(*reversed(gauss), indexing="ij"), -1).reshape(-1, 3)[:, ::-1]
        for e, element in enumerate(self.elements):
            start, h = self.geometry(element)
            if abs(start[axis] + side * h[axis] - plane) > 1e-9:
                continue
            centre = start + h / 2
            if any(not low[d] < centre[d] < high[d] for d in others):
                continue
            x, gradient = self.map(start + h * (xi + 1) / 2)
            area = np.linalg.norm(np.cross(gradient[..., others[0]], gradient[..., others[1]]), axis=-1)
            yield e, values, x, area * weights * h[others[0]] * h[others[1]] / 4


def turned_by(points, angle, axis, centre):
    """Displacements of points that go round an axis by an angle in degrees."""
    a, n = np.radians(angle), np.eye(3)[AXES.index(axis)]
    r = points - np.array(centre, float)
    return np.sin(a) * np.cross(n, r) + (1 - np.cos(a)) * np.cross(n, np.cross(n, r))


class Body:
    """One problem on one grid."""

    def __init__(self, problem, p, layers):
        self.problem, self.grid = problem, Grid(problem, p, layers)
        grid, law = self.grid, LAWS[problem["formulation"]]
        self.laws = [law(problem["material"])] + [law(material) for _, material in problem["inclusions"]]
        self.law_of = np.zeros(len(grid.elements), int)
        centres = np.stack([((grid.lines[d][1:] + grid.lines[d][:-1]) / 2)[grid.elements[:, d]] for d in range(3)], -1)
        for n, ((low, high), _) in enumerate(problem["inclusions"], 1):
            self.law_of[np.all((centres > low) & (centres < high), -1)] = n
        g, w = legendre.leggauss(p + 1 if self.laws[0].linear else p + 2)
        self.values, self.slopes = grid.shapes([g, g, g])
        self.weights = np.einsum("c,b,a->cba", w, w, w).ravel() / 8
        self.xi = np.stack(np.meshgrid(g, g, g, indexing="ij"), -1).reshape(-1, 3)[:, ::-1]
        self.rest = grid.map(grid.points)[0]
        self.held = np.zeros((len(grid.points), 3), bool)
        for face in problem["fixed"]:
            self.held[grid.nodes_on({"face": face})] = True
        for face, components in problem["held"]:
            for c in components:
                self.held[grid.nodes_on({"face": face}), AXES.index(c)] = True
        for face in problem["symmetry"]:
            self.held[grid.nodes_on({"face": face}), AXES.index(face[0])] = True
        for entry in problem["move"]:
            for c in entry.get("components", AXES):
                self.held[grid.nodes_on(entry), AXES.index(c)] = True
        self.free = np.where(self.held.ravel(), -1, np.cumsum(~self.held.ravel()) - 1)
        inner = np.repeat(grid.is_inner, 3)
        self.inner, self.outer = np.flatnonzero(inner), np.flatnonzero(~inner)
        dofs = (3 * grid.conn[:, :, None] + np.arange(3)).reshape(len(grid.elements), -1)
        self.dofs = dofs
        # Unknowns of the skeleton, what is inside of elements left out.
        on_skeleton = np.zeros(self.held.size, bool)
        on_skeleton[dofs[:, self.outer]] = True
        self.skeleton = np.where(on_skeleton & (self.free >= 0), np.cumsum(on_skeleton & (self.free >= 0)) - 1, -1)
        self.n_skeleton = int(self.skeleton.max()) + 1
        self.unknowns = int((self.free >= 0).sum())
        self.load = self.applied()

    def element(self, e):
        """Gradients of shape functions [q, J, node] and volumes [q]."""
        start, h = self.grid.geometry(self.grid.elements[e])
        if self.grid.body["kind"] != "block":
            return self.slopes * (2 / h)[None, :, None], self.weights * h.prod()
        gradient = self.grid.map(start + h * (self.xi + 1) / 2)[1] * (h / 2)
        return np.swapaxes(np.linalg.inv(gradient), -1, -2) @ self.slopes, self.weights * 8 * np.linalg.det(gradient)

    def applied(self):
        force = np.zeros((len(self.grid.points), 3))
        for load in self.problem["load"]:
            faces = list(self.grid.surface(load, self.grid.p + 2))
            if load["kind"] == "torque":
                n, centre = np.eye(3)[AXES.index(load["axis"])], np.array(load["centre"], float)
                arms = [np.cross(n, x - centre) for _, _, x, _ in faces]
                polar = sum((area * (arm**2).sum(-1)).sum() for (*_, area), arm in zip(faces, arms))
                tractions = [load["value"] / polar * arm for arm in arms]
            else:
                tractions = [np.broadcast_to(np.array(load["value"], float), x.shape) for _, _, x, _ in faces]
            for (e, values, _, area), t in zip(faces, tractions):
                force[self.grid.conn[e]] += values.T @ (area[:, None] * t)
        return force

    def prescribed(self, factor):
        u = np.zeros((len(self.grid.points), 3))
        for entry in self.problem["move"]:
            nodes = self.grid.nodes_on(entry)
            if "angle" in entry:
                u[nodes] = turned_by(self.rest[nodes], factor * entry["angle"], entry["axis"], entry["centre"])
            else:
                for c in entry["components"]:
                    u[nodes, AXES.index(c)] = factor * entry["displacement"][AXES.index(c)]
        return u

    def internal(self, u):
        force = np.zeros((len(self.grid.points), 3))
        for e, nodes in enumerate(self.grid.conn):
            d, volume = self.element(e)
            stress = self.laws[self.law_of[e]].stress(np.swapaxes(d @ u[nodes], -1, -2))
            force[nodes] += np.einsum("qja,qij->ai", d, stress * volume[:, None, None], optimize=True)
        return force

    def tangent(self, law, h):
        """dP_iJ/dH_kL [q, i, J, k, L], its symmetric part."""
        if law.linear:
            a = np.array([[law.stress(np.outer(np.eye(3)[k], np.eye(3)[m])) for m in range(3)] for k in range(3)])
            return np.moveaxis(a, (0, 1), (2, 3))[None] * np.ones((len(h), 1, 1, 1, 1))
        step, a, here = 1e-6, np.empty((len(h), 3, 3, 3, 3)), law.stress(h)
        for k in range(3):
            for m in range(3):
                change = np.zeros((3, 3))
                change[k, m] = step
                a[..., k, m] = (law.stress(h + change) - here) / step
        return (a + np.transpose(a, (0, 3, 4, 1, 2))) / 2

    def newton_step(self, u, residual, change):
        """The next change of u for a residual, with prescribed changes where it is held."""
        grid, n = self.grid, 3 * self.grid.conn.shape[1]
        right, rows, columns, entries, kept = np.zeros(self.n_skeleton), [], [], [], []
        for e, nodes in enumerate(grid.conn):
            d, volume = self.element(e)
            law = self.laws[self.law_of[e]]
            a = self.tangent(law, np.swapaxes(d @ u[nodes], -1, -2)) * volume[:, None, None, None, None]
            flat, k = d.reshape(-1, len(nodes)), np.empty((len(nodes), 3, len(nodes), 3))
            for i in range(3):
                for m in range(i, 3):
                    k[:, i, :, m] = flat.T @ (a[:, i, :, m, :] @ d).reshape(-1, len(nodes))
                    k[:, m, :, i] = k[:, i, :, m].T
            k = k.reshape(n, n)
            inner, outer, dofs = self.inner, self.outer, self.dofs[e]
            eliminated = np.linalg.solve(k[np.ix_(inner, inner)], np.column_stack([k[np.ix_(inner, outer)], residual[dofs[inner]]]))
            kept.append(eliminated)
            reduced = k[np.ix_(outer, outer)] - k[np.ix_(outer, inner)] @ eliminated[:, :-1]
            b = -k[np.ix_(outer, inner)] @ eliminated[:, -1] - reduced @ change[dofs[outer]]
            places = self.skeleton[dofs[outer]]
            np.add.at(right, places[places >= 0], b[places >= 0])
            r, c = np.broadcast_to(places[:, None], reduced.shape), np.broadcast_to(places, reduced.shape)
            wanted = (r >= 0) & (c >= r)
            rows.append(r[wanted].astype(np.int32))
            columns.append(c[wanted].astype(np.int32))
            entries.append(reduced[wanted])
        on = self.skeleton >= 0
        right += residual[on]
        matrix = coo_matrix((np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), shape=(self.n_skeleton,) * 2).tocsc()
        matrix.sort_indices()
        del rows, columns, entries
        result = change.copy()
        for shift in (0, 1e-4, 1e-3, 1e-2, 0.1, 1):  # a tangent on the way to equilibrium may be indefinite
            if shift:
                matrix = matrix + diags(shift * np.abs(matrix.diagonal()), format="csc")
                matrix.sort_indices()
            self.solver.factorise(matrix)
            try:
                result[on] = self.solver.solve(right)
                break
            except ArithmeticError:
                if shift == 1:
                    raise
        for e, eliminated in enumerate(kept):
            dofs = self.dofs[e]
            result[dofs[self.inner]] = eliminated[:, -1] - eliminated[:, :-1] @ result[dofs[self.outer]]
        return result

    def solve(self, start=None):
        """@param start  a displacement near the answer, to begin at full load"""
        steps = 1 if start is not None or self.laws[0].linear else self.problem["steps"]
        u = np.zeros((len(self.grid.points), 3)) if start is None else start
        free, self.iterations, self.solver = ~self.held.ravel(), 0, Cholesky()
        for step in range(1, steps + 1):
            factor = step / steps
            change, last = np.where(self.held, self.prescribed(factor) - u, 0).ravel(), np.inf
            for iteration in range(40):
                internal = self.internal(u)
                residual = (factor * self.load - internal).ravel()
                scale = max(np.abs(internal).max(), np.abs(self.load).max())
                off = np.abs(residual[free]).max() / scale if scale > 0 else 0.0
                if not np.isfinite(off):
                    raise ArithmeticError("Newton's method left the domain of the law")
                if iteration and not np.any(change):
                    # A linear body's residual is rounding by now.
                    if self.laws[0].linear or off < (1e-9 if step == steps else 1e-4) or last < 1e-10 * np.abs(u).max():
                        break
                correction = self.newton_step(u, residual, change).reshape(-1, 3)
                u, change, last = u + correction, 0 * change, np.abs(correction).max()
                self.iterations += 1
            else:
                raise ArithmeticError("Newton's method does not converge")
        self.solver.free()
        self.u, self.internal_force = u, internal
        return self

    def integrate(self, of):
        """Integral over the body at rest of a function of law, displacement [q, i], its gradient [q, i, J]."""
        total = 0.0
        for e, nodes in enumerate(self.grid.conn):
            d, volume = self.element(e)
            total += volume @ of(self.laws[self.law_of[e]], self.values @ self.u[nodes], np.swapaxes(d @ self.u[nodes], -1, -2))
        return total

    def at(self, point):
        return self.grid.sample(self.u, [[x] for x in point])[0, 0, 0]

    def cell_stress(self, point, component):
        """Mean of the Cauchy stress of a linear body over the cell of the case's own mesh that holds a point of a box."""
        size, cells = self.grid.body["size"], self.grid.body["cells"]
        places, weights = [], []
        for d in range(3):
            h = size[d] / cells[d]
            low = np.floor(point[d] / h + 1e-9) * h
            ends = np.array([low, *(x for x in self.grid.lines[d] if low + 1e-9 < x < low + h - 1e-9), low + h])
            g, w = legendre.leggauss(self.grid.p + 1)
            places.append(((ends[:-1, None] + ends[1:, None]) / 2 + (ends[1:, None] - ends[:-1, None]) / 2 * g).ravel())
            weights.append(((ends[1:, None] - ends[:-1, None]) / 2 * w).ravel())
        law = self.laws[0]
        for n, ((low, high), _) in enumerate(self.problem["inclusions"], 1):
            if all(low[d] < point[d] < high[d] for d in range(3)):
                law = self.laws[n]
        stress = law.stress(self.grid.sample(self.u, places, gradient=True))[..., AXES.index(component[0]), AXES.index(component[1])]
        return np.einsum("abc,a,b,c", stress, *weights) / np.prod([w.sum() for w in weights])

    def measure(self, m):
        kind = m["kind"]
        if kind == "displacement":
            return self.at(m["point"])[AXES.index(m["component"])]
        if kind == "strain_energy":
            return self.integrate(lambda law, u, h: law.energy(h))
        if kind == "volume":
            return self.integrate(lambda law, u, h: np.linalg.det(h + np.eye(3)))
        if kind == "displacement_field_l2":
            return np.sqrt(self.integrate(lambda law, u, h: (u**2).sum(-1)) / self.integrate(lambda law, u, h: np.ones(len(u))))
        if kind == "reaction":
            return (self.internal_force - self.load)[self.grid.nodes_on(m)].sum(0)[AXES.index(m["component"])]
        if kind == "stress":
            return self.cell_stress(m["point"], m["component"])
        if kind == "tilt":
            after = self.grid.map(np.array(m["top"], float))[0] - self.grid.map(np.array(m["bottom"], float))[0]
            after = after + self.at(m["top"]) - self.at(m["bottom"])
            return np.degrees(np.arctan2(after[AXES.index(m["toward"])], after[AXES.index(m["up"])]))
        if kind == "twist":
            axis = AXES.index(m["axis"])
            s, t = (axis + 1) % 3, (axis + 2) % 3
            before = self.grid.map(np.array(m["point"], float))[0] - self.grid.map(np.array(m["centre"], float))[0]
            after = before + self.at(m["point"]) - self.at(m["centre"])
            return np.degrees(np.arctan2(before[s] * after[t] - before[t] * after[s], before[s] * after[s] + before[t] * after[t]))
        raise ValueError(kind)
