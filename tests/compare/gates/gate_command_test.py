"""The command gate and what run leaves behind, as a continuous-integration server meets them.

usage: gate_command_test.py SPRINGPROOF SOURCE_FOLDER

Exit states, JUnit, annotations, blessing, kill -9 in the midst of --out, and two MPI ranks. Only Python's standard library and
xmllint are used.
"""

import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROGRAM, SOURCE = (str(Path(argument).resolve()) for argument in sys.argv[1:3])
CASES = Path(SOURCE) / "cases"
EXACT, CUBE = CASES / "gates/uniaxial_exact.toml", CASES / "gates/sheared_cube.toml"


def springproof(*words, launcher=(), **options):
    """Runs the program; its words may be paths and numbers."""
    command = [*launcher, PROGRAM, *map(str, words)]
    return subprocess.run(command, capture_output=True, text=True, timeout=600, **options)


def test_exit_states(folder):
    """0 when all gates are met, 1 when one is not or a case expects nothing, 2 for wrong input."""
    met = springproof("gate", EXACT)
    assert met.returncode == 0, met
    lines = met.stdout.splitlines()
    assert len(lines) == 5 and all(line.startswith("met    exact") for line in lines[:4]), met.stdout
    missed = springproof("gate", EXACT, "--set", "load[0].value=[0,0,0.06]")
    assert missed.returncode == 1 and missed.stdout.count("FAILED exact") == 4, missed
    nothing = springproof("gate", EXACT, "--set", "expect=[]")
    assert nothing.returncode == 2, nothing  # an empty list is no list of tables
    silent = folder / "silent.toml"
    silent.write_text(EXACT.read_text().split("[[expect]]")[0])
    assert springproof("gate", silent).returncode == 1
    for words in (["gate"], ["gate", "/no/such.toml"], ["gate", EXACT, "--set", "measure[0].node=near 9 9 9"],
                  ["gate", EXACT, "--set", "bdoy=1"], ["gate", EXACT, "--bless", "nobody"],
                  ["gate", EXACT, "--bless", "uniaxial-exact"],
                  ["gate", CUBE, "--bless", "sheared-cube", "--set", "fem.refine=0"]):
        wrong = springproof(*words)
        assert wrong.returncode == 2 and not wrong.stdout and wrong.stderr, (words, wrong)


def test_one_side(folder):
    """What needs a side that was not asked for is not judged, what does not is; the gates are not met by it."""
    for only, other in (("msm", "fem"), ("fem", "msm")):
        done = springproof("run", CUBE, "--only", only)
        assert done.returncode == 0 and done.stdout.count("not judged") == 4 and done.stdout.count(f"{other} was not asked for") == 4, done
        judged = json.loads(springproof("run", CUBE, "--only", only, "--json").stdout)["cases"][0]["expectations"]
        assert [one["judged"] for one in judged] == [one["quantity"] == only for one in judged], judged
        assert [one["met"] for one in judged] == [one["judged"] for one in judged], judged
        missed = springproof("run", CUBE, "--only", only, "--set", "expect[1].fem=[1,2]", "--set", "expect[2].msm=[1,2]")
        assert missed.returncode == 1 and missed.stdout.count("MISSED") == 1, missed
    refused = springproof("gate", CUBE, "--only", "msm")
    assert refused.returncode == 2 and not refused.stdout, refused  # gates are of whole cases


def test_machine_formats(folder):
    """JUnit is valid, JSON stands alone, annotations go where they do not disturb."""
    junit = folder / "deep" / "gates.xml"
    done = springproof("gate", EXACT, CUBE, "--set", "material.poissons_ratio=0.3", "--junit", junit, "--json", "--annotate")
    assert done.returncode == 1, done
    document = json.loads(done.stdout)
    assert not document["met"] and len(document["gates"]) == 10, document
    assert {gate["reference"] for gate in document["gates"]} == {"exact", "regression"}
    assert "::error file=" in done.stderr and "::" not in done.stdout
    schema = Path(SOURCE) / "tests/compare/gates/junit.xsd"
    subprocess.run(["xmllint", "--noout", "--schema", schema, junit], check=True, capture_output=True)
    text = springproof("gate", CUBE, "--set", "fem.element=q1", "--annotate")
    errors = re.findall(r"^::error file=(.*?),line=(\d+),title=.*?::alpha", text.stdout, re.M)
    lines = CUBE.read_text().splitlines()
    assert errors and all(file == str(CUBE) and lines[int(line) - 1] == "[[expect]]" for file, line in errors), text.stdout


