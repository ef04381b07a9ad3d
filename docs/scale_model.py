"""Time and memory of a spring solve on many ranks: docs/scale.md says where the figures come from.

scale_model.py [UNKNOWNS]    of a cube; 1e9 by default
"""

import math
import sys

# Measured on one node (docs/scale.md).
CORE_SECONDS = 5.9e-6  # a solve, per unknown, both cores busy: 100^3 cells on two ranks
ITERATIONS = 23  # of conjugate gradients on the finest grid
EXCHANGES = 1.9  # in all, for each of those iterations' own
REDUCTIONS = 30  # in all, for each of those iterations
SOLVER_BYTES = 200  # per unknown, divided among the ranks
SCENE_BYTES = 57  # per unknown, on every rank: scene and answer
PROGRAM_BYTES = 168e6  # on every rank

# The stated network: 100 Gbit/s into a node of 32 ranks.
LATENCY = 2e-6  # s, a message
BANDWIDTH = 12.5e9 / 32  # bytes/s, a rank

LEAST_NODES, LEAST_NODES_IN_ALL = 2, 1000  # msm/snes/deal_out.cpp


def model(unknowns, ranks_along):
    ranks = ranks_along**3
    nodes = (unknowns / 3) ** (1 / 3)  # along an axis
    compute = CORE_SECONDS * unknowns / ranks
    levels, exchange = 0, 0.0
    while nodes / ranks_along >= LEAST_NODES and nodes**3 >= LEAST_NODES_IN_ALL:
        brick = nodes / ranks_along
        layer = ((brick + 2) ** 3 - brick**3) * 3 * 4  # bytes in single precision
        exchange += 7 * (26 * LATENCY + layer / BANDWIDTH)
        nodes = nodes / 2
        levels += 1
    gathered = nodes**3 * 3
    hops = math.log2(ranks)
    each = EXCHANGES * (exchange + hops * LATENCY + 2 * 4 * gathered / BANDWIDTH)
    messages = ITERATIONS * (each + REDUCTIONS * hops * LATENCY)
    coarse = CORE_SECONDS * gathered  # every rank by itself
    return ranks, levels, compute, messages, coarse, nodes


def main():
    unknowns = float(sys.argv[1]) if len(sys.argv) > 1 else 1e9
    alone = CORE_SECONDS * unknowns
    print(f"{unknowns:.3g} unknowns; one core: {alone:.0f} s")
    print("ranks   levels dealt out  compute s  messages s  coarse s  in all s  efficiency  solver MB/rank  scene MB/rank")
    for along in (2, 4, 8, 16, 32):
        ranks, levels, compute, messages, coarse, _ = model(unknowns, along)
        total = compute + messages + coarse
        solver = SOLVER_BYTES * unknowns / ranks / 1e6
        scene = (SCENE_BYTES * unknowns + PROGRAM_BYTES) / 1e6
        print(
            f"{ranks:6d} {levels:17d} {compute:10.2f} {messages:11.3f} {coarse:9.3f} {total:9.2f} "
            f"{alone / ranks / total:11.2f} {solver:15.0f} {scene:14.0f}"
        )


main()
