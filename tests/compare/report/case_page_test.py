"""The page of one's own case in a real browser: hostile texts stay texts, both bodies turn, designs are ranked.

usage: case_page_test.py SPRINGPROOF CASE FOLDER

FOLDER/page.html is the page, for accessibility_test.py too.
"""

import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

from chromium import examine, find_chromium

NAME = "sheared <b>cube's & $(touch x)"
HOSTILE = "</script><script>document.title = 'owned'</script><img src=x onerror=\\\"document.title='owned'\\\">"


def hostile_case(source, folder):
    """The case under a name and a description that would be markup, a command or a script anywhere but in a text."""
    text = source.read_text().split("[[expect]]")[0]
    text = re.sub(r'^name = "sheared-cube"', lambda _: f'name = "{NAME}"', text, flags=re.M)
    text = re.sub(r'^description = .*', lambda _: f'description = "{HOSTILE}"', text, flags=re.M)
    text = text.replace("cells = [4, 4, 4]", "cells = [2, 2, 2]")
    case = folder / "hostile.toml"
    case.write_text(text)
    return case


MOVING = '''
schema = 1
name = "swinging"
[body]
shape = "box"
size = [20, 10, 10]
cells = [2, 1, 1]
[material]
model = "linear_elastic"
youngs_modulus = 0.1
poissons_ratio = 0.3
density = 1000
[[fixed]]
region = "x-"
[[load]]
kind = "gravity"
value = [0, 0, -9.81]
[dynamics]
scheme = "newmark"
step = 0.001
end = 0.05
[[measure]]
name = "course"
kind = "displacement"
node = "x+ y+ z+"
component = "z"
[[measure]]
name = "peak"
kind = "displacement"
node = "x+ y+ z+"
component = "z"
over_time = "peak"
'''


