"""Forces of springs, midlines, volume terms and biquadratic tetrahedra, and their derivatives; numpy alone.

`python3 forces.py [FOLDER]` compares its forces with those of check.csv in a folder that `springproof export` wrote, its
own without FOLDER. Import it for a program of your own:

    body = Body(read_package("folder"))
    force = body.forces(body.rest + u)            # on the nodes; u and force have three columns
    change = -body.stiffness_product(body.rest + u, du)

Lengths are in mm and forces in N in CSV files, in mm and mN in scene.json, in m and N in a client's scene.
"""
import csv
import json
import os
import sys

import numpy as np

EDGES = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
TETRAHEDRON_FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
# The six faces of a hexahedron whose vertex is i + 2j + 4k, anticlockwise from outside. A volume is a sum over
# triangles; that under a bilinear face is the mean of its two triangulations.
FACES = [(0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6)]
HALVES = [t for a, b, c, d in FACES for t in ((a, b, c), (a, c, d), (a, b, d), (b, c, d))]
# Arrays of a body and their columns, as in docs/reference/client-protocol.md.
COLUMNS = {"nodes": 3, "springs": 6, "midlines": 13, "volume_hexahedra": 11, "volume_patches": 3,
           "volume_patch_tetrahedra": 5, "biquadratic_tetrahedra": 46}


def cross_matrix(v):
    zero = np.zeros(len(v))
    rows = [zero, -v[:, 2], v[:, 1], v[:, 2], zero, -v[:, 0], -v[:, 1], v[:, 0], zero]
    return np.stack(rows, 1).reshape(-1, 3, 3)


def volumes_of(at, triangles, part):
    """Volumes of bodies with vertices at[body, vertex], their gradients, and a function that returns their
    second derivatives: a triangle a, b, c adds a . (b x c) / 6, of which a part counts."""
    at = at - at[:, :1]  # far from the origin digits would be lost
    volume, gradient = np.zeros(len(at)), np.zeros(at.shape)
    turns = [turn for a, b, c in triangles for turn in ((a, b, c), (b, c, a), (c, a, b))]
    for p, q, r in turns:
        normal = part / 6 * np.cross(at[:, q], at[:, r])
        gradient[:, p] += normal
        volume += np.einsum("si,si->s", at[:, p], normal) / 3

    def second():
        blocks = np.zeros((len(at), at.shape[1], at.shape[1], 3, 3))
        for p, q, r in turns:
            blocks[:, p, q] -= part / 6 * cross_matrix(at[:, r])
            blocks[:, p, r] += part / 6 * cross_matrix(at[:, q])
        return blocks

    return volume, gradient, second


def volume_law(volume, k, rest, logarithmic):
    """Pressure k_v (J - 1) or k_v ln J, J = V/V0, and its derivative with respect to V."""
    is_log, ratio = logarithmic == 1, volume / rest
    curved = np.where(is_log, ratio, 1)
    return k * np.where(is_log, np.log(curved), ratio - 1), k / rest / curved


