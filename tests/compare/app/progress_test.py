"""What a long command says while it works: a line on a terminal, nothing into a pipe; and what is too large is refused.

usage: progress_test.py SPRINGPROOF SOURCE_FOLDER

A terminal is a pseudo-terminal of Python's standard library.
"""

import fcntl
import os
import pty
import re
import struct
import subprocess
import sys
import tempfile
import termios
from pathlib import Path

PROGRAM, SOURCE = (str(Path(argument).resolve()) for argument in sys.argv[1:3])
SHEAR = f"{SOURCE}/cases/sweep/cube_shear.toml"
TINY = f"{SOURCE}/tests/compare/sweep/tiny.toml"
# Each takes longer than the first drawing's 0.3 s on any machine.
LONG_RUN = ["--set", "body.cells=[30,30,30]", "--set", "fem.accuracy=none"]
COMMANDS = {
    "run": ["run", SHEAR, *LONG_RUN],
    "gate": ["gate", f"{SOURCE}/cases/gates/sheared_cube.toml", "--set", "fem.refine=2"],
    "tables": ["tables", "5.12"],
    "stress": ["stress", "torsion_90"],
    "sweep": ["sweep", "--quick", TINY],
}
LINE = re.compile(r"\r\[[# ]{20}\] \d+ of \d+, (about \d+:\d\d|not long) left, \S")


def on_a_terminal(words, columns=100):
    """Standard output through a pipe, standard error on a terminal of that width."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 25, columns, 0, 0))
    process = subprocess.Popen([PROGRAM, *words], stdout=subprocess.PIPE, stderr=theirs)
    os.close(theirs)
    said = b""
    while True:
        try:
            block = os.read(ours, 4096)
        except OSError:  # Linux' end of a pseudo-terminal
            break
        said += block
    out, _ = process.communicate(timeout=600)
    os.close(ours)
    return process.returncode, out.decode(), said.decode()


def test_commands(folder):
    """run, gate, tables, stress and sweep show one line and take it away; a pipe gets nothing of it."""
    for name, words in COMMANDS.items():
        status, out, said = on_a_terminal(words)
        assert LINE.search(said), (name, status, said)
        drawn = [part for part in re.split(r"[\r\n]+", said) if part.startswith("[")]
        assert all(len(part) < 100 for part in drawn), drawn
        after = said[said.rindex("["):]
        assert re.search(r"\r +\r", after), (name, after)  # taken away
        assert "left, " not in out and "[#" not in out, (name, out)
        piped = subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=600)
        assert piped.returncode == status and "left, " not in piped.stderr and "\r" not in piped.stderr, (name, piped.stderr)
    assert "sweep" in COMMANDS and "variants, about" in said and "springs hybrid" in said, said  # the last one's plan


def test_width_and_names(folder):
    """The line is narrow on a narrow terminal, and is not cut within a character."""
    for columns in (40, 41):  # the name's characters are of two bytes
        case = folder / "case.toml"
        case.write_text(Path(SHEAR).read_text().replace('name = "sweep-cube-shear"', f'name = "{"ü" * 40}"', 1))
        status, _, said = on_a_terminal(["run", str(case), *LONG_RUN], columns)
        assert status == 0 and LINE.search(said) is None and "0 of 1" in said, said
        assert all(len(part.encode()) < columns for part in said.split("\r")), said


def test_names_are_data(folder):
    """A name that a terminal would take for a command is shown, not obeyed."""
    case = folder / "case.toml"
    case.write_text(Path(SHEAR).read_text().replace('name = "sweep-cube-shear"', r'name = "\u009b2J"', 1))
    status, _, said = on_a_terminal(["run", str(case), *LONG_RUN])
    assert status == 0 and LINE.search(said) and r"left, \x9b2J" in said and "\x9b" not in said, said


def refused(words, said, before=()):
    done = subprocess.run([*before, PROGRAM, *words], capture_output=True, text=True, timeout=600)
    assert done.returncode == 2 and not done.stdout and done.stderr.count("\n") == 1, (words, done)
    for word in said:
        assert word in done.stderr, (word, done.stderr)


def test_memory(folder):
    """What needs more memory than the machine or the process has is refused before it is solved, in one line."""
    huge = ["--set", "fem.refine=7"]
    for words in (["run", SHEAR, *huge], ["gate", f"{SOURCE}/cases/gates/sheared_cube.toml", *huge],
                  ["run", SHEAR, "--set", "body.cells=[800,800,800]"],
                  ["gate", SHEAR, *huge, "--shard", "1/2", "--out", folder / "shard"]):
        refused(words, ["unknowns", "GB of memory", "fewer cells", ".toml: finite elements"])
    limited = ["prlimit", "--as=2000000000"]
    refused(["run", SHEAR, "--set", "fem.refine=5"], ["ulimit -v leaves 1."], limited)
    refused(["run", SHEAR, "--only", "msm", "--set", "body.cells=[200,200,200]"], ["springs (matrix-free)", "ulimit -v"], limited)
    small = subprocess.run([*limited, PROGRAM, "run", SHEAR], capture_output=True, text=True, timeout=600)
    assert small.returncode == 0 and not small.stderr, small
    heavy = folder / "heavy.toml"
    heavy.write_text((Path(SOURCE) / "cases/hard/million_nodes.toml").read_text())
    refused(["stress", heavy], ["springs"], ["prlimit", "--as=900000000"])


def main():
    for name, test in list(globals().items()):
        if not name.startswith("test_") or (len(sys.argv) > 3 and name not in sys.argv[3:]):
            continue
        with tempfile.TemporaryDirectory() as folder:
            test(Path(folder))
        print("passed:", test.__doc__.splitlines()[0])


if __name__ == "__main__":
    main()
