#!/usr/bin/env python3
"""Reference client of springproof's protocol: springs, midlines, volume terms and biquadratic tetrahedra,
solved to their equilibrium by Newton's method, or moved by implicit Euler. docs/reference/client-protocol.md
explains every key that is read here. Needs numpy alone; matrices are dense: bodies of some hundred nodes."""
import json
import sys
import time

import numpy as np

from forces import Body


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


def evaluate(body, x, clamp=False):
    """Internal forces and their whole tangent, minus their derivative."""
    tangent = np.zeros((body.n, body.n, 3, 3))
    for nodes, _, blocks in body.terms(x):
        np.add.at(tangent, (nodes[:, :, None], nodes[:, None, :]), blocks(clamp))
    return body.forces(x), tangent


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
            tangent = flat(evaluate(scene.body, scene.rest)[1])
            free = scene.is_free
            pull = -tangent[np.ix_(free, scene.held)] @ (target - before)
            u[free] = np.linalg.solve(tangent[np.ix_(free, free)], pull)
        elif part > 1:
            u *= part / (part - 1)
            u[scene.held] = target

        def residual(at, clamp, share=part / n_parts):
            force, tangent = evaluate(scene.body, scene.rest + at.reshape(-1, 3), bool(clamp))
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
        damping = damping + header["stiffness_damping"] * flat(evaluate(scene.body, scene.rest)[1])
    yield times[0], u
    for frame, (t0, t) in enumerate(zip(times, times[1:]), 1):
        h, start = t - t0, u
        load = scene.load(t).ravel()

        def residual(at, clamp):
            force, tangent = evaluate(scene.body, scene.rest + at.reshape(-1, 3), bool(clamp))
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
