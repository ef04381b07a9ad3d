#!/usr/bin/env python3
"""Reference client of springproof's protocol: springs, midlines, volume terms and biquadratic tetrahedra,
solved to their equilibrium by Newton's method, or moved by implicit Euler. docs/reference/client-protocol.md
explains every key that is read here. Needs numpy alone; matrices are dense: bodies of some hundred nodes."""
import json
import sys
import time

import numpy as np

EDGES = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
# The six faces of a hexahedron whose vertex is i + 2j + 4k, anticlockwise from outside.
FACES = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]

TETRAHEDRON_FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


def read_scene(stream):
    """A line of JSON, and the arrays that it lists: little-endian doubles, row after row."""
    header = json.loads(stream.readline())
    arrays = {}
    for entry in header["arrays"]:
        rows, columns = entry["shape"]
        raw = stream.read(8 * rows * columns)
        arrays[entry["name"]] = np.frombuffer(raw, "<f8").reshape(rows, columns)
    return header, arrays


def say(line, values=None):
    sys.stdout.buffer.write((json.dumps(line) + "\n").encode())
    if values is not None:
        sys.stdout.buffer.write(np.ascontiguousarray(values, "<f8").tobytes())
    sys.stdout.buffer.flush()


def factor(history, t):
    """A load's factor: a sine, or linear between points, at a jump what comes after it; without either 1."""
    if history["frequency"] != 0:
        return np.sin(2 * np.pi * history["frequency"] * t)
    points = history["points"]
    if not points:
        return 1.0
    before = [p for p in points if p[0] <= t]
    after = [p for p in points if p[0] > t]
    if not before:
        return points[0][1]
    if not after:
        return points[-1][1]
    (t0, f0), (t1, f1) = before[-1], after[0]
    return f0 + (f1 - f0) * (t - t0) / (t1 - t0)


def cross_matrix(v):
    zero = np.zeros(len(v))
    rows = [zero, -v[:, 2], v[:, 1], v[:, 2], zero, -v[:, 0], -v[:, 1], v[:, 0], zero]
    return np.stack(rows, 1).reshape(-1, 3, 3)


