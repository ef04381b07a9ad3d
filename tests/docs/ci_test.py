"""The recipes of examples/ci/, run line by line in a folder that is laid out as a user's repository.

usage: ci_test.py SPRINGPROOF SOURCE_FOLDER

The program and Debian's python3 with numpy are on PATH; apt-get is a script that asks for the package's file alone.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import yaml

PROGRAM, SOURCE = (Path(argument).resolve() for argument in sys.argv[1:3])
APT_GET = """#!/bin/sh
case "$1" in
  update) ;;
  install) for word; do file=$word; done; test -f "$file" ;;
  *) exit 1 ;;
esac
"""


def github(recipe):
    """Environment, commands, and the file that is uploaded, whatever the gates say."""
    [job] = recipe["jobs"].values()
    assert recipe[True] == ["push", "pull_request"], recipe  # YAML 1.1 reads "on" as true
    [upload] = [step for step in job["steps"] if step.get("uses", "").startswith("actions/upload-artifact@")]
    assert upload["if"] == "always()"
    lines = [line for step in job["steps"] for line in step.get("run", "").splitlines()]
    return job["env"], lines, upload["with"]["path"]


def gitlab(recipe):
    """The same."""
    artifacts = recipe["gates"]["artifacts"]
    assert artifacts["when"] == "always"
    return recipe["variables"], recipe["gates"]["script"], artifacts["reports"]["junit"]


def outcomes(folder, variables, lines):
    path = {"PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}
    return [subprocess.run(["sh", "-ec", line], cwd=folder, env={**os.environ, **variables, **path}, capture_output=True, text=True, timeout=600)
            for line in lines]


def check(name, parse):
    recipe = yaml.safe_load((SOURCE / "examples/ci" / name).read_text())
    variables, lines, junit = parse(recipe)
    with tempfile.TemporaryDirectory() as there:
        folder = Path(there)
        for part in ("bin", "springs", "tools"):
            (folder / part).mkdir()
        (folder / "bin/springproof").symlink_to(PROGRAM)
        (folder / "bin/python3").symlink_to("/usr/bin/python3")
        (folder / "bin/apt-get").write_text(APT_GET)
        (folder / "bin/apt-get").chmod(0o755)
        shutil.copy(SOURCE / "examples/ci/tissue.toml", folder / "springs")
        client = folder / "springs/client.py"
        shutil.copy(SOURCE / "examples/clients/verlet.py", client)
        # Without the package nothing may look installed.
        assert [done.returncode for done in outcomes(folder, variables, lines[:2])] == [0, 1], name
        (folder / variables["SPRINGPROOF_DEB"]).write_text("")
        done = outcomes(folder, variables, lines)
        if "cannot confine a program" in " ".join((done[-1].stdout + done[-1].stderr).split()):
            sys.exit("clients cannot be confined where the system refuses namespaces: the test is skipped")
        assert [one.returncode for one in done] == [0, 0, 0], (name, done)
        assert "all gates met: requirement 2 of 2" in done[-1].stdout, done[-1]
        schema = SOURCE / "tests/compare/gates/junit.xsd"
        subprocess.run(["xmllint", "--noout", "--schema", schema, folder / junit], check=True, capture_output=True)
        # A change of the client that makes its springs softer fails the build, and the verdicts are there.
        text = client.read_text()
        assert text.count("springs[:, 2:3]") == 1
        client.write_text(text.replace("springs[:, 2:3]", "0.5 * springs[:, 2:3]"))
        missed = outcomes(folder, variables, lines)[-1]
        assert missed.returncode == 1 and "FAILED requirement" in missed.stdout, missed
        assert "<failure" in (folder / junit).read_text()
    print(f"passed: {name}")


if __name__ == "__main__":
    check("github-actions.yml", github)
    check("gitlab-ci.yml", gitlab)
