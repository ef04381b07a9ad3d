"""Holds docs/reference against the program.

commands_test.py PROGRAM SOURCE

commands.md has a section for every command that `springproof --help` lists, and its tables list exactly the options of
`springproof COMMAND --help`. json.md names every key that small cases print with `--json`, in the section of the command.
"""

import json
import pathlib
import re
import subprocess
import sys

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])
REFERENCE = SOURCE / "docs" / "reference"

# Command lines that print the keys of json.md, in seconds. A sweep takes minutes, and a hard case needs none of its own.
STATIC = SOURCE / "cases/thesis/linear_elastic/cube_shear_small.toml"
BLOCK = SOURCE / "cases/studies/clamped_block_shear.toml"
MOVING = SOURCE / "cases/studies/released_bar.toml"
GATED = SOURCE / "cases/gates/sheared_cube.toml"
SMALL = ["--set", "body.cells=[4,4,4]"]
SHORT = ["--set", "body.cells=[6,1,1]", "--set", "dynamics.end=0.02"]
DOCUMENTS = {
    "run": [
        [STATIC],
        [BLOCK, "--set", "fem.element=q1_bbar", "--converge"],
        [MOVING, *SHORT, "--converge-time"],
        [STATIC, *SMALL, "--designs", "hybrid,biquadratic,transverse"],
        [STATIC, *SMALL, "--only", "msm", "--set", "msm={design='biquadratic'}"],
        [STATIC, *SMALL, "--only", "msm", "--set", "msm={design='matched'}"],
    ],
    "gate": [[GATED]],
    "design": [["--young", "0.3", "--poisson", "0.3", "--method", "biquadratic"], ["--young", "0.3", "--poisson", "0.3", "--method", "matched"], [BLOCK, "--designs", "hybrid,biquadratic"]],
    "fit": [["--curve", SOURCE / "cases/studies/palpated_cortex/measured.csv", "--strain", "stretch", "--unit", "kPa", "--law", "ogden"]],
    "eigen": [[MOVING, "--modes", "2"], ["--poisson", "0.35", "--body", "2"]],
    "tables": [["4.1"]],
}
# Their values are objects whose keys are names: of measures, of kinds, of references.
NAMED = {"discretisation_error_percent", "errors_percent", "kinds", "error_percent", "other", "other_command", "from_beta_2"}


def output(*words):
    """Standard output of the program; a missed expectation is no matter here."""
    done = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, timeout=300)
    assert done.returncode in (0, 1), f"{words}: {done.stderr}"
    return done.stdout


def sections(page):
    """Text below each heading of second order."""
    parts = re.split(r"^## (.*)$", (REFERENCE / page).read_text(), flags=re.MULTILINE)
    return {heading.strip("`"): text for heading, text in zip(parts[1::2], parts[2::2])}


def documented_options(text):
    """Options in the first column of a section's tables."""
    options = set()
    for line in text.splitlines():
        if line.startswith("| `--"):
            first = re.split(r"(?<!\\)\|", line)[1]
            options.update(re.findall(r"`(--[a-z-]+)", first))
    return options


def keys_of(value):
    if isinstance(value, list):
        return set().union(*map(keys_of, value)) if value else set()
    if not isinstance(value, dict):
        return set()
    keys = set(value)
    for key, inner in value.items():
        if not (key in NAMED and isinstance(inner, dict)):
            keys |= keys_of(inner)
        elif key == "kinds":
            keys |= keys_of(list(inner.values()))
    return keys


def check_commands(missing):
    text = sections("commands.md")
    listed = re.search(r"^Subcommands:\n((?: .*\n)+)", output("--help"), re.MULTILINE).group(1)
    commands = re.findall(r"^ {2}([a-z]+)", listed, re.MULTILINE)
    assert len(commands) > 5, listed
    known = set(commands) | {"What all commands share"}
    missing += [f"commands.md: section of {command}" for command in commands if command not in text]
    missing += [f"the program: command {heading}" for heading in text if heading not in known]
    for command in commands:
        options = set(re.findall(r"^ {2}(?:-[a-zA-Z],)?(--[a-z-]+)", output(command, "--help"), re.MULTILINE)) - {"--help"}
        assert options, command
        documented = documented_options(text.get(command, ""))
        missing += [f"commands.md: {command} {option}" for option in sorted(options - documented)]
        missing += [f"the program: {command} {option}" for option in sorted(documented - options)]
    return len(commands)


def check_keys(missing):
    text = sections("json.md")
    n_keys = 0
    for command, runs in DOCUMENTS.items():
        named = set(re.findall(r"`([^`]+)`", text[command] + text["What all documents share"] + text["run"]))
        keys = set()
        for run in runs:
            printed = keys_of(json.loads(output(command, *run, "--json")))
            assert len(printed) > 4, run
            keys |= printed
        n_keys += len(keys)
        missing += [f"json.md: {command}: {key}" for key in sorted(keys - named)]
    return n_keys


def main():
    missing = []
    n_commands, n_keys = check_commands(missing), check_keys(missing)
    for what in missing:
        print(f"MISSING in {what}")
    print(f"{n_commands} commands and {n_keys} keys of JSON, {len(missing)} missing")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