class Body:
    """Forces and their tangent. Every term has rows of nodes; blocks are summed by np.add.at."""

    def __init__(self, arrays):
        self.n = len(arrays["nodes"])
        springs, mid = arrays["springs"], arrays["midlines"]
        # A spring's vector is a weighted sum of nodes: two of them, or the eight of a midline.
        self.groups = []
        if len(springs):
            weights = np.tile([-1.0, 1.0], (len(springs), 1))
            self.groups.append((springs[:, :2].astype(int), weights, springs[:, 2:]))
        if len(mid):
            upper = np.arange(8)[None, :] >> mid[:, 8].astype(int)[:, None] & 1
            self.groups.append((mid[:, :8].astype(int), np.where(upper, 0.25, -0.25), mid[:, 9:]))
        self.volumes = []
        hexahedra = arrays["volume_hexahedra"]
        # A volume is a sum over triangles; that under a bilinear face is the mean of its two triangulations.
        halves = [t for a, b, c, d in FACES for t in ((a, b, c), (a, c, d), (a, b, d), (b, c, d))]
        if len(hexahedra):
            self.volumes.append((hexahedra[:, :8].astype(int), halves, 0.5, hexahedra[:, 8:]))
        # A patch's volume is a quarter of its tetrahedra's.
        patches = arrays["volume_patch_tetrahedra"].astype(int)
        self.patches = (patches[:, 0], patches[:, 1:], arrays["volume_patches"])
        tets = arrays["biquadratic_tetrahedra"]
        self.tets = (tets[:, :4].astype(int), tets[:, 4:40].reshape(-1, 6, 6), tets[:, 40:])

    def evaluate(self, x, clamp=False):
        """Internal force, minus the gradient of the energy, and the tangent, its second derivative. Clamped:
        without the parts that may be negative."""
        force, tangent = np.zeros((self.n, 3)), np.zeros((self.n, self.n, 3, 3))
        for nodes, weights, (k, rest, law, parameter) in ((n, w, p.T) for n, w, p in self.groups):
            d = np.einsum("sa,sai->si", weights, x[nodes])
            length = np.linalg.norm(d, axis=1)
            q = length / rest
            power = law == 1  # tension k l0 q^p ln q; Hooke's k (l - l0)
            tension = np.where(power, k * rest * q**parameter * np.log(q), k * (length - rest))
            slope = np.where(power, k * q ** (parameter - 1) * (parameter * np.log(q) + 1), k)
            across = tension / length
            if clamp:
                slope, across = np.maximum(slope, 0), np.maximum(across, 0)
            n = d / length[:, None]
            nn = n[:, :, None] * n[:, None, :]
            block = slope[:, None, None] * nn + across[:, None, None] * (np.eye(3) - nn)
            pull = (tension / length)[:, None] * d
            for a in range(weights.shape[1]):
                np.add.at(force, nodes[:, a], -weights[:, a, None] * pull)
                for b in range(weights.shape[1]):
                    both = (weights[:, a] * weights[:, b])[:, None, None]
                    np.add.at(tangent, (nodes[:, a], nodes[:, b]), both * block)
        for nodes, triangles, part, (k, rest, logarithmic) in ((n, t, w, p.T) for n, t, w, p in self.volumes):
            self.add_volumes(x, nodes, triangles, part, k, rest, logarithmic, force, tangent, clamp)
        self.add_patches(x, force, tangent, clamp)
        self.add_tetrahedra(x, force, tangent, clamp)
        return force, tangent

    @staticmethod
    def add_volumes(x, nodes, triangles, part, k, rest, logarithmic, force, tangent, clamp):
        at, n_vertices = x[nodes], nodes.shape[1]
        volume = np.zeros(len(nodes))
        gradient = np.zeros((len(nodes), n_vertices, 3))
        second = np.zeros((len(nodes), n_vertices, n_vertices, 3, 3))
        for a, b, c in triangles:  # a . (b x c) / 6
            volume += part / 6 * np.einsum("si,si->s", at[:, a], np.cross(at[:, b], at[:, c]))
            for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
                gradient[:, p] += part / 6 * np.cross(at[:, q], at[:, r])
                second[:, p, q] -= part / 6 * cross_matrix(at[:, r])
                second[:, p, r] += part / 6 * cross_matrix(at[:, q])
        ratio = volume / rest
        pressure = k * np.where(logarithmic == 1, np.log(ratio), ratio - 1)
        slope = k / rest * np.where(logarithmic == 1, 1 / ratio, 1)
        for a in range(n_vertices):
            np.add.at(force, nodes[:, a], -pressure[:, None] * gradient[:, a])
            for b in range(n_vertices):
                block = slope[:, None, None] * gradient[:, a, :, None] * gradient[:, b, None, :]
                if not clamp:
                    block = block + pressure[:, None, None] * second[:, a, b]
                np.add.at(tangent, (nodes[:, a], nodes[:, b]), block)

    def add_patches(self, x, force, tangent, clamp):
        """Pressures of the volumes around nodes, each of which pulls at all nodes of its tetrahedra."""
        of, nodes, laws = self.patches
        if not len(laws):
            return
        k, rest, logarithmic = laws.T
        at = x[nodes]
        volume, gradient = np.zeros(len(laws)), np.zeros((len(laws), self.n, 3))
        second = np.zeros((len(nodes), 4, 4, 3, 3))
        for a, b, c in TETRAHEDRON_FACES:  # a . (b x c) / 6 of each face, a quarter of it
            np.add.at(volume, of, np.einsum("si,si->s", at[:, a], np.cross(at[:, b], at[:, c])) / 24)
            for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
                np.add.at(gradient, (of, nodes[:, p]), np.cross(at[:, q], at[:, r]) / 24)
                second[:, p, q] -= cross_matrix(at[:, r]) / 24
                second[:, p, r] += cross_matrix(at[:, q]) / 24
        ratio = volume / rest
        pressure = k * np.where(logarithmic == 1, np.log(ratio), ratio - 1)
        slope = k / rest * np.where(logarithmic == 1, 1 / ratio, 1)
        force -= np.einsum("p,pni->ni", pressure, gradient)
        tangent += np.einsum("p,pni,pmj->nmij", slope, gradient, gradient, optimize=True)
        if not clamp:
            for a in range(4):
                for b in range(4):
                    np.add.at(tangent, (nodes[:, a], nodes[:, b]), pressure[of, None, None] * second[:, a, b])

    def add_tetrahedra(self, x, force, tangent, clamp):
        """W = 1/2 sum_ef K_ef D_e D_f, D_e = l_e^2 - L_e^2."""
        nodes, stiffness, rest = self.tets
        if not len(nodes):
            return
        d = np.stack([x[nodes[:, b]] - x[nodes[:, a]] for a, b in EDGES], 1)
        change = np.einsum("sei,sei->se", d, d) - rest**2
        stress = np.einsum("sef,sf->se", stiffness, change)
        for e, (a, b) in enumerate(EDGES):
            pull = 2 * stress[:, e, None] * d[:, e]
            np.add.at(force, nodes[:, a], pull)
            np.add.at(force, nodes[:, b], -pull)
            for f, (g, h) in enumerate(EDGES):
                block = 4 * stiffness[:, e, f, None, None] * d[:, e, :, None] * d[:, f, None, :]
                if e == f:
                    s = np.maximum(stress[:, e], 0) if clamp else stress[:, e]
                    block = block + 2 * s[:, None, None] * np.eye(3)
                for p, sign in ((a, -1), (b, 1)):
                    for r, other in ((g, -1), (h, 1)):
                        np.add.at(tangent, (nodes[:, p], nodes[:, r]), sign * other * block)