def test_converged(folder):
    """An expectation of a converged reference shows the error bar; a narrow interval warns and is judged as it is."""
    case = CASES / "gates/sheared_block.toml"
    coarse = ["--set", "fem.refine=0", "--set", "expect[1].error_percent=[-9,1]", "--set", "expect[2].error_percent=[-4,-3.9]"]
    gates = json.loads(springproof("gate", case, *coarse, "--json").stdout)["gates"]
    assert gates and all(gate["reference_uncertainty"] > 0 for gate in gates), gates
    assert "narrower" in gates[2]["warning"] and not gates[2]["met"], gates[2]
    plain = json.loads(springproof("gate", CUBE, "--json").stdout)["gates"]
    assert plain and all(gate["reference_uncertainty"] is None for gate in plain)


def test_blessing(folder):
    """Only what is named is blessed, the difference is shown, and the rest of the file stays."""
    case = folder / "cube.toml"
    text = re.sub(r"msm = \[.*?\]", "msm = [1.00, 1.02] # moved", CUBE.read_text(), count=1)
    case.write_text(text)
    assert springproof("gate", case).returncode == 1 and case.read_text() == text
    blessed = springproof("gate", case, "--bless", "sheared-cube")
    assert blessed.returncode == 0, blessed
    changed = [(a, b) for a, b in zip(text.splitlines(), case.read_text().splitlines()) if a != b]
    assert len(changed) == 1 and changed[0][1].endswith("# moved"), changed
    assert f"-{changed[0][0]}\n+{changed[0][1]}\n" in blessed.stdout
    assert springproof("gate", case).returncode == 0


def test_external(folder):
    """Another program's file is judged as our springs are; ours read back give our own numbers."""
    case, theirs = CASES / "external/pulled_bar.toml", CASES / "external/pulled_bar.csv"
    assert springproof("gate", case, "--msm-displacements", theirs).returncode == 0
    written = subprocess.run([sys.executable, CASES / "external/independent_springs.py"], capture_output=True, text=True, check=True)
    numbers = [[[float(x) for x in line.split(",")] for line in text.splitlines()[1:]] for text in (written.stdout, theirs.read_text())]
    assert all(abs(a - b) < 1e-11 for new, old in zip(*numbers) for a, b in zip(new, old)) and len(numbers[0]) == len(numbers[1]) == 45
    assert springproof("run", case, "--out", folder / "out").returncode == 0
    ours = json.loads(springproof("run", case, "--json").stdout)["cases"][0]
    again = json.loads(springproof("run", case, "--json", "--msm-displacements", folder / "out/pulled-bar.vtu").stdout)["cases"][0]
    assert again["measures"] == ours["measures"] and again["msm"]["source"].endswith("pulled-bar.vtu")
    half = folder / "half.csv"
    half.write_text("".join(theirs.read_text().splitlines(True)[:20]))
    refused = springproof("run", case, "--msm-displacements", half)
    assert refused.returncode == 2 and "has 19 of the 45 nodes" in refused.stderr and not refused.stdout, refused
    drifting = folder / "drifting.csv"
    drifting.write_text(theirs.read_text().replace(",0.4401", ",0.4402"))
    assert springproof("gate", case, "--msm-displacements", drifting).returncode == 1


def check_whole(out):
    """Every file that has its final name is whole."""
    for file in out.rglob("*"):
        if file.is_dir() or "springproof-part" in file.name:
            continue
        content = file.read_bytes()
        if file.suffix == ".json":
            json.loads(content)
        elif file.suffix == ".vtu":
            assert content.endswith(b"</VTKFile>\n"), file
        elif file.suffix == ".csv":
            assert content.endswith(b"\n") and all(row.count(b",") == 14 for row in content.splitlines()), file
        else:
            assert file.parent.name == "solved" and len(content) > 1000, file


