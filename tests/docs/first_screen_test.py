"""What a page shows below a command is what the command prints: the README's first screen above all.

first_screen_test.py PROGRAM SOURCE FOLDER [--write] [PAGE...]

A ```text block directly below a ```sh block of one command holds that command's standard output. A line "..." in it stands for lines that
are left out. Figures are compared to the digits printed. Times, memory and residuals differ from machine to machine: any number will do.
They also move the ends of lines, so a paragraph that holds some is compared as one line. Commands are run in FOLDER, in the order of the
page. Without PAGE the page is README.md.

--write puts the real output into the page. A block with "..." keeps its shape: as many lines or paragraphs before the first, behind the
last, and between two of them from the line on that begins with the same word.
"""

import os
import pathlib
import re
import subprocess
import sys

from run_commands import BLOCK, commands_of, prepare, write_to_file

OUTPUT = re.compile(r"\n*```text\n(?P<text>.*?)^```\n", re.DOTALL | re.MULTILINE)
NUMBER = r"[-+]?\d+(?:[.,:]\d+)*(?:e[-+]?\d+)?"
OF_THE_MACHINE = (
    (re.compile(rf"{NUMBER} (ns|us|ms|s|min|h|KB|kB|MB|GB)\b"), r"N \1"),
    (re.compile(rf"(residual[^\s,;]*) {NUMBER}"), r"\1 N"),
    (re.compile(rf"the (springs|finite elements) are {NUMBER} times as fast"), "one is N times as fast"),
    (re.compile(r", (not )?less than the N ms"), ", beside the N ms"),
    (re.compile(r"a step: [^;.]*"), "a step"),  # which rate it keeps
    (re.compile(rf"real time x {NUMBER}"), "real time x N"),
    (re.compile(rf"  (yes|no|-) +{NUMBER}$"), r"  \1  N"),  # milliseconds of a design
    (re.compile(rf"{NUMBER}  as expected"), "N  as expected"),  # seconds of a hard case
    (re.compile(rf"{NUMBER} x the time"), "N x the time"),
    (re.compile(r" {2,}"), "  "),  # columns move with the width of a time
)
# What begins a paragraph with times in it, and how far its other lines are indented.
WITH_TIMES = ((re.compile(r"Verdict: |Use "), " " * 2), (re.compile(r"  (fem|springs|peer) {2,}"), " " * 11))


def normalised(line):
    for pattern, replacement in OF_THE_MACHINE:
        line = pattern.sub(replacement, line)
    return line.strip()


def paragraphs(lines):
    """Lists of lines: those of a paragraph that holds times, else each line by itself."""
    parts, indent = [], None
    for line in lines:
        if indent is not None and line.startswith(indent):
            parts[-1].append(line)
            continue
        parts.append([line])
        indent = next((blanks for begins, blanks in WITH_TIMES if begins.match(line)), None)
    return parts


def joined(lines):
    return [" ".join([part[0], *(line.strip() for line in part[1:])]) for part in paragraphs(lines)]


def printed(folder, command):
    path = f"{folder / 'build'}:{os.environ['PATH']}"  # the program is called as typed, for it prints its name
    done = subprocess.run(["sh", "-c", command.partition(" #")[0]], cwd=folder, env={**os.environ, "PATH": path}, capture_output=True,
                          text=True, timeout=600)
    assert done.stdout or done.stderr, f"{command}: nothing printed"
    return [line.rstrip() for line in done.stdout.splitlines()]


def is_shown_by(shown, output):
    """The first line of a block that the output has not in its place; None where all are there."""
    shown, output = joined(shown), joined(output)
    at, may_skip = 0, False
    for line in shown:
        if line.strip() == "...":
            may_skip = True
            continue
        places = range(at, len(output)) if may_skip else range(at, min(at + 1, len(output)))
        found = next((n for n in places if normalised(output[n]) == normalised(line)), None)
        if found is None:
            return line
        at, may_skip = found + 1, False
    return None if may_skip or at == len(output) else f"(end of the block; the program goes on with) {output[at]}"


