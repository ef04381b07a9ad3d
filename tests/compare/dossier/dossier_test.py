"""The command dossier, its document and its page: every number has its gate or none, orders and uncertainties are right.

usage: dossier_test.py SPRINGPROOF FOLDER

FOLDER/out/dossier.html is the page, for accessibility_test.py too.
"""

import json
import math
import re
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "report"))
from chromium import examine, find_chromium  # noqa: E402

HOSTILE = "</script><img src=x onerror=\\\"document.title='owned'\\\">"
CASE = f'''
schema = 1
name = "pulled-block"
description = "{HOSTILE}"
[body]
shape = "box"
size = [10, 10, 10]
cells = [2, 2, 2]
[material]
model = "linear_elastic"
youngs_modulus = 0.3
poissons_ratio = 0.3
[[fixed]]
region = "z-"
[[load]]
region = "z+"
kind = "traction"
value = [0, 0, 0.003]
[fem]
formulation = "small_strain"
element = "q1_bbar"
[[measure]]
name = "stretch"
kind = "displacement"
node = "near 5 5 10"
component = "z"
[[measure]]
name = "everywhere"
kind = "displacement_field_l2"
[[expect]]
measure = "stretch"
error_percent = [-20, 20]
reference = "requirement"
reason = "what the test asks for"
'''
SECTIONS = ("context", "code_verification", "calculation_verification", "validation", "applicability")


def run(springproof, *words):
    return subprocess.run([springproof, "dossier", *map(str, words)], capture_output=True, text=True)


def lists_of_gates(value, inside=False):
    """Every list of names of gates in a document, and in what "gates" holds."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from lists_of_gates(inner, inside or key == "gates")
    elif isinstance(value, list) and inside:
        yield value
    elif isinstance(value, list):
        for inner in value:
            yield from lists_of_gates(inner)


def check_gates(document):
    names = [gate["name"] for gate in document["gates"]]
    assert len(set(names)) == len(names), names
    kinds = {gate["kind"] for gate in document["gates"] if gate["name"].startswith("springproof/")}
    assert {"exact", "converged", "peer"} <= kinds, kinds
    assert all(gate["met"] for gate in document["gates"]), [gate for gate in document["gates"] if not gate["met"]]
    held = sum((list(lists_of_gates(document[section])) for section in SECTIONS), [])
    assert len(held) > 20 and all(name in names for one in held for name in one), held
    stretch, everywhere = document["calculation_verification"][0]["measures"]
    assert stretch["gates"] == {"fem": [], "msm": [], "error_percent": ["pulled-block: stretch error_percent"]}, stretch["gates"]
    assert not any(everywhere["gates"].values()), everywhere["gates"]


def check_orders(document):
    """Orders by the formula of three values, apart from the program's."""
    orders = document["code_verification"]["orders"]
    for one in orders:
        if one["order"] is None:
            assert one["reason"], one
            continue
        coarse, middle, fine = one["values"][-3:]
        assert math.isclose(one["order"], math.log2((middle - coarse) / (fine - middle)), rel_tol=1e-6), one
    column = [one["order"] for one in orders if one["case"] == "confined-column"]
    assert len(column) == 4 and all(abs(order - 2) < 0.02 for order in column), column


def check_validation(document):
    row, other = document["validation"]["rows"]
    assert row["datum"] == 0.09 and row["standard_uncertainty"] == 0.004 and other["standard_uncertainty"] == 0.008, (row, other)
    assert document["validation"]["description"] == "pulled by hand", document["validation"]
    for model in ("fem", "msm"):
        side = row[model]
        parts = side["numerical"], 2 * side["input"], 2 * row["standard_uncertainty"]
        assert side["is_complete"] and math.isclose(side["uncertainty"], math.hypot(*parts), rel_tol=1e-9), side
        assert math.isclose(side["difference"], side["value"] - 0.09, rel_tol=1e-9), side
    # A linear body's stretch is as 1/E, up to (sigma/E)^2.
    effect, = [one for one in document["validation"]["inputs"] if one["measure"] == "stretch"]
    assert math.isclose(effect["fem"], -row["fem"]["value"] * 0.01 / 0.3, rel_tol=2e-3), (effect, row)
    # Twice the load, which is a state of its own that no gate judges.
    assert math.isclose(other["fem"]["value"], 2 * row["fem"]["value"], rel_tol=1e-6) and other["fem"]["gates"] == [], other
    assert [one for one in document["missing"] if one["section"] == "validation"] == [], document["missing"]