class Scene:
    def __init__(self, header, arrays):
        self.header, self.arrays, self.body = header, arrays, Body(arrays)
        self.rest = arrays["nodes"]
        self.mass = arrays["mass"][:, 0]
        self.is_free = np.ones(self.rest.size, bool)
        self.held = (3 * arrays["supports"][:, 0] + arrays["supports"][:, 1]).astype(int)
        self.is_free[self.held] = False

    def load(self, t, at_full_load=False):
        force = np.zeros_like(self.rest)
        scale = lambda history: 1.0 if at_full_load else factor(history, t)
        for load in self.header["loads"]:
            rows = self.arrays[load["forces"]]
            np.add.at(force, rows[:, 0].astype(int), scale(load["history"]) * rows[:, 1:])
        for gravity in self.header["gravity"]:
            force += self.mass[:, None] * np.array(gravity["acceleration"]) * scale(gravity["history"])
        return force

    def supports(self, frame):
        motion = self.arrays["support_motion"]
        return motion[frame] if len(motion) else np.zeros(len(self.held))

    def solve(self, u, residual_and_tangent, scale):
        """Newton's method on the free degrees of freedom, with the clamped tangent where the whole one leads
        nowhere."""
        free = self.is_free
        for iteration in range(100):
            residual, tangent = residual_and_tangent(u, False)
            size = np.linalg.norm(residual[free])
            if size <= 1e-13 * max(scale, np.linalg.norm(residual)) or (iteration > 3 and size >= last):
                return u
            last = size if size < 1e-9 * max(scale, np.linalg.norm(residual)) else np.inf
            for clamp in (False, True):
                if clamp:
                    tangent = residual_and_tangent(u, True)[1]
                step = np.zeros(u.size)
                step[free] = np.linalg.solve(tangent[np.ix_(free, free)], residual[free])
                part = 1.0
                while part > 1e-4:
                    new = np.linalg.norm(residual_and_tangent(u + part * step, None)[0][free])
                    if np.isfinite(new) and (new < size or part == 1 and new < 1e-9 * scale):
                        break
                    part /= 2
                if part > 1e-4:
                    break
            if part <= 1e-4:
                return u
            u = u + part * step
        return u