def in_the_shape_of(shown, output):
    """The output, with as much left out as the block leaves out."""
    wanted = [[]]  # lists of paragraphs between "..."
    for part in paragraphs(shown):
        if part == ["..."]:
            wanted.append([])
        else:
            wanted[-1].append(part)
    there = paragraphs(output)
    if sum(map(len, wanted)) >= len(there) or len(wanted) == 1:
        return output
    kept, at = there[:len(wanted[0])], len(wanted[0])
    for parts in wanted[1:-1]:
        begin = next((n for n in range(at, len(there)) if there[n][0].split()[:1] == parts[0][0].split()[:1]), at)
        kept += [["..."], *there[begin:begin + len(parts)]]
        at = begin + len(parts)
    kept += [["..."], *there[max(at, len(there) - len(wanted[-1])):]]
    return [line for part in kept for line in part]


def check(folder, page, write):
    """The number of blocks that were compared, and what is wrong with them."""
    text, faults, n_compared = page.read_text(), [], 0
    refreshed, end, last_output = [], 0, text.rfind("```text\n")
    for block in BLOCK.finditer(text):
        if block.start() > last_output:
            break  # nothing is shown of what follows
        if block["file"]:
            write_to_file(folder / block["file"], block["text"])
        if block["kind"] != "sh":
            continue
        lines = [line for line in commands_of(block["text"]) if "# not run by the tests" not in line]
        output = []
        for line in lines:
            if re.match(r"(build/)?springproof |mpirun ", line):
                output += printed(folder, line)
        below = OUTPUT.match(text, block.end())
        if below is None:
            continue
        if len(lines) != 1:
            faults.append(f"{page.name}: {len(lines)} commands above one block of output: {lines}")
            continue
        shown = below["text"].splitlines()
        n_compared += 1
        refreshed += [text[end:below.start("text")], "\n".join(in_the_shape_of(shown, output)) + "\n"]
        end = below.end("text")
        wrong = is_shown_by(shown, output)
        if wrong is not None and not write:
            faults.append(f"{page.name}: {lines[0]}\n  the page has: {wrong}\n  the program prints:\n    " + "\n    ".join(output))
    if write:
        page.write_text("".join(refreshed) + text[end:])
    return n_compared, faults


def check_the_comparison():
    output = ["u_x  0.6711 mm  -3.2 %", "solved in 0.31 s, residual 2e-10", "verdict"]
    assert is_shown_by(output, output) is None
    assert is_shown_by(["u_x  0.6711 mm  -3.2 %", "solved in 12 s, residual 4e-12", "verdict"], output) is None
    assert is_shown_by(["...", "verdict"], output) is None and is_shown_by(["u_x  0.6711 mm  -3.2 %", "..."], output) is None
    assert is_shown_by(["u_x  0.6712 mm  -3.2 %", "..."], output) and is_shown_by(output[:2], output) and is_shown_by([*output, "more"], output)
    assert in_the_shape_of(["a", "...", "b"], output) == [output[0], "...", output[2]] and in_the_shape_of(["a"], output) == output
    rows = ["title", "measure  a", "u_x  1", "Verdict: 2 % in 3 s; the springs", "  are 2 times as fast.", "next", "more"]
    other = ["title", "measure  a", "u_x  1", "Verdict: 2 % in 12.5 s; the", "  finite elements are 7 times as fast.", "next", "more"]
    shape = ["title", "...", "u_x  0", "Verdict: 1 %", "..."]
    assert in_the_shape_of(shape, rows) == ["title", "...", *rows[2:5], "..."]
    assert is_shown_by(in_the_shape_of(shape, rows), other) is None and is_shown_by(["...", "Verdict: 1 % in 3 s", "..."], other)


def main():
    check_the_comparison()
    words = [word for word in sys.argv[1:] if word != "--write"]
    program, source, folder = (pathlib.Path(word).resolve() for word in words[:3])
    pages = [pathlib.Path(word).resolve() for word in words[3:]] or [source / "README.md"]
    write = "--write" in sys.argv
    n_compared, faults = 0, []
    for page in pages:
        prepare(folder, source, program)
        n, wrong = check(folder, page, write)
        n_compared, faults = n_compared + n, faults + wrong
    if n_compared == 0:
        faults.append("no page shows any output")
    print("\n".join(faults) or f"{n_compared} blocks of output {'written' if write else 'are what the program prints'}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