def keys_of(value):
    if isinstance(value, list):
        return set().union(*map(keys_of, value)) if value else set()
    if not isinstance(value, dict):
        return set()
    return set(value) | set().union(*(keys_of(inner) for key, inner in value.items() if key != "areas_mm2"))  # whose keys are loads


def check_documented(document):
    """Every key stands in json.md, in the section of dossier, of run or of all documents."""
    text = (Path(__file__).resolve().parents[3] / "docs" / "reference" / "json.md").read_text()
    parts = re.split(r"^## (.*)$", text, flags=re.MULTILINE)
    sections = {heading.strip("`"): body for heading, body in zip(parts[1::2], parts[2::2])}
    named = set(re.findall(r"`([^`]+)`", "".join(sections[one] for one in ("dossier", "run", "design", "What all documents share"))))
    assert keys_of(document) <= named, sorted(keys_of(document) - named)


def check_page(page, document):
    copy, found = examine(page, "examined.html", Path(__file__).parent / "check_dossier.js", options=("--window-size=1400,1000",))
    copy.unlink()
    assert not found["errors"] and "owned" not in found["title"] and found["images"] == 0, found
    assert found["sections"] == ["context", "code", "calculation", "validation", "applicability", "missing", "repeat", "about"], found["sections"]
    assert found["dead_links"] == [], found["dead_links"]
    assert found["rows"]["missing"] == len(document["missing"]) + 1, found["rows"]
    assert found["rows"]["own-gates"] + found["rows"]["gates"] == len(document["gates"]) + 2, found["rows"]
    assert found["rows"]["measured"] == 5 and found["no_gate"] > 5, found
    assert not re.search(r"NaN|undefined|\[object", found["text"]), re.search(r".{40}(NaN|undefined|\[object).{40}", found["text"])


def main():
    springproof, folder = sys.argv[1], Path(sys.argv[2]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    case, data, out = folder / "block.toml", folder / "data.csv", folder / "out"
    case.write_text(CASE)
    data.write_text("# pulled by hand\nload[0].value[2],stretch,sigma\n0.003,0.09,0.004\n0.006,0.2,0.008\n")
    done = run(springproof, case, "--out", out, "--measured", data, "--converge", "--uncertain", "material.youngs_modulus=0.01",
               "--question", "How far does it stretch?", "--json")
    assert done.returncode == 0, done.stderr
    document = json.loads(done.stdout)
    assert document == json.loads((out / "dossier.json").read_text())
    assert [key for key in SECTIONS if key not in document] == []
    assert "no claim of compliance" in document["method"]
    check_documented(document)
    check_gates(document)
    check_orders(document)
    check_validation(document)
    assert document["context"]["question"] == "How far does it stretch?" and document["context"]["role"] is None
    if find_chromium():
        check_page(out / "dossier.html", document)

    # Data without an uncertainty, inputs without one, and a limit that is not asked for are missing, and the sum says so. A
    # case's missed gate fails the command, and says which.
    data.write_text("stretch\n0.09\n")
    case.write_text(CASE.replace("[-20, 20]", "[90, 91]"))
    done = run(springproof, case, "--out", folder / "missed", "--measured", data, "--set", "fem.accuracy='none'")
    assert done.returncode == 1 and "MISSED pulled-block: stretch error_percent" in done.stdout, (done.returncode, done.stdout, done.stderr)
    assert "missing: " in done.stdout, done.stdout
    document = json.loads((folder / "missed" / "dossier.json").read_text())
    side = document["validation"]["rows"][0]["fem"]
    assert side["uncertainty"] is None and not side["is_complete"] and side["numerical"] is None, side
    told = " ".join(one["what"] for one in document["missing"])
    for what in ("the uncertainty of the measurement of stretch (line 2)", "what the uncertainty of the inputs", "the limit of stretch",
                 "the numerical uncertainty of stretch (line 2), both models", "who measured what"):
        assert what in told, (what, told)
    print("the dossier is whole")


if __name__ == "__main__":
    main()
