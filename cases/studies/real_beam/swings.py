"""What the swings of a recording, or of a simulated beam, are: where it settles, its frequency, its damping, what is left of faster motion.

usage: swings.py FILE [MODEL [MEASURE]]

FILE is a recording (the top marker is read) or NAME_motion.csv of `springproof run --out` with the model, fem or msm, and a measure
("top" by default). The first second is read as the program reads a course with over_time = "frequency" and "damping_ratio": half
periods by a straight line through the times of the turning points, the logarithmic decrement by one through the ways between them.
A recording rests at the mean of its last second. Only Python's standard library is used.
"""

import csv
import math
import sys

SECONDS = 1.0  # duration of swings: in all three recordings they are above a tenth of the first one


def read(path, model="fem", measure="top"):
    """Times (s) and the vertical displacement (mm)."""
    with open(path, newline="") as lines:
        rows = list(csv.DictReader(lines))
    if "top_uz_mm" in rows[0]:
        return [float(row["time_s"]) for row in rows], [float(row["top_uz_mm"]) for row in rows]
    rows = [row for row in rows if row["measure"] == measure and row[model]]
    return [float(row["time"]) for row in rows], [float(row[model]) for row in rows]


def vertex(time, value, i):
    """Vertex of the parabola through three values at equal intervals."""
    before, here, after = value[i - 1:i + 2]
    curvature = before - 2 * here + after
    shift = (before - after) / (2 * curvature) if curvature else 0
    return time[i] + shift * (time[i + 1] - time[i]), here - (before - after) * shift / 4


def turning_points(time, value):
    """Maxima and minima in turn; what goes back by less than 5 % of the range is noise."""
    noise = 0.05 * (max(value) - min(value))
    found, direction, low, high = [], 0, 0, 0
    for i, here in enumerate(value):
        low, high = (i if here < value[low] else low), (i if here > value[high] else high)
        fell = direction >= 0 and value[high] - here > noise
        rose = direction <= 0 and here - value[low] > noise
        if fell or rose:
            turned = high if fell else low
            if direction or turned:
                found.append(vertex(time, value, turned))
            direction, low, high = (-1 if fell else 1), i, i
    return found


def slope(values):
    """Slope of the straight line through values at 0, 1, 2, ..."""
    centre = (len(values) - 1) / 2
    return sum((i - centre) * v for i, v in enumerate(values)) / sum((i - centre) ** 2 for i in range(len(values)))


def damping_ratio(decrement):
    """Damping ratio from the logarithmic decrement of half a period."""
    return decrement / math.hypot(math.pi, decrement)


def swings(time, value):
    """Frequency (Hz), damping ratio, the damping ratio of each pair of ways that follow each other by a period, and what the first
    three turning points lie about."""
    turned = turning_points(time, value)
    ways = [math.log(abs(b[1] - a[1])) for a, b in zip(turned, turned[1:])]
    each = [damping_ratio((a - b) / 2) for a, b in zip(ways, ways[2:])]
    q = math.exp(ways[1] - ways[0])  # ratio of a way to the way before
    centre = (turned[2][1] + q * turned[1][1]) / (1 + q)
    return 0.5 / slope([t for t, _ in turned]), damping_ratio(-slope(ways)), each, centre


def fast_motion(time, value, begin, end):
    """Root mean square of what is left by the eighth difference over 2^8, which passes 35 % at 34 Hz and 0.001 % at 7.7 Hz of values
    that are 10 ms apart."""
    left = [sum((-1) ** k * math.comb(8, k) * value[i + k - 4] for k in range(9)) / 256
            for i in range(4, len(value) - 4) if begin <= time[i] < end]
    return math.sqrt(sum(v * v for v in left) / len(left))


def every_10_ms(time, value):
    """The values that a camera at 100 Hz would have seen, between those of a simulation."""
    seen, i = ([], []), 0
    for n in range(int(time[-1] * 100 + 1e-6) + 1):
        while i + 2 < len(time) and time[i + 1] < n / 100:
            i += 1
        seen[0].append(n / 100)
        seen[1].append(value[i] + (value[i + 1] - value[i]) * (n / 100 - time[i]) / (time[i + 1] - time[i]))
    return seen


def main():
    time, value = read(*sys.argv[1:])
    if abs(time[1] - time[0] - 0.01) > 1e-6:
        time, value = every_10_ms(time, value)
    first = [i for i, t in enumerate(time) if 0 <= t <= SECONDS + 1e-9]
    frequency, ratio, each, centre = swings([time[i] for i in first], [value[i] for i in first])
    late = [v for t, v in zip(time, value) if t > time[-1] - 1]
    if time[-1] > 4:
        print(f"rests at {sum(late) / len(late):.2f} mm")
    print(f"first swings about {centre:.2f} mm")
    print(f"{frequency:.3f} Hz, damping ratio {ratio:.4f}; period by period " + " ".join(f"{z:.3f}" for z in each))
    print(f"as damping of the stiffness {ratio / (math.pi * frequency):.3e} s, of the mass {4 * math.pi * frequency * ratio:.2f} 1/s")
    for begin in (0.1, 0.2, 0.3, 0.4):
        print(f"faster motion from {begin:.1f} to {begin + 0.1:.1f} s: {fast_motion(time, value, begin, begin + 0.1):.4f} mm")


if __name__ == "__main__":
    main()
