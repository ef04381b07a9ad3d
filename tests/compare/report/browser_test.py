"""All tables on a screen, and the report in a real browser: no console errors, every table is there, every body draws both models, turns and scales.

usage: browser_test.py SPRINGPROOF FOLDER

FOLDER receives the whole report and the screenshots, to be looked at.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

from PIL import Image

from chromium import examine, find_chromium, run_chromium

TABLES = ["4.1", "4.2", "4.3", "4.5", "4.6", "4.7", "5.1", "5.2", "5.3", "5.4", "5.12"]
SECTIONS = ["summary", "advice-0.45", "stiffnesses", "designs-4.5", "volumes", "cases"]
VIEWS = 21  # cube: three tests, two load sets, two materials, and figure 4.15's; three bars
WIDTH = 1280
SCALE = 0.5  # scale of the screenshots
AT_SCALE = f"--force-device-scale-factor={SCALE}"
LARGEST = 3e6  # bytes of a page


def views_alone(report, folder):
    """A copy of the report that shows nothing but the views."""
    style = "<style>header, footer, section:not(#bodies), nav { display: none }</style>"
    copy = folder / "views_alone.html"
    copy.write_text(report.read_text().replace("</head>", style + "</head>"))
    return copy


def without_scripts(page, folder):
    """What a browser whose scripts are off makes of a page. (Headless Chromium takes no screenshot in that mode.)"""
    copy = folder / "without_scripts.html"
    copy.write_text(re.sub(r"<script.*?</script>", "", page.read_text(), flags=re.S))
    return copy


def share_of_ink(picture, box):
    """Share of a rectangle's pixels that do not have its most frequent colour."""
    left, top, width, height = (round(SCALE * length) for length in box)
    part = picture.crop((left, top, min(left + width, picture.width), min(top + height, picture.height)))
    size = part.width * part.height
    return 1 - max(count for count, _ in part.getcolors(size)) / size


def check_views(found):
    assert len(found["views"]) == VIEWS, [view["id"] for view in found["views"]]
    for view in found["views"]:
        name, painted, alone, coloured = view["id"], view["painted"], view["springs_alone"], view["coloured"]
        # A body fills a good part of its picture: a tenth of the springs' lines' pixels would be an empty frame.
        assert painted["bluish"] > 0.02 * painted["all"], (name, painted)
        assert painted["orange"] > 0.005 * painted["all"], (name, painted)
        assert alone["bluish"] == 0 and alone["orange"] > 0, (name, alone)
        # Both ends of the scale of errors are seen: a held node has none, and the largest is on the surface, whichever side it has.
        assert view["has_errors"] and coloured["lowest"] > 0 and painted["lowest"] == 0, (name, coloured)
        for deed in ("slider_moves", "slider_returns", "mouse_turns_all", "keys_turn_all", "reset_returns"):
            assert view[deed], (name, deed)
    assert sum(view["coloured"]["highest"] > 0 for view in found["views"]) > VIEWS / 3, [view["coloured"] for view in found["views"]]
    assert found["outline_when_held"] == "none", found["outline_when_held"]


def check_screen(text):
    """All tables with the advice stand on 120 lines of 100 characters."""
    lines = text.splitlines()
    assert len(lines) <= 120, len(lines)
    assert max(map(len, lines)) <= 100, max(lines, key=len)
    assert "published values: " in text and "Which design to use" in text, text


def near(a, b, relative):
    return abs(a - b) <= relative * abs(b)