def copies_of_a_case(folder, n):
    files = []
    for k in range(n):
        files.append(folder / f"case{k}.toml")
        files[-1].write_text(CUBE.read_text().replace('"sheared-cube"', f'"cube-{k}"'))
    return files


def test_kill_during_out(folder):
    """kill -9 at any moment leaves whole files alone, and the next run solves the missing cases only."""
    files = copies_of_a_case(folder, 4)
    for command in ("run", "gate"):
        out = folder / command
        survived = 0
        while True:  # killed as soon as it has finished one case more
            process = subprocess.Popen([PROGRAM, command, *map(str, files), "--out", str(out)],
                                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            while process.poll() is None and len(solved_in(out)) <= survived:
                time.sleep(0.002)
            process.send_signal(signal.SIGKILL)
            _, messages = process.communicate()
            check_whole(out)
            assert messages.count("solved already") <= survived, messages
            if len(solved_in(out)) == len(files):
                break
            assert len(solved_in(out)) > survived
            survived = len(solved_in(out))
        last = springproof(command, *files, "--out", out)
        assert last.returncode == 0 and last.stderr.count("solved already") == 4, last
        check_whole(out)
        assert len(json.loads((out / "results.json").read_text())["cases"]) == 4
        files[1].write_text(files[1].read_text().replace('description = "', 'description = "Again: '))
        assert springproof(command, *files, "--out", out).stderr.count("solved already") == 3
        assert "solved already" not in springproof(command, *files, "--out", out, "--set", "material.poissons_ratio=0.48").stderr


def solved_in(out):
    return [file for file in out.glob("solved/*") if "springproof-part" not in file.name]


def told(answer):
    """The lines that neither times nor --out change: of run the cases, their bodies and loads, the rows of measures, the expectations."""
    without_verdict = re.sub(r"^Verdict: .*?^What to type next:$", "", answer.stdout, flags=re.DOTALL | re.MULTILINE)
    lines = [line.split(",")[0].split("converged")[0] for line in without_verdict.splitlines()]
    if "run" in answer.args:
        lines = [line for line in lines if re.match(r"[a-z-]+: |  (body|loads|measure|met) |  \w+ +\w+ +-?[\d.]+ ", line)]
    return lines


def test_two_ranks(folder):
    """mpirun -n 2: the same verdicts and numbers, and the text once."""
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")
    launcher = ["mpirun", "--oversubscribe", "-n", "2"]
    for command in ("run", "gate"):
        alone = springproof(command, EXACT, CUBE)
        both = springproof(command, EXACT, CUBE, "--out", folder / command, launcher=launcher, env=environment)
        assert both.returncode == 0, both
        assert len(told(alone)) > 6 and told(both) == told(alone), (alone, both)
        again = springproof(command, EXACT, CUBE, "--out", folder / command, launcher=launcher, env=environment)
        assert again.returncode == 0 and again.stderr.count("solved already") == 2, again
    assert springproof("gate", CUBE, "--set", "fem.element=q1", launcher=launcher, env=environment).returncode == 1
    # Rank 0 alone finds that it cannot write: the other one must not wait for ever.
    file = folder / "file"
    file.write_text("in the way")
    sweep = ["sweep", "--quick", Path(SOURCE) / "tests/compare/sweep/tiny.toml", "--out", file / "below"]
    for words in (sweep, ["run", EXACT, "--out", file / "below"], ["run", "no-such.toml"]):
        stuck = springproof(*words, launcher=launcher, env=environment)
        assert stuck.returncode == 2 and stuck.stderr.count(str(words[-1])) >= 1, (words, stuck)


def main():
    for name, test in list(globals().items()):
        if not name.startswith("test_") or (len(sys.argv) > 3 and name not in sys.argv[3:]):
            continue
        with tempfile.TemporaryDirectory() as folder:
            test(Path(folder))
        print("passed:", test.__doc__.splitlines()[0])


if __name__ == "__main__":
    main()
