"""A Prony series for the beam's shear modulus, fitted to one recording: two terms a hundredfold apart in time.

usage: prony.py FILE HERTZ [FAST SLOW]

FILE is the recording, HERTZ the frequency at which the elastic model of the beam swings, FAST and SLOW the times of the terms (0.01 and
1 s by default). The beam is one mass on the material: x'' = omega² (1 - x - sum q), stepped as the program steps it. The parts g are
those whose frequency, damping ratio and centre of the first swings over the rest are nearest to the recording's, each difference over
what it may be: 4 %, 10 % and 4 %. swings.py finds these numbers in both. The search halves its steps around the best of a grid. Only
Python's standard library is used.
"""

import itertools
import math
import sys

import swings

STEP = 0.0025  # s, the cases'
ALLOWED = (0.04, 0.1, 0.04)


def course(hertz, terms):
    """Times and places of the mass after its release, over where it rests, by newmark (1/4, 1/2)."""
    omega_squared, h, left = (2 * math.pi * hertz) ** 2, STEP, 1 - sum(g for g, _ in terms)
    kept = [math.exp(-h / tau) for _, tau in terms]
    taken = [g / left * -math.expm1(-h / tau) * tau / h for g, tau in terms]
    factor, q, x, v, a, places = 1 + sum(taken), [0] * len(terms), 0, 0, omega_squared, [0]
    for _ in range(round(swings.SECONDS / h)):
        remembered = sum(k * one for k, one in zip(kept, q)) - (factor - 1) * x
        ahead = x + h * v + h * h / 4 * a
        new = omega_squared * (1 - remembered - factor * ahead) / (1 + omega_squared * factor * h * h / 4)
        moved = ahead + h * h / 4 * new
        q = [k * one + t * (moved - x) for k, one, t in zip(kept, q, taken)]
        x, v, a = moved, v + h / 2 * (a + new), new
        places.append(x)
    return [n * h for n in range(len(places))], places


def numbers(time, value, rest):
    frequency, ratio, _, centre = swings.swings(time, value)
    return frequency, ratio, centre / rest


def main():
    path, hertz = sys.argv[1], float(sys.argv[2])
    taus = [float(tau) for tau in sys.argv[3:]] or [0.01, 1]
    time, value = swings.read(path)
    late = [v for t, v in zip(time, value) if t > time[-1] - 1]
    first = [i for i, t in enumerate(time) if 0 <= t <= swings.SECONDS + 1e-9]
    recorded = numbers([time[i] for i in first], [value[i] for i in first], sum(late) / len(late))

    def of(parts):
        times, places = course(hertz, list(zip(parts, taus)))
        return numbers(*swings.every_10_ms(times, places), 1)

    def distance(parts):
        if min(parts) < 0 or sum(parts) > 0.9:
            return math.inf
        try:
            return sum(((found / wanted - 1) / part) ** 2 for found, wanted, part in zip(of(parts), recorded, ALLOWED))
        except (IndexError, ZeroDivisionError):  # no swings
            return math.inf

    grid = [0.02 + 0.08 * i for i in range(5)]
    best = min(itertools.product(grid, repeat=len(taus)), key=distance)
    step = 0.04
    while step > 2e-4:
        near = [tuple(g + step * way for g, way in zip(best, ways)) for ways in itertools.product((-1, 0, 1), repeat=len(taus))]
        better = min(near, key=distance)
        step, best = (step / 2 if better == best else step), better
    print("prony = [" + ", ".join(f"{{ g = {g:.3f}, tau = {tau:g} }}" for g, tau in zip(best, taus)) + "]")
    for name, found, wanted in zip(("frequency", "damping ratio", "centre over rest"), of(best), recorded):
        print(f"{name} {found:.4g}, recorded {wanted:.4g}")


if __name__ == "__main__":
    main()
