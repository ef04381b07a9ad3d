"""Forces of a deformed state, rebuilt from exported files alone.

rebuild_forces.py FOLDER sofa|csv|vtu STATE

STATE has a line for each node: displacement (mm), internal force of the springs (N), constrained components (0 or 1), applied force (N),
prescribed displacement (mm). Fails unless the files in FOLDER give the same forces, supports, loads and motions. Only Python's standard library is used, and nothing of the
program: the formulas are those of docs/using/designs.md.
"""

import csv
import itertools
import math
import re
import struct
import sys
from pathlib import Path

import sofa_objects

TOLERANCE = 1e-10  # relative to the largest force; files hold every digit, sums have another order


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def add(force, node, vector, factor=1.0):
    for a in range(3):
        force[node][a] += factor * vector[a]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


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


def volume_gradient(x):
    """Volume of the trilinear hexahedron by 2x2x2 Gauss points, and its gradient; vertex v = i + 2j + 4k at (i, j, k)."""
    volume, gradient = 0.0, [[0.0] * 3 for _ in range(8)]
    gauss = (0.5 - 0.5 / math.sqrt(3), 0.5 + 0.5 / math.sqrt(3))
    for point in itertools.product(gauss, repeat=3):
        slopes = []  # derivatives of the eight shape functions
        for v in range(8):
            bits = [v >> a & 1 for a in range(3)]
            values = [p if b else 1 - p for p, b in zip(point, bits)]
            signs = [1 if b else -1 for b in bits]
            slopes.append([signs[0] * values[1] * values[2], values[0] * signs[1] * values[2], values[0] * values[1] * signs[2]])
        columns = [[sum(slopes[v][a] * x[v][c] for v in range(8)) for c in range(3)] for a in range(3)]  # dx/dxi_a
        cofactors = [cross(columns[(a + 1) % 3], columns[(a + 2) % 3]) for a in range(3)]
        volume += dot(columns[0], cofactors[0]) / 8
        for v in range(8):
            for a in range(3):
                for c in range(3):
                    gradient[v][c] += slopes[v][a] * cofactors[a][c] / 8
    return volume, gradient


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def from_csv(folder, displacement):
    nodes = rows_of(folder / "nodes.csv")
    assert [int(n["node"]) for n in nodes] == list(range(len(nodes)))
    triple = lambda row, name: [float(row[f"{name}_{a}"]) for a in ("x", "y", "z")]
    x = [[float(n[f"{a}_mm"]) + u[i] for i, a in enumerate("xyz")] for n, u in zip(nodes, displacement)]
    force = [[0.0] * 3 for _ in nodes]
    for s in rows_of(folder / "springs.csv"):
        spring_force(force, x, int(s["node_a"]), int(s["node_b"]), 1e-3 * float(s["stiffness_N_per_m"]), float(s["rest_length_mm"]),
                     float(s["exponent"]) if s["exponent"] else None)
    midlines = folder / "midlines.csv"
    for m in rows_of(midlines) if midlines.exists() else []:  # between means of four nodes each
        ends = [[int(m[f"node_{end}{v}"]) for v in range(4)] for end in "ab"]
        centres = [[sum(x[n][a] for n in nodes) / 4 for a in range(3)] for nodes in ends]
        of_ends = [[0.0] * 3 for _ in ends]
        spring_force(of_ends, centres, 0, 1, 1e-3 * float(m["stiffness_N_per_m"]), float(m["rest_length_mm"]),
                     float(m["exponent"]) if m["exponent"] else None)
        for nodes_of_end, vector in zip(ends, of_ends):
            for node in nodes_of_end:
                add(force, node, vector, 0.25)
    for cell in rows_of(folder / "volume_terms.csv"):
        corners = [int(cell[f"node_{v}"]) for v in range(8)]
        volume, gradient = volume_gradient([x[c] for c in corners])
        ratio = volume / float(cell["rest_volume_mm3"])
        pressure = float(cell["stiffness_MPa"]) * {"linear": ratio - 1, "logarithmic": math.log(ratio)}[cell["law"]]
        for corner, slope in zip(corners, gradient):
            add(force, corner, slope, -pressure)
    edges = ["01", "02", "03", "12", "13", "23"]
    for t in rows_of(folder / "tetrahedra.csv"):
        corners = [int(t[f"node_{v}"]) for v in range(4)]
        along = [minus(x[corners[int(e[1])]], x[corners[int(e[0])]]) for e in edges]
        changes = [dot(d, d) - float(t[f"rest_length_{e}_mm"]) ** 2 for d, e in zip(along, edges)]
        for d, e in zip(along, edges):
            tension = sum(float(t[f"stiffness_{e}_{f}_N_per_mm3"]) * change for f, change in zip(edges, changes))
            add(force, corners[int(e[0])], d, 2 * tension)
            add(force, corners[int(e[1])], d, -2 * tension)
    held = [[int(n[f"constrained_{a}"]) for a in "xyz"] for n in nodes]
    loads = [[float(n[f"force_{a}_N"]) for a in "xyz"] for n in nodes]
    return force, held, loads, [[float(n[f"displacement_{a}_mm"]) for a in "xyz"] for n in nodes]


def from_sofa(folder, displacement):
    """Forces of the scene's own objects; mN and mN/mm become N and N/mm."""
    objects = sofa_objects.scene_of(folder)
    of = lambda component: [data for name, data in objects if name == component]
    (state,), (springs,) = of("MechanicalObject"), of("SpringForceField")
    x = [[p + d for p, d in zip(place, u)] for place, u in zip(state["rest_position"], displacement)]
    motion = [minus(place, rest) for place, rest in zip(state["position"], state["rest_position"])]
    force = [[0.0] * 3 for _ in x]
    for a, b, stiffness, rest_length in sofa_objects.springs_of(springs):
        spring_force(force, x, a, b, 1e-3 * stiffness, rest_length)
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
