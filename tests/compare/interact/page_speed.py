"""How fast the page of `springproof interact` is while a mouse pulls on the middle of a body, in headless Chromium: no test, for what it
says is of the machine.

usage: page_speed.py SPRINGPROOF CASE PICTURE [OPTION ...]

PICTURE: a PNG that is made during the second of four pulls of 80 moves, 20 ms or more apart. OPTION: of `springproof interact`.
"""

import sys
import time
from pathlib import Path

from devtools import Browser
from interact_test import Program


def part(values, of):
    return sorted(values)[int(of * (len(values) - 1))] if values else float("nan")


def pull(page, x, y, picture=None):
    page.value("seen.latency_ms.length = seen.on_page_ms.length = 0")
    page.mouse("mousePressed", x, y)
    before = page.value("[seen.pictures, performance.now()]")
    for step in range(1, 81):
        page.mouse("mouseMoved", x + 0.8 * step, y - 0.5 * step)
        time.sleep(0.02)
    after = page.value("[seen.pictures, performance.now()]")
    if picture:
        page.screenshot(picture)
    page.mouse("mouseReleased", x + 64, y - 40, buttons=0)
    time.sleep(0.3)
    found = page.value("({drawn: seen.latency_ms, shown: seen.on_page_ms, step: frame.median_ms, triangles: view.drawn.triangles.length / 3, resolution: view.resolution})")
    print(f"{1000 * (after[0] - before[0]) / (after[1] - before[1]):.1f} pictures a second; from a move to its picture, ms: drawn "
          f"{part(found['drawn'], 0.5):.0f} (median), {part(found['drawn'], 0.9):.0f} (90 %), on the page {part(found['shown'], 0.5):.0f}, "
          f"{part(found['shown'], 0.9):.0f}; a step takes {found['step']:.1f} ms; {found['triangles']:.0f} triangles, {found['resolution']:.2f} of the pixels along a side")


def main():
    springproof, case, picture = map(Path, sys.argv[1:4])
    program = Program(springproof, case, *sys.argv[4:])
    with Browser() as browser:
        page = browser.open(program.address)
        page.wait_until("typeof seen !== 'undefined' && seen.frames > 5")
        x, y = page.value("(() => { const box = canvas.getBoundingClientRect(); return [box.left + box.width / 2, box.top + box.height / 2]; })()")
        for number in range(4):
            pull(page, x, y, picture if number == 1 else None)
        page.close()
    print(program.end()["step_ms"])


if __name__ == "__main__":
    main()
