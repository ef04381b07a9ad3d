"""An animation (APNG) of a body that a mouse pulls on in the page of `springproof interact`, drawn with all triangles.

usage: animation.py SPRINGPROOF CASE OUT.png [OPTION ...]
"""

import base64
import struct
import sys
import time
import zlib
from pathlib import Path

from devtools import Browser
from interact_test import Program

N_FRAMES, EVERY_S = 20, 0.2  # a screenshot with all triangles takes as long where a processor draws


def chunks(png):
    at = 8
    while at < len(png):
        length, kind = struct.unpack_from(">I4s", png, at)
        yield kind, png[at + 8:at + 8 + length]
        at += 12 + length


def chunk(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def animated(pictures):
    """An APNG of PNGs of one size, each shown for EVERY_S; it goes on for ever."""
    heads = {next(content for kind, content in chunks(png) if kind == b"IHDR") for png in pictures}
    assert len(heads) == 1, "the pictures differ in size or colours"
    head = heads.pop()
    out, number = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"acTL", struct.pack(">II", len(pictures), 0)), 0
    for picture in pictures:
        out += chunk(b"fcTL", struct.pack(">I8sIIHHBB", number, head[:8], 0, 0, round(1000 * EVERY_S), 1000, 0, 0))
        number += 1
        for kind, content in chunks(picture):
            if kind != b"IDAT":
                continue
            if picture is pictures[0]:
                out += chunk(kind, content)
            else:
                out += chunk(b"fdAT", struct.pack(">I", number) + content)
                number += 1
    return out + chunk(b"IEND", b"")


def main():
    springproof, case, out = map(Path, sys.argv[1:4])
    program = Program(springproof, case, *sys.argv[4:])
    with Browser() as browser:
        page = browser.open(program.address, 1400, 1000)
        page.wait_until("typeof seen !== 'undefined' && seen.frames > 5")
        page.wait_until("view.is_full", 60)
        page.value("Object.defineProperty(view, 'fine_ms', {get: () => 0, set: () => {}}); view.choose_resolution = () => {}")
        left, top, width, height = page.value("(() => { const box = canvas.getBoundingClientRect(); return [box.left, box.top, box.width, box.height]; })()")
        x, y = left + 0.68 * width, top + 0.4 * height
        clip = {"x": left - 20, "y": top - 20, "width": width + 80, "height": height + 20, "scale": 260 / (width + 80)}
        pictures, begin = [], time.monotonic()
        page.mouse("mousePressed", x, y)
        for number in range(N_FRAMES):
            pulled = min(1, number / 6)
            if number < 11:
                page.mouse("mouseMoved", x + 130 * pulled, y - 40 * pulled)
            if number == 11:
                page.mouse("mouseReleased", x + 130, y - 40, buttons=0)
            time.sleep(max(0, begin + (number + 1) * EVERY_S - time.monotonic()))
            pictures.append(base64.b64decode(page.call("Page.captureScreenshot", format="png", clip=clip)["data"]))
        taken = time.monotonic() - begin
        page.close()
    program.end()
    out.write_bytes(animated(pictures))
    print(f"{len(pictures)} pictures in {taken:.1f} s, shown in {N_FRAMES * EVERY_S:.1f} s; {out.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