def check_motion(springproof, folder):
    """Two measures of one course share a picture, which has every step of both models."""
    case, out = folder / "swinging.toml", folder / "swinging"
    case.write_text(MOVING)
    done = subprocess.run([springproof, "run", case, "--out", out, "--report", "--json"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    motion = json.loads(done.stdout)["cases"][0]["motion"]
    copy, found = examine(out / "swinging.html", "examined.html", Path(__file__).parent / "check_page.js", options=("--window-size=1280,1000",))
    copy.unlink()
    picture, = found["motion"]
    lines = {line["label"]: [(at["x"], at["y"]) for at in line["values"]] for line in picture}
    course = motion["measures"][0]
    assert lines == {"finite elements": list(zip(motion["time"], course["fem"])), "springs": list(zip(motion["time"], course["msm"]))}, lines
    assert len(motion["time"]) == 51, motion["time"]


SKIN = '''
schema = 1
name = "skinned"
[body]
shape = "box"
size = [4, 4, 4]
cells = [2, 2, 2]
[material]
model = "linear_elastic"
youngs_modulus = 0.1
poissons_ratio = 0.3
[[fixed]]
region = "z-"
[[moved]]
region = "z+"
displacement = [1, 0, 0]
[fem]
accuracy = "none"
[surface]
file = "skin.stl"
[[landmark]]
name = "tip <b>of</b> the skin"
point = [4, 2, 3]
[[measure]]
name = "everywhere"
kind = "displacement_field_max"
'''
# An open sheet around two sides of the body.
SHEET = "solid skin\n" + "".join(
    f"facet normal 0 0 0\nouter loop\n{''.join(f'vertex {x} {y} {z}' + chr(10) for x, y, z in corners)}endloop\nendfacet\n"
    for corners in ([(4, 0, 0), (4, 4, 0), (4, 4, 4)], [(4, 0, 0), (4, 4, 4), (4, 0, 4)],
                    [(0, 0, 0), (4, 0, 0), (4, 0, 4)], [(0, 0, 0), (4, 0, 4), (0, 0, 4)],
                    [(4, 0, 2), (4, 4, 2), (4, 2, 3)])) + "endsolid\n"


def check_skin(springproof, folder):
    """A named surface stands in for the cells: four pictures that turn together, and a row for the landmark."""
    case, out = folder / "skinned.toml", folder / "skinned"
    case.write_text(SKIN)
    (folder / "skin.stl").write_text(SHEET)
    done = subprocess.run([springproof, "run", case, "--out", out, "--report", "--json"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    landmark, = json.loads(done.stdout)["cases"][0]["landmarks"]
    copy, found = examine(out / "skinned.html", "examined.html", Path(__file__).parent / "check_skin.js", options=("--window-size=1280,1000",))
    copy.unlink()
    assert found["names"] == ["skin-rest", "skin-fem", "skin-springs", "skin-distance"], found["names"]
    assert all(0.05 < part < 0.95 for part in found["painted"]), found["painted"]
    assert found["colours"][3] > found["colours"][1], found["colours"]
    assert found["keys_turn_all"] and found["mouse_turns_all"] and found["bodies"] == 0, found
    row, = found["landmarks"]
    assert row.startswith("tip <b>of</b> the skin") and f"{landmark['mean']:.3g}"[:5] in row, (row, landmark)
    assert found["legend"].startswith("0") and found["legend"].endswith(" mm"), found["legend"]


def main():
    springproof, source, folder = sys.argv[1], *map(Path, sys.argv[2:])
    if not find_chromium():
        print("no Chromium here: nothing was compared")
        return
    folder = folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    case, out = hostile_case(source, folder), folder / "out"
    typed = [springproof, "run", case, "--converge=3", "--out", out, "--report", "--designs", "moduli,hybrid,linear_method", "--json",
             "--set", "msm.accept=['inverted']"]
    done = subprocess.run(typed, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    results = json.loads(done.stdout)["cases"][0]
    page = folder / "page.html"
    shutil.copy(out / f"{NAME}.html", page)
    assert not re.search(r"""(?:src|href)=["'](?!data:|#)""", re.sub(r'id="report-data">.*?</script>', "", page.read_text(), flags=re.S))

    copy, found = examine(page, "examined.html", Path(__file__).parent / "check_page.js", options=("--window-size=1280,1000",))
    copy.unlink()
    assert "owned" not in found["title"] and found["heading"] == NAME, (found["title"], found["heading"])
    assert HOSTILE.replace("\\", "") in found["subheading"], found["subheading"]
    assert found["commands_in_cells"] == 0 and found["images"] == 0, found
    rows = {table["name"]: table["rows"] for table in found["tables"]}
    assert rows == {"measures": 3, "ranking": 4, "springs": 5, "moduli": 7, "stability": 3}, rows
    data = json.loads(re.search(r'id="report-data">(.*?)</script>', page.read_text(), re.S)[1])
    command, = data["commands"]
    assert shlex.split(command) == [str(word) for word in typed], command
    assert results["ranking"] == data["ranking"], results["ranking"]
    assert (out / "ranking.csv").read_text().count("\n") == 4
    view, = found["views"]
    assert view["has_errors"] and view["coloured"]["lowest"] > 0 and view["painted"]["orange"] > 0, view
    for deed in ("slider_moves", "slider_returns", "mouse_turns_all", "keys_turn_all", "reset_returns"):
        assert view[deed], (view["id"], deed)
    bars = {line["label"]: line["values"] for line in found["measures"]}
    for i, measure in enumerate(results["measures"]):
        assert measure["reference"] == "limit", measure
        error, bar = measure["error_percent"], measure["error_uncertainty_percent"]
        assert bars["springs"][i]["x"] == error and bars["uncertainty of the reference"][i] == [error - bar, error + bar], (bars, measure)
    check_motion(springproof, folder)
    check_skin(springproof, folder)
    print("the page of a case is whole")


if __name__ == "__main__":
    main()
