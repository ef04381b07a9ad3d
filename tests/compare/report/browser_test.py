"""The report in a real browser: no console errors, every table is there, every view draws both models, turns and scales.

usage: browser_test.py SPRINGPROOF FOLDER

FOLDER receives the whole report and the screenshots, to be looked at. Only Python's standard library is used.
"""

import json
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

TABLES = ["4.1", "4.2", "4.3", "4.5", "4.6", "4.7", "5.1", "5.2", "5.3", "5.4", "5.12"]
SECTIONS = ["summary", "designs", "advice", "volumes", "machine", "cases"]
VIEWS = 15  # cube: three tests, two load sets, two materials; three bars
WIDTH = 1280
SCALE = 0.5  # of the screenshots: reading them takes Python longer than Chromium takes to make them


def run_chromium(chromium, page, *options):
    """Standard output of a headless browser on a page that it may not leave; console messages are failures."""
    with tempfile.TemporaryDirectory() as profile:
        command = [chromium, "--headless", "--no-sandbox",  # the page is our own, and containers have neither users nor namespaces
                   "--user-data-dir=" + profile, "--no-first-run", "--disable-extensions",
                   "--disable-background-networking", "--disable-component-update", "--disable-sync", "--disable-quic",
                   "--host-resolver-rules=MAP * ~NOTFOUND",  # nothing may be fetched
                   "--use-angle=swiftshader", "--enable-unsafe-swiftshader",  # WebGL without a graphics card
                   "--enable-logging=stderr", "--hide-scrollbars", f"--force-device-scale-factor={SCALE}", *options, page.as_uri()]
        done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    messages = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    assert done.returncode == 0, done.stderr[-2000:]
    assert not messages, "\n".join(messages)
    return done.stdout


def views_alone(report, folder):
    """A copy of the report that shows nothing but the views."""
    style = "<style>header, footer, section:not(#views, #pictures), #pictures figure:not(.view) { display: none }</style>"
    copy = folder / "views_alone.html"
    copy.write_text(report.read_text().replace("</head>", style + "</head>"))
    return copy


def without_scripts(page, folder):
    """What a browser whose scripts are off makes of a page. (Headless Chromium takes no screenshot in that mode.)"""
    copy = folder / "without_scripts.html"
    copy.write_text(re.sub(r"<script.*?</script>", "", page.read_text(), flags=re.S))
    return copy


def instrumented(page, folder):
    """A copy of a page that examines itself."""
    text = page.read_text()
    catch = ("<script>window.errors = []; window.addEventListener('error', (e) => errors.push(e.message));"
             "window.addEventListener('unhandledrejection', (e) => errors.push(String(e.reason)));</script>")
    check = "<script>" + (Path(__file__).parent / "check_page.js").read_text() + "</script>"
    assert text.count("<head>") == 1 and text.count("</body>") == 1
    copy = folder / "examined.html"
    copy.write_text(text.replace("<head>", "<head>" + catch).replace("</body>", check + "</body>"))
    return copy


def read_png(path):
    """Rows of (r, g, b[, a]) pixels of an 8-bit PNG without interlace, which is what Chromium writes."""
    content = path.read_bytes()
    width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", content[16:29])
    assert depth == 8 and colour in (2, 6) and interlace == 0
    size, at, packed = {2: 3, 6: 4}[colour], 8, b""
    while at < len(content):
        length, kind = struct.unpack(">I4s", content[at:at + 8])
        if kind == b"IDAT":
            packed += content[at + 8:at + 8 + length]
        at += length + 12
    raw, stride, rows = zlib.decompress(packed), width * size, []
    previous = bytearray(stride)
    for y in range(height):
        kind, line = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for x in range(stride if kind else 0):
            left = line[x - size] if x >= size else 0
            up, corner = previous[x], previous[x - size] if x >= size else 0
            if kind == 1:
                guess = left
            elif kind == 2:
                guess = up
            elif kind == 3:
                guess = (left + up) // 2
            else:
                guess = min((abs(up - corner), 0, left), (abs(left - corner), 1, up),
                            (abs(left + up - 2 * corner), 2, corner))[2]
            line[x] = (line[x] + guess) & 255
        rows.append([tuple(line[x:x + 3]) for x in range(0, stride, size)])
        previous = line
    return rows


