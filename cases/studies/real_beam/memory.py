"""A memory of the beam from one recording: Young's modulus that is left and a Prony series, fitted to gravity.csv alone.

usage: memory.py

The beam is one mode of vibration, whose frequency and sag are those of the finite elements (tables of README.md). Its material has two
branches. The fast one has tau = 1 ms, because a recording at 100 Hz shows only r tau of it. Fitted are the modulus, both parts and the
slow tau, to what swings.py finds in the first second and to three means while the beam creeps. Printed are the numbers for the cases,
what they predict for the three recordings, and the largest damping ratio that any Prony series could have (README.md). Only Python's
standard library is used.
"""

import math
import pathlib

import swings

STUDY = pathlib.Path(__file__).resolve().parent
AUTHORS_MODULUS = 0.263824  # MPa
FAST = 0.001  # s
STEP = 0.0025  # s
# Finite elements of the authors' modulus without a memory: frequency (Hz) and damping ratio of swings, drop at rest (mm). Those of its own
# weight are of `springproof eigen`, without damping; those under the weights of motions with mass_damping = 4.90.
BEAMS = {"gravity": (7.367, 0, 6.813), "gravity_and_0.510_N": (3.991, 0.0267, 17.46), "gravity_and_1.001_N": (3.075, 0.0202, 28.04)}
SECONDS = ((1, 2), (2, 3), (3.28, 4.2801))  # for the means
# How well each is known: 0.2 % of the frequency, 3 % of the damping ratio, mm of what the first swings lie about and of the means.
SIGMA = (0.002 * 7.728, 0.03 * 0.0505, 0.05, 0.02, 0.02, 0.02)


def recording(name):
    """Times (s) and displacements (mm) from the release on."""
    time, value = swings.read(STUDY / f"{name}.csv")
    after = [i for i, t in enumerate(time) if t >= -1e-9]
    return [time[i] for i in after], [value[i] for i in after]


def undamped(name):
    """Square of the angular frequency that the authors' modulus has without damping, 1/s²."""
    frequency, ratio, _ = BEAMS[name]
    return (2 * math.pi * frequency) ** 2 / (1 - ratio ** 2)


def course(name, modulus, parts, taus, end):
    """Times and displacements each 10 ms, by Newmark's scheme and the program's treatment of branches."""
    stiffness = undamped(name) * modulus / AUTHORS_MODULUS
    rest = -BEAMS[name][2] * AUTHORS_MODULUS / modulus
    kept = [math.exp(-STEP / tau) for tau in taus]
    taken = [r * (1 - e) * tau / STEP for r, e, tau in zip(parts, kept, taus)]
    factor, faded = 1 + sum(taken), [0.0] * len(taus)
    u, v, a = 0.0, 0.0, stiffness * rest
    seen = ([0.0], [0.0])
    every = round(0.01 / STEP)
    for n in range(1, round(end / STEP) + 1):
        before = u + STEP * v + STEP ** 2 / 4 * a
        memory = sum(e * q for e, q in zip(kept, faded)) - sum(taken) * u
        a1 = stiffness * (rest - factor * before - memory) / (1 + stiffness * factor * STEP ** 2 / 4)
        u1 = before + STEP ** 2 / 4 * a1
        v += STEP / 2 * (a + a1)
        faded = [e * q + t * (u1 - u) for e, q, t in zip(kept, faded, taken)]
        u, a = u1, a1
        if n % every == 0:
            seen[0].append(n * STEP)
            seen[1].append(u)
    return seen


def first_second(time, value):
    """Frequency (Hz), damping ratio and what the first swings lie about (mm)."""
    first = [i for i, t in enumerate(time) if t <= swings.SECONDS + 1e-4]
    frequency, ratio, _, centre = swings.swings([time[i] for i in first], [value[i] for i in first])
    return [frequency, ratio, centre]


def features(time, value):
    means = []
    for begin, end in SECONDS:
        within = [v for t, v in zip(time, value) if begin <= t < end]
        means.append(sum(within) / len(within))
    return first_second(time, value) + means


def material(p):
    """Modulus (MPa), parts of the branches over what is left, their times (s)."""
    return AUTHORS_MODULUS * math.exp(p[0]), [math.exp(p[1]), math.exp(p[2])], [FAST, math.exp(p[3])]


def solve(matrix, right):
    """Gauss's elimination with pivots."""
    n = len(right)
    rows = [list(row) + [b] for row, b in zip(matrix, right)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda k: abs(rows[k][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for k in range(i + 1, n):
            ratio = rows[k][i] / rows[i][i]
            rows[k] = [a - ratio * b for a, b in zip(rows[k], rows[i])]
    x = [0.0] * n
    for i in reversed(range(n)):
        x[i] = (rows[i][n] - sum(rows[i][j] * x[j] for j in range(i + 1, n))) / rows[i][i]
    return x


def fit(target):
    """Levenberg and Marquardt's least squares."""
    def residuals(p):
        found = features(*course("gravity", *material(p), end=4.28))
        return [(a - b) / sigma for a, b, sigma in zip(found, target, SIGMA)]

    p, damping = [0.0, math.log(2.0), math.log(0.08), 0.0], 0.01
    here = residuals(p)
    for _ in range(40):
        columns = []
        for j in range(len(p)):
            moved = residuals([x + (1e-5 if i == j else 0) for i, x in enumerate(p)])
            columns.append([(a - b) / 1e-5 for a, b in zip(moved, here)])
        normal = [[sum(a * b for a, b in zip(c, d)) for d in columns] for c in columns]
        gradient = [sum(a * b for a, b in zip(c, here)) for c in columns]
        for i in range(len(p)):
            normal[i][i] *= 1 + damping
        trial = [x - step for x, step in zip(p, solve(normal, gradient))]
        there = residuals(trial)
        gained = sum(x * x for x in here) - sum(x * x for x in there)
        damping = damping / 5 if gained > 0 else damping * 5
        if gained > 0:
            p, here = trial, there
            if gained < 1e-9:
                break
    return material(p)


def largest_ratio(name, modulus, measured):
    """Bound of the damping ratio of a beam, from the frequency and damping ratio of its own weight and the modulus that is left.

    At c times the frequency, c < 1, the loss of each branch is at most c loss + (1 - c²)/2 storage of it at the frequency, because
    2 c x <= 1 + c² x². The storage is at least the modulus that is left.
    """
    frequency, ratio = measured["gravity"][:2]
    storage = ((2 * math.pi * frequency) ** 2 / undamped("gravity")) * AUTHORS_MODULUS / modulus
    c = measured[name][0] / frequency
    return (c * 2 * ratio * storage + (1 - c * c) / 2 * (storage - 1)) / 2


def main():
    measured = {name: first_second(*recording(name)) for name in BEAMS}
    modulus, parts, taus = fit(features(*recording("gravity")))
    branches = ", ".join(f"{{ g = {r / (1 + sum(parts)):.3g}, tau = {tau:.3g} }}" for r, tau in zip(parts, taus))
    print(f"youngs_modulus = {modulus:.4g}\nprony = [{branches}]")
    for name, (frequency, ratio, _) in measured.items():
        f, z, centre = first_second(*course(name, modulus, parts, taus, end=swings.SECONDS))
        line = f"{name}: {f:.3f} Hz ({100 * (f / frequency - 1):+.1f} %), damping ratio {z:.4f} ({100 * (z / ratio - 1):+.0f} %)"
        print(line + f", about {centre:.2f} mm" + ("" if name == "gravity" else f"; no series above {largest_ratio(name, modulus, measured):.4f}"))


if __name__ == "__main__":
    main()
