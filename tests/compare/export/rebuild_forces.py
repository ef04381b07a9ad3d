"""Forces of a deformed state, rebuilt from exported files alone.

rebuild_forces.py FOLDER sofa|csv|vtu STATE

STATE has a line for each node: displacement (mm), internal force of the springs (N), constrained components (0 or 1), applied force (N),
prescribed displacement (mm). Fails unless the files in FOLDER give the same forces, supports, loads and motions. Nothing of the program is used but what is in FOLDER.
"""

import csv
import importlib
import math
import re
import struct
import sys
from pathlib import Path

import numpy as np
import sofa_objects

TOLERANCE = 1e-10  # relative to the largest force; files hold every digit, sums have another order


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def add(force, node, vector, factor=1.0):
    for a in range(3):
        force[node][a] += factor * vector[a]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def spring_force(force, x, i, j, stiffness, rest_length, exponent=None):
    """Hooke's, or the power-log law k l0 q^p ln q; N/mm, mm."""
    d = minus(x[j], x[i])
    length = math.sqrt(dot(d, d))
    q = length / rest_length
    tension = stiffness * (length - rest_length) if exponent is None else stiffness * rest_length * q**exponent * math.log(q)
    add(force, i, d, tension / length)
    add(force, j, d, -tension / length)


def from_csv(folder, displacement):
    """Forces by the package's own forces.py."""
    with open(folder / "nodes.csv", newline="") as file:
        nodes = list(csv.DictReader(file))
    assert [int(n["node"]) for n in nodes] == list(range(len(nodes)))
    forces = forces_of(folder)
    body = forces.Body(forces.read_package(folder))
    held = [[int(n[f"constrained_{a}"]) for a in "xyz"] for n in nodes]
    loads = [[float(n[f"force_{a}_N"]) for a in "xyz"] for n in nodes]
    return body.forces(body.rest + np.array(displacement)), held, loads, [[float(n[f"displacement_{a}_mm"]) for a in "xyz"] for n in nodes]


def forces_of(folder):
    sys.path.insert(0, str(folder))
    return importlib.import_module("forces")


def check_slopes(field, x):
    """The change of a field's forces against differences of the forces, and its matrix against the change."""
    dx = np.random.default_rng(1).uniform(-1, 1, x.shape)
    step = 1e-5
    by_differences = (field.forces(x + step * dx) - field.forces(x - step * dx)) / (2 * step)
    field.forces(x)
    change = field.change(dx)
    largest = np.abs(change).max()
    # The error of differences: step^2 times a third derivative, 1e-10 about, and rounding of the forces / step.
    assert np.abs(change - by_differences).max() <= 1e-8 * largest, "addDForce"
    product = np.zeros(x.size)
    for i, j, value in field.slope(len(x)):
        product[i] += value * dx.flat[j]
    assert np.abs(product - change.ravel()).max() <= 1e-12 * largest, "addKToMatrix"


def from_sofa(folder, displacement):
    """Forces of the scene's own objects; mN and mN/mm become N and N/mm."""
    objects = sofa_objects.scene_of(folder)
    of = lambda component: [data for name, data in objects if name == component]
    (state,) = of("MechanicalObject")
    x = [[p + d for p, d in zip(place, u)] for place, u in zip(state["rest_position"], displacement)]
    motion = [minus(place, rest) for place, rest in zip(state["position"], state["rest_position"])]
    force = [[0.0] * 3 for _ in x]
    for a, b, stiffness, rest_length in sofa_objects.springs_of(of("SpringForceField")):
        spring_force(force, x, a, b, 1e-3 * stiffness, rest_length)
    for field in of("ForceField"):
        force = (np.array(force) + 1e-3 * field.forces(x)).tolist()
        check_slopes(field, np.array(x))
    held, loads = [[0] * 3 for _ in x], [[0.0] * 3 for _ in x]
    for support in of("PartialFixedProjectiveConstraint"):
        for node in support["indices"]:
            held[node] = support["fixedDirections"]
    for load in of("ConstantForceField"):
        for node, f in zip(load["indices"], load["forces"]):
            loads[node] = [1e-3 * component for component in f]
    return force, held, loads, motion


def from_vtu(folder, displacement):
    content = (folder / "springs.vtu").read_bytes()
    head, _, raw = content.partition(b'<AppendedData encoding="raw">')
    raw = raw[raw.index(b"_") + 1:]
    assert b'header_type="UInt64"' in head and b'byte_order="LittleEndian"' in head and b"compressor" not in head
    arrays = {}
    for words in re.findall(rb"<DataArray ([^>]*)>", head):
        word = dict(re.findall(r'(\w+)="([^"]*)"', words.decode()))
        at = int(word["offset"])
        (size,) = struct.unpack_from("<Q", raw, at)
        code = {"Float64": "d", "Int64": "q", "UInt8": "B"}[word["type"]]
        values = struct.unpack_from(f"<{size // struct.calcsize(code)}{code}", raw, at + 8)
        n = int(word.get("NumberOfComponents", 1))
        arrays[word["Name"]] = [list(values[i:i + 3]) for i in range(0, len(values), 3)] if n == 3 else list(values)
    x = [[p + d for p, d in zip(place, u)] for place, u in zip(arrays["rest position"], displacement)]
    assert set(arrays["types"]) == {3}  # lines
    force = [[0.0] * 3 for _ in x]
    ends = arrays["connectivity"]
    for s, (k, rest_length, is_power_log, p, kind) in enumerate(zip(*(arrays[name] for name in (
            "stiffness", "rest_length", "is_power_log", "exponent", "kind")))):
        spring_force(force, x, ends[2 * s], ends[2 * s + 1], k, rest_length, p if is_power_log else None)
        crossed = sum(a != b for a, b in zip(*(arrays["rest position"][ends[2 * s + e]] for e in range(2))))
        assert kind == crossed, (s, kind)  # box: 1 an edge, 2 a face diagonal, 3 an internal diagonal
    return force, [[int(c) for c in held] for held in arrays["constrained"]], arrays["force"], arrays["prescribed_displacement"]


def main():
    folder, target, state = Path(sys.argv[1]), sys.argv[2], Path(sys.argv[3])
    lines = [[float(word) for word in line.split(",")] for line in state.read_text().splitlines()]
    force, held, loads, motion = {"csv": from_csv, "sofa": from_sofa, "vtu": from_vtu}[target](folder, [line[:3] for line in lines])
    assert len(force) == len(lines)
    largest = max(abs(f) for line in lines for f in line[3:6])
    difference = max(abs(f - g) for line, node in zip(lines, force) for f, g in zip(line[3:6], node))
    print(f"{target}: forces up to {largest:.3g} N, rebuilt to {difference / largest:.1e} of that")
    assert difference <= TOLERANCE * largest
    assert [[int(c) for c in line[6:9]] for line in lines] == held, "other supports"
    # N come back from mN with an error of rounding.
    assert all(abs(f - g) <= 1e-15 * abs(f) for line, node in zip(lines, loads) for f, g in zip(line[9:12], node)), "other loads"
    assert all(abs(u - v) <= 1e-14 * max(1, abs(u)) for line, node in zip(lines, motion) for u, v in zip(line[12:15], node)), "other motions"


main()
