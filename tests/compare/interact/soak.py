"""Random pulls on a body for a while, without a browser: no NaN, no growth of memory, no cell inside out that is not told.

usage: soak.py SPRINGPROOF CASE FOLDER [SECONDS [SEED [REACH]]] [-- OPTIONS of interact]

SECONDS: 10 by default. REACH: of a drag, as a part of the body's size, 0.3 by default. Says what was seen as one line of JSON; the
recording of the pulls stays in FOLDER. A case of a picture that is not installed (its body.file) is a skip.
"""

import json
import math
import random
import re
import sys
import time
from pathlib import Path

from interact_test import Controller, Program


def resident_kb(process):
    return int(re.search(r"VmRSS:\s+(\d+)", Path(f"/proc/{process.pid}/status").read_text()).group(1))


def box_of(rest):
    axes = [rest[axis::3] for axis in range(3)]
    return [min(axis) for axis in axes], [max(axis) for axis in axes]


class Puller:
    """Grabs a random place from outside, draws it somewhere in a few strokes, lets it go, pauses, and begins again."""

    def __init__(self, page, reach):
        self.page, (lower, upper) = page, box_of(page.rest)
        self.centre = [(a + b) / 2 for a, b in zip(lower, upper)]
        self.size, self.reach = math.dist(lower, upper), reach
        self.n_grabs = 0
        self.is_held, self.until = False, 0

    def direction(self):
        way = [random.gauss(0, 1) for _ in range(3)]
        length = math.hypot(*way)
        return [value / length for value in way]

    def grab(self):
        way = self.direction()
        self.page.say(type="grab", origin=[at - 2 * self.size * step for at, step in zip(self.centre, way)], direction=way)
        self.target = [random.uniform(0.3, 1) * self.reach * self.size * step for step in self.direction()]
        self.n_grabs += 1

    def go_on(self, now):
        """What a hand does between two pictures."""
        if now >= self.until:
            self.is_held = not self.is_held
            if self.is_held:
                self.grab()
            else:
                self.page.say(type="release")
            self.began, self.until = now, now + (random.uniform(0.5, 1.2) if self.is_held else random.uniform(0.1, 0.4))
        if self.is_held:
            part = min(1.0, (now - self.began) / (0.7 * (self.until - self.began)))
            self.page.say(type="drag", by=[part * value for value in self.target])


def soak(program, seconds, reach):
    page = Controller(program.address)
    puller = Puller(page, reach)
    begin = time.monotonic()
    memory, n_frames, n_inverted, largest, last_steps = [], 0, 0, 0.0, 0
    while (now := time.monotonic() - begin) < seconds:
        puller.go_on(now)
        frame = page.frame()  # asserts that all displacements are finite
        assert all(math.isfinite(value) for name, value in frame.items() if name != "displacement"), frame
        assert frame["steps"] > last_steps, (last_steps, frame["steps"])
        last_steps = frame["steps"]
        n_frames += 1
        n_inverted += frame["inverted"] > 0
        largest = max(largest, max(map(abs, frame["displacement"])))
        memory.append((now, resident_kb(program.process)))
        time.sleep(0.03)
    page.close()
    warm = [kb for at, kb in memory if at > 0.2 * seconds]
    return {"seconds": seconds, "masses": page.description["masses"], "grabs": puller.n_grabs, "frames": n_frames, "frames_with_inverted_cells": n_inverted,
            "largest_displacement_mm": largest, "memory_kb_after_a_fifth": warm[0], "memory_kb_at_the_end": warm[-1]}


def main():
    words, options = (sys.argv[:sys.argv.index("--")], sys.argv[sys.argv.index("--") + 1:]) if "--" in sys.argv else (sys.argv, [])
    springproof, case, folder = words[1], *map(Path, words[2:4])
    seconds, seed, reach = (float(word) for word in (words[4:] + ["10", "1", "0.3"][len(words) - 4:]))
    picture = re.search(r'^file = "(/.*?)"', case.read_text(), re.MULTILINE)
    if picture and not Path(picture.group(1)).exists():
        print(f"{picture.group(1)} is not here: nothing was compared")
        return
    random.seed(int(seed))
    folder.mkdir(parents=True, exist_ok=True)
    program = Program(springproof, case, "--stay", "--out", folder, *options)
    seen = soak(program, seconds, reach)
    summary = program.interrupt()
    print(json.dumps({**seen, "summary": summary}))
    assert summary["pulled_steps"] > 0, summary
    assert summary["frames"]["with_inverted_cells"] == seen["frames_with_inverted_cells"], (seen, summary)
    growth = seen["memory_kb_at_the_end"] - seen["memory_kb_after_a_fifth"]
    recorded = 100 * summary["pulled_steps"] / 1024  # kB: a row of the recording is 40 bytes, and vectors double
    # Pages of the heap; and half a kilobyte a mass, as a preconditioner that is made anew where a step is halved may not fit in where the last one was.
    assert growth < 4096 + 0.5 * seen["masses"] + recorded, seen


if __name__ == "__main__":
    main()