def share_of_ink(rows, box):
    """Of a rectangle's pixels, the share that is not of its most frequent colour."""
    left, top, width, height = (round(SCALE * length) for length in box)
    counts = {}
    for row in rows[top:top + height]:
        for pixel in row[left:left + width]:
            counts[pixel] = counts.get(pixel, 0) + 1
    return 1 - max(counts.values()) / sum(counts.values())


def share_of_colour(rows, colour):
    near = sum(max(abs(a - b) for a, b in zip(pixel, colour)) <= 3 for row in rows for pixel in row)
    return near / sum(map(len, rows))


def check_views(found):
    assert len(found["views"]) == VIEWS, [view["id"] for view in found["views"]]
    for view in found["views"]:
        name, painted, alone = view["id"], view["painted"], view["springs_alone"]
        # A body fills a good part of its picture: a tenth of the springs' lines' pixels would be an empty frame.
        assert painted["bluish"] > 0.02 * painted["all"], (name, painted)
        assert painted["orange"] > 0.005 * painted["all"], (name, painted)
        assert alone["bluish"] == 0 and alone["orange"] > 0, (name, alone)
        for deed in ("slider_moves", "slider_returns", "mouse_turns"):
            assert view[deed], (name, deed)


def check_calculator(said, advice):
    """For E = 50 kPa, nu = 0.45 and cells of 1 mm the page names the recommended design, its stiffnesses and its errors."""
    best, = (row for row in advice if row["poissons_ratio"] == 0.45 and row["recommended"])
    assert said.startswith(best["design"] + ": "), said
    for symbol, over in zip("efd", best["stiffness_per_E_L0"]):
        number = float(re.search(rf"k_{symbol} = ([-.e0-9]+)", said).group(1))  # N/m; E L0 is 50 N/m
        assert abs(number - 50 * over) < 1e-3 * abs(number), (said, best)
    named = re.search(r"of exponents ([-.0-9, ]+)\.", said)
    assert (named is not None) == ("exponents" in best), (said, best)
    for number, exponent in zip(named.group(1).split(",") if named else (), best.get("exponents", ())):
        assert abs(float(number) - exponent) < 6e-4, (said, best)
    worst = re.search(r"up to ([.0-9]+) % under the\s+small loads, ([.0-9]+) % under the\s+large", said)
    for number, load_set in zip(worst.groups(), ("small", "large")):
        assert abs(float(number) - best[load_set]["worst_error_percent"]) < 0.06, (said, best)


def main():
    springproof, folder = sys.argv[1], Path(sys.argv[2]).resolve()
    chromium = shutil.which("chromium") or shutil.which("chromium-browser")
    if not chromium:
        print("no Chromium here: nothing was compared")
        return
    subprocess.run([springproof, "tables", "--out", folder], check=True, stdout=subprocess.DEVNULL)
    report = folder / "report.html"
    text = report.read_text()
    assert not re.search(r"""(?:src|href)=["'](?!data:|#)""", text), "the page refers to something outside itself"

    assert "need scripts" in text.split("<script")[0], "nothing says that the page needs scripts"

    views = views_alone(report, folder)
    page = instrumented(views, folder)
    size = f"--window-size={WIDTH},1000"
    dom = run_chromium(chromium, page, size, "--dump-dom", "--virtual-time-budget=10000")
    match = re.search(r'<script type="application/json" id="found">(.*?)</script>', dom, re.S)
    assert match, "the page's own scripts did not come to their end"
    found = json.loads(match.group(1))
    assert found["errors"] == [], found["errors"]
    rows = {table["name"]: table["rows"] for table in found["tables"]}
    for table in TABLES + SECTIONS:
        assert rows.get(table, 0) > 1, (table, rows)
    check_views(found)
    check_calculator(found["calculator"], json.loads((folder / "tables.json").read_text())["advice"])

    size = f"--window-size={WIDTH},{found['height']}"
    live, still = folder / "views.png", folder / "without_scripts.png"
    run_chromium(chromium, page, size, f"--screenshot={live}", "--virtual-time-budget=10000")
    pixels = read_png(live)
    for view in found["views"]:
        assert share_of_ink(pixels, view["box"]) > 0.02, (view["id"], "is blank in the screenshot")
    run_chromium(chromium, without_scripts(views, folder), size, f"--screenshot={still}")
    assert share_of_colour(read_png(still), (220, 236, 246)) > 0.02, "no static pictures where scripts are off"
    print(f"{len(found['views'])} views and {len(rows)} tables are on the page")


if __name__ == "__main__":
    main()