class Body:
    """A body's terms. Each kind has, for each of its terms: nodes, forces on them, and blocks(clamp), the second derivative
    of its energy in 3x3 blocks; clamped, without the parts that may be negative."""

    def __init__(self, arrays):
        self.rest = arrays["nodes"]
        self.n = len(self.rest)
        springs, mid = arrays["springs"], arrays["midlines"]
        # A spring's vector is a weighted sum of nodes: two of them, or the eight of a midline.
        self.groups = []
        if len(springs):
            weights = np.tile([-1.0, 1.0], (len(springs), 1))
            self.groups.append((springs[:, :2].astype(int), weights, springs[:, 2:].T))
        if len(mid):
            upper = np.arange(8)[None, :] >> mid[:, 8].astype(int)[:, None] & 1
            self.groups.append((mid[:, :8].astype(int), np.where(upper, 0.25, -0.25), mid[:, 9:].T))
        for _, _, laws in self.groups:
            if not np.isin(laws[2], (0, 1)).all():
                raise ValueError(f"springs of a law of number {laws[2].max():g}, known are 0 (Hooke's) and 1 (power-log)")
        hexahedra = arrays["volume_hexahedra"]
        self.hexahedra = hexahedra[:, :8].astype(int), hexahedra[:, 8:].T
        self.read_patches(arrays["volume_patch_tetrahedra"].astype(int), arrays["volume_patches"].T)
        tets = arrays["biquadratic_tetrahedra"]
        self.tets = tets[:, :4].astype(int), tets[:, 4:40].reshape(-1, 6, 6), tets[:, 40:]

    def read_patches(self, tetrahedra, laws):
        """Lists the nodes of each patch. Short rows are filled with node 0, on which their forces are 0."""
        of, nodes = tetrahedra[:, 0], tetrahedra[:, 1:]
        pairs, place = np.unique(of[:, None] * self.n + nodes, return_inverse=True)
        patch = pairs // self.n
        place_in = np.arange(len(pairs)) - np.searchsorted(patch, patch)
        listed = np.zeros((laws.shape[1], place_in.max(initial=-1) + 1), int)
        listed[patch, place_in] = pairs % self.n
        self.patches = listed, of, nodes, place_in[place.reshape(nodes.shape)], laws

    def terms(self, x):
        for group in self.groups:
            yield self.spring_terms(x, *group)
        if len(self.hexahedra[0]):
            yield self.hexahedron_terms(x)
        if len(self.patches[0]):
            yield self.patch_terms(x)
        if len(self.tets[0]):
            yield self.tetrahedron_terms(x)

    def spring_terms(self, x, nodes, weights, laws):
        k, rest, law, parameter = laws
        d = np.einsum("sa,sai->si", weights, x[nodes])
        length = np.linalg.norm(d, axis=1)
        q, is_log = length / rest, law == 1  # tension k l0 q^p ln q; Hooke's k (l - l0)
        log, power = np.where(is_log, np.log(q), 0), np.where(is_log, parameter, 0)
        tension = k * np.where(is_log, rest * q**power * log, length - rest)

        def blocks(clamp):
            slope = k * np.where(is_log, q ** (power - 1) * (power * log + 1), 1)
            across = tension / length
            if clamp:
                slope, across = np.maximum(slope, 0), np.maximum(across, 0)
            n = d / length[:, None]
            nn = n[:, :, None] * n[:, None, :]
            block = slope[:, None, None] * nn + across[:, None, None] * (np.eye(3) - nn)
            return np.einsum("sa,sb,sij->sabij", weights, weights, block, optimize=True)

        return nodes, -weights[:, :, None] * ((tension / length)[:, None] * d)[:, None, :], blocks

    def hexahedron_terms(self, x):
        nodes, laws = self.hexahedra
        volume, gradient, second = volumes_of(x[nodes], HALVES, 0.5)
        return self.volume_terms(nodes, volume, gradient, second, laws)

    def patch_terms(self, x):
        """Volumes around nodes: a quarter of their tetrahedra's."""
        listed, of, nodes, places, laws = self.patches
        each, gradient_of_each, second_of_each = volumes_of(x[nodes], TETRAHEDRON_FACES, 0.25)
        volume, gradient = np.zeros(len(listed)), np.zeros(listed.shape + (3,))
        np.add.at(volume, of, each)
        np.add.at(gradient, (of[:, None], places), gradient_of_each)

        def second():
            blocks = np.zeros(listed.shape + (listed.shape[1], 3, 3))
            at = of[:, None, None], places[:, :, None], places[:, None, :]
            np.add.at(blocks, at, second_of_each())
            return blocks

        return self.volume_terms(listed, volume, gradient, second, laws)

    @staticmethod
    def volume_terms(nodes, volume, gradient, second, laws):
        pressure, slope = volume_law(volume, *laws)

        def blocks(clamp):
            whole = np.einsum("s,sai,sbj->sabij", slope, gradient, gradient, optimize=True)
            return whole if clamp else whole + pressure[:, None, None, None, None] * second()

        return nodes, -pressure[:, None, None] * gradient, blocks

    def tetrahedron_terms(self, x):
        """W = 1/2 sum_ef K_ef D_e D_f, D_e = l_e^2 - L_e^2."""
        nodes, stiffness, rest = self.tets
        ends = np.zeros((6, 4))
        for e, (a, b) in enumerate(EDGES):
            ends[e, a], ends[e, b] = -1, 1
        d = np.einsum("ea,sai->sei", ends, x[nodes])
        stress = np.einsum("sef,sf->se", stiffness, np.einsum("sei,sei->se", d, d) - rest**2)

        def blocks(clamp):
            slope = 2 * np.einsum("ea,sei->seai", ends, d)  # slope in D_e
            across = 2 * (np.maximum(stress, 0) if clamp else stress)
            return (np.einsum("sef,seai,sfbj->sabij", stiffness, slope, slope, optimize=True)
                    + np.einsum("se,ea,eb,ij->sabij", across, ends, ends, np.eye(3), optimize=True))

        return nodes, -2 * np.einsum("ea,se,sei->sai", ends, stress, d, optimize=True), blocks

    def forces(self, x):
        """Forces on the nodes, minus the gradient of the energy."""
        total = np.zeros((self.n, 3))
        for nodes, force, _ in self.terms(x):
            np.add.at(total, nodes, force)
        return total

    def stiffness_product(self, x, dx):
        """The energy's second derivative times dx: minus the change of the forces."""
        total = np.zeros((self.n, 3))
        for nodes, _, blocks in self.terms(x):
            np.add.at(total, nodes, np.einsum("sabij,sbj->sai", blocks(False), dx[nodes], optimize=True))
        return total

    def stiffness(self, x):
        """Its entries: rows of degree of freedom (3 node + component), degree of freedom, value; sum those that recur."""
        all_entries = [np.zeros((0, 3))]
        for nodes, _, blocks in self.terms(x):
            block, of = blocks(False), 3 * nodes[:, :, None] + np.arange(3)
            rows = np.broadcast_to(of[:, :, None, :, None], block.shape)
            columns = np.broadcast_to(of[:, None, :, None, :], block.shape)
            all_entries.append(np.stack([rows.ravel(), columns.ravel(), block.ravel()], 1))
        return np.concatenate(all_entries)


