"""The study of the measured beam: its recordings, what is identified from them, its gates.

usage: real_beam_test.py SPRINGPROOF SOURCE_FOLDER recordings|swings
"""

import json
import pathlib
import re
import subprocess
import sys

PROGRAM, SOURCE, PART = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3]
STUDY = SOURCE / "cases/studies/real_beam"
RECORDINGS = {"gravity": "gravity.csv", "52_g": "gravity_and_0.510_N.csv", "102_g": "gravity_and_1.001_N.csv"}
# Frequencies of the finite elements, errors in percent as README.md has them, to 0.2.
ERRORS = {"gravity": (0.1, 0.5), "52_g": (-2.6, -2.2), "102_g": (-3.8, -3.4)}
faults = []


def check(holds, what):
    if not holds:
        faults.append(what)


def swings(recording):
    """What swings.py says: rest (mm), frequency (Hz)."""
    said = subprocess.run([sys.executable, STUDY / "swings.py", STUDY / recording], capture_output=True, text=True, check=True).stdout
    rest, frequency = re.search(r"rests at (\S+) mm.*?(\S+) Hz", said, re.DOTALL).groups()
    return float(rest), float(frequency)


def gates():
    """Those of the motions, by weight and side, and the exit status."""
    files = [STUDY / f"swing_{weight}.toml" for weight in RECORDINGS]
    done = subprocess.run([PROGRAM, "gate", *files, "--json"], capture_output=True, text=True, check=False)
    assert done.returncode in (0, 1), done.stderr
    found = {}
    for gate in json.loads(done.stdout)["gates"]:
        weight = gate["case"].removeprefix("real-beam-").replace("-", "_")
        found[weight, gate["quantity"]] = gate
    check(len(found) == 6, f"{len(found)} gates, not 6")
    return found, done.returncode


def recordings():
    """Each interval is what it says of the recording, and the material of the motions is what memory.py finds in the first one alone."""
    fitted = subprocess.run([sys.executable, STUDY / "memory.py"], capture_output=True, text=True, check=True).stdout.splitlines()[:2]
    for weight, recording in RECORDINGS.items():
        rest, frequency = swings(recording)
        motion = (STUDY / f"swing_{weight}.toml").read_text()
        check(re.findall(r"^(?:youngs_modulus|prony|\w+_damping) = [^#\n]*[^#\s]", motion, re.MULTILINE) == fitted, f"material of {weight}")
        for text, value, percents in (((STUDY / f"rest_{weight}.toml").read_text(), rest, (3, 5)), (motion, frequency, (4, 6))):
            intervals = re.findall(r"^(fem|msm) = \[(\S+), (\S+)\]", text, re.MULTILINE)
            check([side for side, _, _ in intervals] == ["fem", "msm"], f"expectations of {weight}")
            for (side, *ends), percent in zip(intervals, percents):
                expected = sorted((value * (1 - percent / 100), value * (1 + percent / 100)))
                check(all(float(end) == float(f"{e:.4g}") for end, e in zip(ends, expected)),
                      f"{weight}: {side} in {ends} is not {percent} % about {value}")


def swinging():
    found, status = gates()
    check(status == 0, "the command ends with 0")
    for (weight, side), gate in found.items():
        _, frequency = swings(RECORDINGS[weight])
        error = 100 * (gate["value"] / frequency - 1)
        print(f"{weight}: {side} {gate['value']:.4g} Hz, recorded {frequency:.4g}: {error:+.2f} %")
        check(gate["met"], f"{weight}: {side} {error:+.2f} %")
        if side == "fem":
            low, high = ERRORS[weight]
            check(low < error < high, f"{weight}: finite elements {error:+.2f} %, not as in README.md")


{"recordings": recordings, "swings": swinging}[PART]()
print("\n".join(faults) or "all as the study says")
sys.exit(1 if faults else 0)