def check_calculator(found, advice, springproof):
    """The page names the recommended design, its stiffnesses and its errors for E = 50 kPa, nu = 0.45 and cells of 1 mm; between two
    tabulated ratios its stiffnesses are close to those of the design itself."""
    said = found["tabulated"]
    best, = (row for row in advice if row["poissons_ratio"] == 0.45 and row["recommended"])
    assert said["design"] == best["design"], said
    wanted = [50 * over for over in best["stiffness_per_E_L0"]] + [0.05 * best["volume_stiffness_per_E"]]  # N/m; MPa
    assert all(near(*pair, 1e-3) for pair in zip(said["stiffness"], wanted)), (said, wanted)
    assert (said["exponents"] is not None) == ("exponents" in best), (said, best)
    for number, exponent in zip((said["exponents"] or "").split(", "), best.get("exponents", ())):
        assert abs(float(number) - exponent) < 6e-4, (said, best)
    volume = max(best[load_set]["worst_volume_error_percent"] for load_set in ("small", "large"))
    errors = [best["small"]["worst_error_percent"], best["large"]["worst_error_percent"], volume]
    for tile, error in zip(said["tiles"], errors):
        assert abs(float(re.fullmatch(r"≤ ([.0-9]+) %", tile).group(1)) - error) < 0.06, (said, best)
    assert "errors of the thesis’s cube" in said["text"] and "Interpolated" not in said["text"], said

    for said in found["between"]:
        assert "tabulated at ν = 0.45 and 0.49" in said["text"], said
        design = json.loads(subprocess.run([springproof, "design", "--young", "0.05", "--poisson", "0.475", "--edge", "1", "--method",
                                            said["design"], "--json"], check=True, capture_output=True, text=True).stdout)
        wanted = design["stiffness_N_per_m"] + [design["volume_stiffness_MPa"]]
        assert all(near(*pair, 2e-3) for pair in zip(said["stiffness"], wanted)), (said, wanted)

    assert found["outside"]["design"] is None and "between 0.2 and 0.49" in found["outside"]["text"], found["outside"]


def check_chart(found, advice):
    assert len(found["chart"]) == len({row["design"] for row in advice}), found["chart"]
    for line in found["chart"]:
        rows = [row for row in advice if row["design"].replace("_", " ") == line["label"]]
        errors = [[row[load_set]["worst_error_percent"] for load_set in ("small", "large")] for row in rows]
        assert [point["y"] for point in line["values"]] == [None if None in pair else max(pair) for pair in errors], line
    tooltip = found["tooltip"]
    assert tooltip["opacity"] > 0 and tooltip["title"] == ["ν = 0.2"] and len(tooltip["lines"]) > 5, tooltip


def main():
    springproof, folder = sys.argv[1], Path(sys.argv[2]).resolve()
    subprocess.run([springproof, "tables", "--out", folder], check=True, stdout=subprocess.DEVNULL)
    check_screen((folder / "tables.txt").read_text())
    if not find_chromium():
        print("no Chromium here: of the page nothing was compared")
        return
    report = folder / "report.html"
    text = report.read_text()
    assert report.stat().st_size < LARGEST, report.stat().st_size
    assert not re.search(r"""(?:src|href)=["'](?!data:|#)""", text), "the page refers to something outside itself"
    assert "need scripts" in text.split("<script")[0], "nothing says that the page needs scripts"

    narrow, found = examine(report, "narrow.html", Path(__file__).parent / "check_page.js", options=("--window-size=400,900", AT_SCALE))
    assert found["overflow"] <= 0, f"a narrow page scrolls sideways, by {found['overflow']} pixels"
    rows = {table["name"]: table["rows"] for table in found["tables"]}
    for table in TABLES + SECTIONS:
        assert rows.get(table, 0) > 1, (table, rows)
    assert found["commands_in_cells"] == 0, found["commands_in_cells"]
    advice = json.loads((folder / "tables.json").read_text())["advice"]
    check_views(found)
    check_calculator(found, advice, springproof)
    check_chart(found, advice)
    narrow.unlink()

    # A screenshot of what a view left on its canvas: the page with its bodies alone.
    views = views_alone(report, folder)
    page, found = examine(views, "examined.html", Path(__file__).parent / "check_page.js", options=(f"--window-size={WIDTH},1000", AT_SCALE))
    size = f"--window-size={WIDTH},{found['height']}"
    live, still = folder / "views.png", folder / "without_scripts.png"
    run_chromium(page, size, AT_SCALE, f"--screenshot={live}", "--virtual-time-budget=10000")
    picture = Image.open(live).convert("RGB")
    for view in found["views"]:
        assert share_of_ink(picture, view["box"]) > 0.02, (view["id"], "is blank in the screenshot")
    run_chromium(without_scripts(report, folder), f"--window-size={WIDTH},3000", AT_SCALE, f"--screenshot={still}")
    assert share_of_ink(Image.open(still).convert("RGB"), (0, 300, WIDTH, 2500)) > 0.005, "no pictures where scripts are off"
    print(f"{len(found['views'])} views and {len(rows)} tables are on the page")


if __name__ == "__main__":
    main()
