"""Runs every springproof command of a page's ```sh and ```yaml blocks.

run_commands.py PROGRAM SOURCE PAGE FOLDER

Commands are what a reader types in the project's folder: lines that begin with springproof, build/springproof or mpirun. They
are run in FOLDER, where cases and build/springproof are what they are in the project and nothing else is. A ```toml FILE block is
written to that file, as its reader would. Each command must end with
status 0, or with N where a comment behind it says "exits N". One that takes too long has a comment that begins with "not run by
the tests"; it is shown, so that nobody takes it for tested. Other lines (./do, ctest, awk) are shown as such too. CTest counts a page
without commands as skipped.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import time


def commands_of(block):
    """The lines of a block, continued ones joined, a workflow's `- run: COMMAND` as its command."""
    for line in block.replace("\\\n", " ").splitlines():
        line = line.strip().removeprefix("- run: ")
        if line and not line.startswith("#"):
            yield line


BLOCK = re.compile(r"^ *```(?P<kind>sh|yaml|toml (?P<file>\S+))\n(?P<text>.*?)^ *```\n?", re.DOTALL | re.MULTILINE)


def write_to_file(path, text):
    """What a ```toml FILE block says: from [body] on it replaces what the file has, anything else goes to the end."""
    before = path.read_text()
    if text.startswith("[body]"):
        before = before[:before.index("[body]")]
    path.write_text(before + text)


def prepare(folder, source, program):
    shutil.rmtree(folder, ignore_errors=True)
    (folder / "build").mkdir(parents=True)
    (folder / "build" / "springproof").symlink_to(program)
    (folder / "cases").symlink_to(source / "cases")


def run(line, folder):
    """(whether it was run, whether it failed)"""
    command, _, comment = line.partition(" #")
    comment = comment.strip()
    if not re.match(r"(build/)?springproof |mpirun ", command):
        print(f"no springproof command: {line}")
        return False, False
    if comment.startswith("not run by the tests"):
        print(f"NOT RUN: {line}")
        return False, False
    said = re.search(r"exits (\d)", comment)
    expected = int(said.group(1)) if said else 0
    begin = time.monotonic()
    done = subprocess.run(["sh", "-c", as_run(command)], cwd=folder, capture_output=True, text=True)
    print(f"{done.returncode} after {time.monotonic() - begin:.1f} s: {command}")
    if done.returncode != expected:
        print(f"  FAILED, must be {expected}:\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    return True, done.returncode != expected


def as_run(command):
    return re.sub(r"(?<![/\w])springproof ", "build/springproof ", command)


def main():
    program, source, page, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    prepare(folder, source, program)
    failures = n_run = 0
    for block in BLOCK.finditer(page.read_text()):
        if block["file"]:
            write_to_file(folder / block["file"], block["text"])
        elif not block["kind"].startswith("toml"):
            for line in commands_of(block["text"]):
                ran, failed = run(line, folder)
                n_run, failures = n_run + ran, failures + failed
    print(f"{page.name}: {n_run} commands run, {failures} failed" if n_run else f"{page.name} has no commands: nothing was compared")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
