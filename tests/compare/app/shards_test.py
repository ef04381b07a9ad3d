"""Work divided among shards, and merged: the same files as one command leaves.

usage: shards_test.py SPRINGPROOF SOURCE_FOLDER

Only Python's standard library is used.
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM, SOURCE = (str(Path(argument).resolve()) for argument in sys.argv[1:3])
GATES = sorted((Path(SOURCE) / "cases/gates").glob("*.toml"))
SECONDS = re.compile(r'("(?:setup|solve)": |unknowns in the last, )[-+.e\d]+')


def springproof(*words, **options):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, timeout=600, **options)


def shards(folder, n, *words, workers=()):
    """Folders of the n finished shards of a command."""
    folders = [folder / f"{n}-{index}" for index in range(1, n + 1)]
    for index, out in enumerate(folders, 1):
        done = springproof(*words, "--shard", f"{index}/{n}", "--out", out, *workers)
        assert done.returncode == 0 and done.stdout.startswith(f"shard {index} of {n}: "), done
    again = springproof(*words, "--shard", f"1/{n}", "--out", folders[0])
    assert again.returncode == 0 and again.stdout.startswith("shard 1 of "), again  # which takes up what is there
    return folders


def refused(why, *words):
    done = springproof(*words)
    assert done.returncode == 2 and not done.stdout and done.stderr.count("\n") == 1 and why in done.stderr, (why, done)


def files(folder, but=()):
    """Contents by name, times taken out."""
    found = {}
    for file in folder.rglob("*"):
        name = str(file.relative_to(folder))
        if file.is_file() and not name.startswith("solved/") and name not in but:
            found[name] = SECONDS.sub(r"\1 t", file.read_text()) if file.suffix == ".json" else file.read_bytes()
    return found


def assert_same(found, expected):
    assert found.keys() == expected.keys(), (found.keys(), expected.keys())
    for name, content in found.items():
        assert content == expected[name], f"{name} differs"


def mechanism(folder):
    """A gate whose springs do not carry the load."""
    case = folder / "mechanism.toml"
    text = (Path(SOURCE) / "cases/gates/sheared_cube.toml").read_text().replace('"sheared-cube"', '"mechanism"')
    case.write_text(re.sub(r"\[msm\]\n(?:[^\[\n].*\n)*", '[msm]\ndesign = "given"\nstiffness = [0, 0, 30]\n', text))
    return case


def test_gates(folder):
    """Gates: the same text, JUnit, JSON, CSV and fields; a failed solve of a shard is a failed case of the whole."""
    cases = [*GATES, mechanism(folder)]
    whole = springproof("gate", *cases, "--out", folder / "whole", "--junit", folder / "whole.xml")
    assert whole.returncode == 1 and "FAILED case" in whole.stdout and "msm failed" in whole.stdout, whole
    document = json.loads(springproof("gate", *cases, "--json").stdout)
    for n in (2, 3):
        parts = shards(folder, n, "gate", *cases)
        out, junit = folder / f"merged{n}", folder / f"merged{n}.xml"
        merged = springproof("merge", *reversed(parts), "--out", out, "--junit", junit)
        assert merged.returncode == 1 and merged.stdout == whole.stdout and not merged.stderr, (n, merged)
        assert junit.read_bytes() == (folder / "whole.xml").read_bytes()
        assert_same(files(out), files(folder / "whole"))
        assert len(files(out)) == len(cases) + len(GATES) + 2, files(out).keys()  # springs' .vtu where they converge
        as_json = springproof("merge", *parts, "--json", "--annotate")
        assert json.loads(as_json.stdout) == document and "::error file=" in as_json.stderr, as_json
    good = shards(folder / "good", 2, "gate", *GATES, workers=("--workers", 1))
    assert springproof("merge", *good).returncode == 0


def test_wrong_shards(folder):
    """Missing, double and mixed shards, changed cases and lost answers are refused with one line."""
    case = folder / "cube.toml"
    case.write_text((Path(SOURCE) / "cases/gates/sheared_cube.toml").read_text())
    words = ("gate", case, GATES[-1])
    one, two = shards(folder, 2, *words)
    assert springproof("merge", one, two).returncode == 0
    refused("of 2 shards 1 is missing", "merge", two)
    refused("so is", "merge", one, two, one)
    refused("no shard.json", "merge", one, folder)
    refused("--set=", "merge", one, *shards(folder / "set", 2, *words, "--set", "material.poissons_ratio=0.3")[1:])
    refused("one of 3 shards, not 2", "merge", one, *shards(folder / "more", 3, *words)[1:])
    refused("--junit", "merge", *shards(folder / "tables", 2, "tables", "4.1"), "--junit", folder / "x.xml")
    for folder_of_forged in (one, two):
        record = folder_of_forged / "shard.json"
        forged = json.loads(record.read_text())
        forged["command"].append(f"--out={folder}/forged")
        record.write_text(json.dumps(forged))
    refused("--out=", "merge", one, two)
    assert not (folder / "forged").exists()
    one, two = shards(folder, 2, *words)
    case.write_text(case.read_text().replace("[[expect]]", "[[expect]] # the first", 1))
    assert springproof("merge", one, two).returncode == 0  # a comment changes nothing
    text = case.read_text()
    case.write_text(text.replace("youngs_modulus = ", "youngs_modulus = 1", 1))
    refused("not what they were", "merge", one, two)
    case.write_text(text)
    kept = next(file for part in (one, two) for file in (part / "solved").iterdir())
    content = kept.read_bytes()
    kept.write_bytes(content[:-1])
    refused(f"{kept}: is damaged", "merge", one, two)
    kept.unlink()
    refused(f"{kept}: has no answers", "merge", one, two)
    for words in (("--shard", "0/2"), ("--shard", "3/2"), ("--shard", "1/2", "--json"), ("--shard", "1/2", "--bless", "sheared-cube")):
        done = springproof("gate", case, *words, "--out", folder / "none")
        assert done.returncode == 2 and not done.stdout and "--shard" in done.stderr, done


def test_tables(folder):
    """Tables: every file but the report, which tells the times."""
    tables = ("tables", "4.1", "4.3", "5.12", "--trace")
    whole = springproof(*tables, "--out", folder / "whole")
    assert whole.returncode == 0, whole
    for n in (2, 3):
        parts = shards(folder, n, *tables)
        merged = springproof("merge", *parts, "--out", folder / f"merged{n}")
        assert merged.returncode == 0 and merged.stdout == whole.stdout, merged
        found = files(folder / f"merged{n}", but=("report.html",))
        assert_same(found, files(folder / "whole", but=("report.html",)))
        assert len(found) > 10, found.keys()
        assert (folder / f"merged{n}" / "report.html").stat().st_size > 100_000


def main():
    for name, test in list(globals().items()):
        if not name.startswith("test_") or (len(sys.argv) > 3 and name not in sys.argv[3:]):
            continue
        with tempfile.TemporaryDirectory() as folder:
            test(Path(folder))
        print("passed:", test.__doc__.splitlines()[0])


if __name__ == "__main__":
    main()
