"""Time and memory of a solve on many ranks: docs/developing/scale.md says where the figures come from.

scale_model.py [UNKNOWNS]    of a cube; 1e9 by default
"""

import math
import sys
from dataclasses import dataclass

# The stated network: 100 Gbit/s into a node of 32 ranks.
LATENCY = 2e-6  # s, a message
BANDWIDTH = 12.5e9 / 32  # bytes/s, a rank

# In all, for each iteration on the finest grid; counted for springs.
EXCHANGES, REDUCTIONS = 1.9, 30


@dataclass
class Measured:
    name: str
    core_seconds: float  # a solve, per unknown, both cores of a node busy: 100^3 cells on two ranks
    iterations: int  # linear ones, on the finest grid
    exchanges: int  # exchanges of layers in single precision, per level and iteration
    solver_bytes: int  # per unknown, divided among the ranks
    axes: int  # along which the grid is dealt out: bricks or slabs
    least_in_all: int  # nodes of a level that is dealt out


SPRINGS = Measured("springs, bricks", 5.9e-6, 23, 7, 200, 3, 1000)
FINITE_ELEMENTS = Measured("finite elements, slabs", 10.3e-6, 18, 8, 720, 1, 500)
PROGRAM_BYTES = 190e6  # on every rank, with buffers of messages
SCENE_BYTES = 0.5  # per unknown, on every rank
ANSWER_BYTES = 32 / 3  # per unknown, divided among the ranks
LEAST_NODES = 2  # number of nodes of a brick or slab along an axis that is divided


def times(model, unknowns, ranks):
    """Computing, messages, the levels that every rank has whole (s); the levels that are dealt out; the unknowns of a rank's part with
    its layers, and of the levels that every rank has whole."""
    along = round(ranks ** (1 / model.axes))
    nodes = (unknowns / 3) ** (1 / 3)  # along an axis
    with_layers = unknowns / ranks * (1 + 2 * along / nodes) ** model.axes
    levels, exchange = 0, 0.0
    while nodes / along >= LEAST_NODES and nodes**3 >= model.least_in_all:
        part = nodes / along
        layer = (part + 2) ** 3 - part**3 if model.axes == 3 else 2 * nodes**2
        neighbours = 3**model.axes - 1
        exchange += model.exchanges * (neighbours * LATENCY + layer * 12 / BANDWIDTH)
        nodes /= 2
        levels += 1
    gathered = 3 * nodes**3
    hops = math.log2(ranks)
    each = exchange + hops * LATENCY + 8 * gathered / BANDWIDTH
    messages = model.iterations * (EXCHANGES * each + REDUCTIONS * hops * LATENCY)
    return model.core_seconds * unknowns / ranks, messages, model.core_seconds * gathered, levels, with_layers, gathered


def main():
    unknowns = float(sys.argv[1]) if len(sys.argv) > 1 else 1e9
    for model, all_ranks in ((SPRINGS, (8, 64, 512, 4096, 32768)), (FINITE_ELEMENTS, (8, 16, 32, 64, 128))):
        alone = model.core_seconds * unknowns
        print(f"{model.name}: {unknowns:.3g} unknowns, one core {alone:.0f} s")
        print(" ranks  levels  compute s  messages s  coarse s    all s  efficiency  MB/rank: part  whole levels  scene  answer  program")
        for ranks in all_ranks:
            compute, messages, coarse, levels, part, gathered = times(model, unknowns, ranks)
            total = compute + messages + coarse
            memory = (model.solver_bytes * part, model.solver_bytes * gathered, SCENE_BYTES * unknowns, ANSWER_BYTES * unknowns / ranks, PROGRAM_BYTES)
            print(
                f"{ranks:6d} {levels:7d} {compute:10.2f} {messages:11.2f} {coarse:9.2f} {total:8.2f} "
                f"{alone / ranks / total:11.2f} " + "{:14.0f} {:13.0f} {:6.0f} {:7.0f} {:8.0f}".format(*(b / 1e6 for b in memory))
            )


main()