def flat(tangent):
    n = len(tangent)
    return tangent.transpose(0, 2, 1, 3).reshape(3 * n, 3 * n)


def come_to_rest(scene):
    """Equilibrium: what implicit Euler with ever longer steps comes to. Supports go a tenth at a time."""
    u, n_parts = np.zeros(scene.rest.size), 10 if len(scene.arrays["support_motion"]) else 1
    load = scene.load(0, at_full_load=True).ravel()
    for part in range(1, n_parts + 1):
        before = u[scene.held].copy()
        target = scene.supports(0) * part / n_parts
        u[scene.held] = target
        if part == 1 and n_parts > 1:  # the body follows linearly at first
            tangent = flat(scene.body.evaluate(scene.rest)[1])
            free = scene.is_free
            pull = -tangent[np.ix_(free, scene.held)] @ (target - before)
            u[free] = np.linalg.solve(tangent[np.ix_(free, free)], pull)
        elif part > 1:
            u *= part / (part - 1)
            u[scene.held] = target

        def residual(at, clamp, share=part / n_parts):
            force, tangent = scene.body.evaluate(scene.rest + at.reshape(-1, 3), bool(clamp))
            return force.ravel() + share * load, flat(tangent)

        u = scene.solve(u, residual, np.linalg.norm(load))
    return u


def move(scene):
    """Implicit Euler from rest, a frame for every time asked for."""
    header, times = scene.header, scene.header["times"]
    u, v = np.zeros(scene.rest.size), np.zeros(scene.rest.size)
    mass = np.repeat(scene.mass, 3)
    damping = np.diag(np.repeat(scene.arrays["mass_damping"][:, 0], 3))
    if header["stiffness_damping"]:
        damping = damping + header["stiffness_damping"] * flat(scene.body.evaluate(scene.rest)[1])
    yield times[0], u
    for frame, (t0, t) in enumerate(zip(times, times[1:]), 1):
        h, start = t - t0, u
        load = scene.load(t).ravel()

        def residual(at, clamp):
            force, tangent = scene.body.evaluate(scene.rest + at.reshape(-1, 3), bool(clamp))
            inertia = mass * ((at - start) / h - v) / h
            return (force.ravel() + load - inertia - damping @ (at - start) / h,
                    flat(tangent) + np.diag(mass / h**2) + damping / h)

        guess = u + h * v
        guess[scene.held] = scene.supports(frame)
        u = scene.solve(guess, residual, np.linalg.norm(load) + np.linalg.norm(mass * v) / h)
        v = (u - start) / h
        yield t, u


def main():
    header, arrays = read_scene(sys.stdin.buffer)
    if header["protocol"] != 1:
        sys.exit("protocol %s is not mine" % header["protocol"])
    is_motion = header["question"] == "motion"
    unsupported = ["masses that are not lumped"] if header["masses"] == "consistent" and is_motion else []
    if is_motion and header["scheme"]["name"] != "implicit_euler":
        unsupported.append("scheme " + header["scheme"]["name"])
    say({"protocol": 1, "name": "reference", "version": "1", "settings": {},
         "method": "implicit Euler" if is_motion else "Newton", "unsupported": unsupported})
    scene = Scene(header, arrays)
    begin = time.perf_counter()
    frames = move(scene) if is_motion else [(0.0, come_to_rest(scene))]
    for number, (t, u) in enumerate(frames):
        say({"frame": number, "time": t, "seconds": time.perf_counter() - begin,
             "steps": number if is_motion else 1, "at_rest": True, "has": "displacements",
             "nodes": scene.body.n}, u)
    say({"end": True})


main()
