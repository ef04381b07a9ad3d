"""How far the finite elements' motions in two folders of `run --replay --out` are apart, on cells of two sizes of the same body.

usage: motions_apart.py COARSE_FOLDER FINE_FOLDER PULLS

Percent of the fine one's displacement, root mean square over time and the nodes of the body's own outer faces, both motions being written
there: of all these nodes, and of those that are ever further from the places that PULLS, the recording, pulls at. Only Python's standard
library is used.
"""

import csv
import math
import re
import struct
import sys
from collections import Counter
from pathlib import Path

FACES = ((0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))  # of VTK's hexahedron
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


def places_of(recording):
    with open(recording, newline="") as file:
        return sorted({tuple(float(row[axis]) for axis in "xyz") for row in csv.DictReader(file)})


def over_time(squares):
    """By trapezoids, of equal steps."""
    return math.sqrt((sum(squares) - (squares[0] + squares[-1]) / 2) / (len(squares) - 1))


def main():
    coarse, fine = (frames(folder) for folder in sys.argv[1:3])
    assert len(coarse) == len(fine) > 1, "the motions have other steps"
    rest = coarse[0].vectors("rest position")
    assert rest == fine[0].vectors("rest position"), "the bodies are not the same"
    surface = nodes_of_surface(coarse[0])
    distance = {node: min(math.dist(rest[node], place) for place in places_of(sys.argv[3])) for node in surface}
    apart, size = ({node: [] for node in surface} for _ in range(2))
    for of_coarse, of_fine in zip(coarse, fine):
        a, b = (frame.vectors("fem_displacement") for frame in (of_coarse, of_fine))
        for node in surface:
            apart[node].append(math.dist(a[node], b[node]) ** 2)
            size[node].append(math.hypot(*b[node]) ** 2)
    for cells in range(5):
        chosen = [node for node in surface if distance[node] >= cells * EDGE]
        difference, whole = (over_time([sum(step) / len(chosen) for step in zip(*(of[node] for node in chosen))]) for of in (apart, size))
        print(f"{len(chosen)} nodes, {cells * EDGE:g} mm and more from what is pulled: {100 * difference / whole:.1f} % of {whole:.3f} mm")


if __name__ == "__main__":
    main()
