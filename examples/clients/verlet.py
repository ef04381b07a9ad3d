#!/usr/bin/env python3
"""A client of springproof: the scene's springs, moved by Verlet's method with many small steps.

    springproof judge CASE.toml --client 'verlet=python3 examples/clients/verlet.py'
"""
import json
import sys
import time

import numpy as np

header = json.loads(sys.stdin.buffer.readline())
arrays = {}
for entry in header["arrays"]:
    raw = sys.stdin.buffer.read(8 * entry["shape"][0] * entry["shape"][1])
    arrays[entry["name"]] = np.frombuffer(raw, "<f8").reshape(entry["shape"])


def say(line, values=b""):
    sys.stdout.buffer.write(json.dumps(line).encode() + b"\n" + bytes(values))
    sys.stdout.buffer.flush()


rest, mass, springs = arrays["nodes"], arrays["mass"], arrays["springs"]
a, b = springs[:, 0].astype(int), springs[:, 1].astype(int)
stiffness, length = springs[:, 2:3], springs[:, 3:4]
terms = ("midlines", "volume_hexahedra", "volume_patches", "biquadratic_tetrahedra")
if header["question"] != "rest" or len(arrays["support_motion"]) or not mass.all() or springs[:, 4].any():
    say({"error": "takes bodies with masses and Hooke's springs at rest on supports that do not move"})
    sys.exit()
say({"protocol": 1, "name": "Verlet", "version": "1", "method": "Verlet", "settings": {"damping": 20},
     "unsupported": [name for name in terms if len(arrays[name])]})

force_of_loads = sum((mass * g["acceleration"] for g in header["gravity"]), np.zeros_like(rest))
for load in header["loads"]:
    rows = arrays[load["forces"]]
    np.add.at(force_of_loads, rows[:, 0].astype(int), rows[:, 1:])
is_free = np.ones_like(rest)
is_free[tuple(arrays["supports"].astype(int).T)] = 0
# A node's springs bound the fastest vibration: omega^2 <= 2 sum k / m.
total = np.bincount(np.r_[a, b], np.r_[stiffness, stiffness][:, 0], len(rest))
step = 1 / np.sqrt((2 * total / mass[:, 0]).max())
x, v, begin = rest.copy(), np.zeros_like(rest), time.perf_counter()
n_steps, at_rest = 0, False
most = 0.8 * header["seconds"]
while n_steps * step < header["end"] and not at_rest and time.perf_counter() - begin < most:
    d = x[b] - x[a]
    size = np.linalg.norm(d, axis=1, keepdims=True)
    pull = stiffness * (1 - length / size) * d
    force = force_of_loads.copy()
    for c in range(3):
        force[:, c] += np.bincount(a, pull[:, c], len(rest)) - np.bincount(b, pull[:, c], len(rest))
    v = ((1 - 10 * step) * v + step * force / mass) / (1 + 10 * step) * is_free
    x = x + step * v
    n_steps += 1
    at_rest = np.linalg.norm(force * is_free) <= 1e-6 * np.linalg.norm(force_of_loads)
say({"frame": 0, "time": n_steps * step, "seconds": time.perf_counter() - begin, "steps": n_steps,
     "at_rest": bool(at_rest), "has": "positions", "nodes": len(rest)}, x.astype("<f8").tobytes())
say({"end": True})
