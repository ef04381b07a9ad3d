"""How far both models' motions in a folder of `run --replay --out` are from finite elements on finer cells of the same body, and from their limit.

usage: motions_apart.py FOLDER FINE_FOLDER [FINER_FOLDER] PULLS

Percent of the reference's displacement, root mean square over time and the nodes of the body's own outer faces, all motions being written
there: of all these nodes, of those in the spheres that PULLS, the recording, pulls at, and of those that are ever further from all spheres.
The reference are the finite elements of the finest folder; with three folders also their limit, extrapolated from the last two as of second
order, u + (u - u_before)/3, cells being half as large from folder to folder. Only Python's standard library is used.
"""

import csv
import math
import re
import struct
import sys
from collections import Counter
from pathlib import Path

FACES = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))  # VTK's hexahedron
EDGE = 15.5  # mm


class Frame:
    """A .vtu as the program writes it: appended, raw, lengths of eight bytes."""

    def __init__(self, path):
        self.content = path.read_bytes()
        begin = self.content.index(b"<AppendedData")
        self.header = self.content[:begin].decode()
        self.data = self.content.index(b"_", begin) + 1

    def array(self, name, code):
        at = self.data + int(re.search(rf'Name="{name}"[^>]* offset="(\d+)"', self.header)[1])
        length, = struct.unpack_from("<Q", self.content, at)
        return struct.unpack_from(f"<{length // 8}{code}", self.content, at + 8)

    def vectors(self, name):
        numbers = self.array(name, "d")
        return [numbers[i:i + 3] for i in range(0, len(numbers), 3)]


def frames(folder):
    series, = Path(folder).glob("*.pvd")
    return [Frame(Path(folder) / name) for name in re.findall(r'file="([^"]+)"', series.read_text())]


def nodes_of_surface(frame):
    numbers = frame.array("connectivity", "q")
    sides = Counter(tuple(sorted(numbers[cell + v] for v in face)) for cell in range(0, len(numbers), 8) for face in FACES)
    return sorted({node for side, n in sides.items() if n == 1 for node in side})


def spheres_of(recording):
    """Centres and radii, mm."""
    with open(recording, newline="") as file:
        return sorted({(tuple(float(row[axis]) for axis in "xyz"), float(row["radius"])) for row in csv.DictReader(file)})


def over_time(squares):
    """Root mean square by trapezoids of equal steps."""
    return math.sqrt((sum(squares) - (squares[0] + squares[-1]) / 2) / (len(squares) - 1))


def to_limit(before, last):
    return [u + (u - v) / 3 for u, v in zip(last, before)]


def squared_distances(some, others, nodes):
    """Squared distances of every node at every step."""
    return {node: [math.dist(a[node], b[node]) ** 2 for a, b in zip(some, others)] for node in nodes}


def root_mean_square(squares, nodes):
    return over_time([sum(step) / len(nodes) for step in zip(*(squares[node] for node in nodes))])


def main():
    *folders, recording = sys.argv[1:]
    series = [frames(folder) for folder in folders]
    assert len({len(motion) for motion in series}) == 1 and len(series[0]) > 1, "the motions have other steps"
    rest = series[0][0].vectors("rest position")
    assert all(rest == motion[0].vectors("rest position") for motion in series), "the bodies are not the same"
    surface = nodes_of_surface(series[0][0])
    spheres = spheres_of(recording)
    distance = {node: min(math.dist(rest[node], centre) - radius for centre, radius in spheres) for node in surface}
    parts = {"of the surface": surface, "in the spheres": [node for node in surface if distance[node] <= 0]}
    for cells in range(5):
        parts[f"{cells * EDGE:g} mm and more from the spheres"] = [node for node in surface if distance[node] > cells * EDGE]

    fem = [[frame.vectors("fem_displacement") for frame in motion] for motion in series]
    msm = [frame.vectors("msm_displacement") for frame in series[0]]
    references = {folders[-1]: fem[-1]}
    if len(folders) == 3:
        references["the limit"] = [[to_limit(u, v) for u, v in zip(before, last)] for before, last in zip(fem[1], fem[2])]
    at_rest = [[(0.0, 0.0, 0.0)] * len(rest)] * len(msm)
    for name, reference in references.items():
        squares = [squared_distances(motion, reference, surface) for motion in (fem[0], msm, at_rest)]
        print(f"from {name}, in percent of its displacement:")
        for place, nodes in parts.items():
            if nodes:
                elements, springs, whole = (root_mean_square(of, nodes) for of in squares)
                print(f"  {len(nodes)} nodes {place}: finite elements {100 * elements / whole:.1f}, springs {100 * springs / whole:.1f}, of {whole:.3f} mm")


if __name__ == "__main__":
    main()