def arrays_of(lists):
    """Arrays by name, of rows; those that are missing have none."""
    return {name: np.array(lists.get(name, []), float).reshape(-1, n) for name, n in COLUMNS.items()}


def rows_of(folder, name):
    path = os.path.join(folder, name)
    if not os.path.exists(path):
        return []
    with open(path, newline="", encoding="ascii") as file:
        return list(csv.DictReader(file))


def numbers(row, *names):
    return [float(row[name]) for name in names]


def nodes_in(row, *places):
    return numbers(row, *("node_%s" % place for place in places))


def law_in(row):
    """k (N/mm), rest length (mm), law and exponent of a spring."""
    k, rest = numbers(row, "stiffness_N_per_m", "rest_length_mm")
    return [1e-3 * k, rest, 1, float(row["exponent"])] if row["exponent"] else [1e-3 * k, rest, 0, 0]


def volume_law_in(row):
    return numbers(row, "stiffness_MPa", "rest_volume_mm3") + [float(row["law"] == "logarithmic")]


def read_csv_files(folder):
    """Arrays of a body from CSV files; N and mm."""
    patch_rows, patches = rows_of(folder, "volume_patches.csv"), {}
    for row in patch_rows:
        patches.setdefault(row["node"], (len(patches), volume_law_in(row)))
    edges = ["%d%d" % edge for edge in EDGES]
    return arrays_of({
        "nodes": [numbers(row, "x_mm", "y_mm", "z_mm") for row in rows_of(folder, "nodes.csv")],
        "springs": [nodes_in(row, "a", "b") + law_in(row) for row in rows_of(folder, "springs.csv")],
        # Between the mean of the first four nodes and that of the last four, which differ in bit 2 of their places.
        "midlines": [nodes_in(row, *(end + v for end in "ab" for v in "0123")) + [2] + law_in(row)
                     for row in rows_of(folder, "midlines.csv")],
        "volume_hexahedra": [nodes_in(row, *range(8)) + volume_law_in(row)
                             for row in rows_of(folder, "volume_terms.csv")],
        "volume_patches": [law for _, law in patches.values()],
        "volume_patch_tetrahedra": [[patches[row["node"]][0]] + nodes_in(row, *range(4)) for row in patch_rows],
        "biquadratic_tetrahedra": [
            nodes_in(row, *range(4))
            + numbers(row, *("stiffness_%s_%s_N_per_mm3" % (e, f) for e in edges for f in edges))
            + numbers(row, *("rest_length_%s_mm" % e for e in edges)) for row in rows_of(folder, "tetrahedra.csv")]})


def read_scene_file(path):
    """Arrays of a body from scene.json; mN and mm."""
    with open(path, encoding="ascii") as file:
        model = json.load(file)
    lists = dict(model["terms"], nodes=model["positions"])
    lists["springs"] = [spring + [0, 0] for spring in model["springs"]] + lists["springs"]
    return arrays_of(lists)


def read_package(folder):
    """Arrays of a body from the files of `springproof export`."""
    scene = os.path.join(folder, "scene.json")
    return read_scene_file(scene) if os.path.exists(scene) else read_csv_files(folder)


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else os.path.dirname(os.path.abspath(__file__))
    check = np.array([[float(value) for value in row.values()] for row in rows_of(folder, "check.csv")])
    body = Body(read_package(folder))
    force = body.forces(body.rest + check[:, 1:4])
    largest = np.linalg.norm(check[:, 4:], axis=1).max()
    difference = np.linalg.norm(force - check[:, 4:], axis=1).max() / largest
    print("forces on %d nodes: the largest difference from check.csv is %.1e of the largest force" % (body.n, difference))
    return 0 if difference <= 1e-9 else 1  # rounding leaves less than 1e-11


if __name__ == "__main__":
    sys.exit(main())
