"""Attempts to make the program run something, write somewhere, crash, hang or answer wrongly, new ones with every seed.

usage: attempts.py SPRINGPROOF SOURCE_FOLDER COUNT [SEED [KIND ...]]

Kinds: keys, files, options, names, limits, links, folders, geometries, environment, same. Each attempt has a folder of its own with an `out`.
It is a fault when it ends by a signal or in another exit status than 0, 1 or 2, takes more than 60 s (LIMIT_SECONDS), makes or changes a file
outside `out`, leaves a temporary file, makes a file PWNED anywhere, ends in 2 without a line or in 0 with a number that is none; when a table
whose rows are not all numbers is taken; and, in `same`, when a turned, mirrored, scaled or renumbered case has another answer in either model
than the first. What offends is left in the folder that is named. Only Python's standard library and prlimit are used.
"""

import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import attempts_same
import mutated_files

PROGRAM, SOURCE = (Path(argument).resolve() for argument in sys.argv[1:3])
LIMIT_SECONDS = float(os.environ.get("LIMIT_SECONDS", 60))
ODD_NUMBERS = ["0", "-1", "-0", "1e-300", "5e-324", "1e300", "1e308", "nan", "-nan", "inf", "-inf", "1e400", "2147483648", "-2147483649", "4294967296",
               "99999999999999999999", "0x10", "1_000", "1,5", "1.5mm", "", " ", "1e", "true", "'x'", "[]", "{}", "[1, 2]", "0.5", "3", "1e-9", "1e9"]
HOSTILE = ["<touch PWNED", "|touch PWNED", "$(touch PWNED)", "`touch PWNED`", "; touch PWNED;", "'; system 'touch PWNED'; x='", "''; !touch PWNED",
           "%s%n%x%d", "{}{0}{:9999999999}", "<script>alert(1)</script>", "<img src=x onerror=alert(1)>", "&lt;b&gt;", "]]>", "=cmd|'/c x'!A1", "@SUM(A1)",
           "+1", "-e", "--out", "a\\u202eb", "a\\u0007b", "a\\u001b[2Jb", "::add-mask::x", "##[group]x", "$DATA", "@macro", "\\\\n", "nul", "CON", "a b", "ä€𝄞",
           "x_{y}^{z}", "*STEP", "{/Symbol a}", "a'b", "''", "_", "~", "*", "?", "a:b", "%(x)s", "${HOME}", "\\uffff", "é" * 60, "x" * 199, "#", ".", "..", "a/b"]

CASE = """schema = 1
name = "attempt"
description = "x"
[body]
shape = "box"
size = [2, 2, 2]
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
value = [0, 0.002, 0]
[fem]
accuracy = "none"
[msm]
design = "hybrid"
[[measure]]
name = "u"
kind = "displacement"
node = "z+ x+ y+"
component = "y"
[[measure]]
name = "volume"
kind = "volume"
"""
EXTRAS = ["", '[[region_material]]\naxis = "z"\nfrom = 1\nmodel = "linear_elastic"\nyoungs_modulus = 1\npoissons_ratio = 0.4\n',
          '[[moved]]\nregion = "z+"\nangle = 20\naxis = "z"\ncentre = [1, 1, 2]\n', '[[symmetry]]\nplane = "x-"\n',
          '[[load]]\nregion = "z+"\nkind = "torque"\nvalue = 0.003\naxis = "z"\ncentre = [1, 1, 2]\n',
          '[[load]]\nnear = [1, 1, 2]\nradius = 1\nkind = "traction"\nvalue = [0, 0, -0.001]\n', '[[landmark]]\nname = "l"\npoint = [1, 1, 2]\n',
          '[[expect]]\nmeasure = "u"\nmsm = [0, 1]\nreference = "exact"\nreason = "r"\n']


class Attempt:
    """A folder of its own, what is run in it, and what is wrong afterwards."""

    def __init__(self, place):
        self.place, self.wrong, self.done, self.words = place, "", None, []
        for name in ("in", "tmp", "home"):
            (place / name).mkdir(parents=True)
        (place / "canary").write_text("untouched")
        self.out = place / "out"

    def write(self, name, content):
        path = self.place / "in" / name
        path.write_bytes(content if isinstance(content, bytes) else content.encode(errors="surrogatepass"))
        return path

    def run(self, *words, prefix=(), variables=None, statuses=(0, 1, 2), ends_confined=False):
        """@param ends_confined  whether a process that reads a file may end without an answer: a geometry is a program"""
        before = self.seen()
        environment = {**os.environ, "HOME": str(self.place / "home"), "TMPDIR": str(self.place / "tmp"), "OPENBLAS_NUM_THREADS": "1", **(variables or {})}
        self.words = [*prefix, str(PROGRAM), *map(str, words)]
        process = subprocess.Popen(self.words, cwd=self.place / "in", env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, start_new_session=True)
        try:
            out, error = process.communicate(timeout=LIMIT_SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.communicate()
            self.wrong = f"takes more than {LIMIT_SECONDS:g} s"
            return None
        self.done = done = subprocess.CompletedProcess(self.words, process.returncode, out, error)
        said = error.decode(errors="replace")
        if done.returncode not in statuses:
            self.wrong = f"exit status {done.returncode}"
        elif done.returncode == 2 and not said.strip():
            self.wrong = "refused without a word"
        elif "internal error" in said or any(words in error for words in mutated_files.FOUND[:2 if ends_confined else 3]):
            self.wrong = "a fault in the program"
        elif any(c < 32 and c not in (9, 10) for c in error):
            self.wrong = "a control character is printed"
        if changed := {path: now for path, now in self.seen().items() if before.get(path) != now} or set(before) - set(self.seen()):
            self.wrong = f"outside --out: {sorted(map(str, changed))[:3]}"
        if self.out.is_dir() and list(self.out.rglob("*.springproof-part")):
            self.wrong = "leaves what is half written"
        if list(self.place.rglob("*PWNED")) and any(path.name == "PWNED" for path in self.place.rglob("*PWNED")):
            self.wrong = "runs a command"
        return done

    def seen(self):
        """All outside of --out."""
        found = {}
        for path in self.place.rglob("*"):
            if path == self.out or self.out in path.parents:
                continue
            status = path.lstat()
            found[path] = (status.st_mode, status.st_size, status.st_mtime_ns if not path.is_dir() else 0)
        return {**found, **{path: 0 for path in Path("/").iterdir()}}

    def check_numbers(self):
        """An answer in JSON has numbers, or says why it has none."""
        if self.wrong or self.done is None or self.done.returncode != 0:
            return
        try:
            document = json.loads(self.done.stdout, parse_constant=lambda word: self.flag(f"{word} in JSON"))
        except ValueError as error:
            return self.flag(f"no JSON: {error}")
        for case in document.get("cases", []):
            for measure in case["measures"]:
                for side in ("fem", "msm"):
                    if measure[side] is None and case[side]["status"] == "converged" and not measure.get(f"{side}_reason"):
                        self.flag(f"no value of {measure['name']}, and no reason")

    def flag(self, what):
        self.wrong = self.wrong or what


def mutated_case(chance):
    text = CASE + "".join(chance.sample(EXTRAS, chance.randrange(4)))
    if chance.randrange(3) == 0:
        text = text.replace("poissons_ratio = 0.3\n", "poissons_ratio = 0.3\ndensity = 1000\n", 1).replace('angle = 20', 'history = { ramp = [0, 0.004] }\nangle = 20')
        text += '[dynamics]\nscheme = "newmark"\nstep = 0.001\nend = 0.006\n'
    for _ in range(chance.choice([1, 1, 1, 2, 3])):
        kind = chance.choice([0, 0, 0, 0, 1, 1, 2, 2, 3, 4])
        numbers, words, lines = list(re.finditer(r"(?<![\w.\"])-?\d[\d.e-]*", text)), list(re.finditer(r'(?<=")[^"\n]+(?=")', text)), text.splitlines()
        if kind <= 1 and numbers:
            found, new = chance.choice(numbers), chance.choice(ODD_NUMBERS)
            if kind == 0 or chance.randrange(3) == 0:
                new = f"{float(re.match(r'-?[0-9.]*', found[0])[0] or 0) * chance.choice([-1, 1e-6, 0.1, 0.5, 2, 10, 1e6]):g}"
        elif kind == 2 and words:
            found, new = chance.choice(words), chance.choice([*HOSTILE, *(word[0] for word in words)]).replace('"', "")
        elif kind == 3 and (keys := list(re.finditer(r"^\w+(?= =)", text, re.M))):
            found, new = chance.choice(keys), chance.choice([key[0] for key in keys] + ["unit", "units", "Size", "x" * 300])
        else:
            line = chance.randrange(len(lines))
            lines[line:line + 1] = chance.choice([[], [lines[line]] * 2, [lines[line] + " mm"], [chance.choice(lines), lines[line]]])
            text = "\n".join(lines) + "\n"
            continue
        text = text[:found.start()] + new + text[found.end():]
    times = {key: re.search(rf"^{key} = ([\d.e-]+)$", text, re.M) for key in ("step", "end")}
    if all(times.values()) and not float(times["end"][1]) <= 1e4 * float(times["step"][1]):
        return mutated_case(chance)  # millions of steps take their time
    return text


def keys(attempt, chance):
    path = attempt.write("case.toml", mutated_case(chance))
    attempt.run("run", "--json", *chance.choice([[], ["--only", "msm"], ["--out", attempt.out]]), path)
    attempt.check_numbers()


def are_rows_of_numbers(content, has_heading):
    """Python's own reading of a table."""
    rows = [line.strip() for line in content.decode("utf-8-sig", errors="replace").split("\n")]
    rows = [row for row in rows if row and not row.startswith("#")][1 if has_heading else 0:]
    finite = re.compile(r"\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*")
    return all(finite.fullmatch(field) and abs(float(field)) < float("inf") for row in rows for field in row.split(",") if field.strip())


def files(attempt, chance):
    name = chance.choice([kind for kind in mutated_files.KINDS if kind != "kept"])
    mutated_files.springproof = lambda *words: attempt.run(*words)
    attempt.out = attempt.place / "in"  # these kinds have their files there
    subject = mutated_files.KINDS[name](attempt.place / "in")
    whole = subject.whole
    content = getattr(subject, "damaged", mutated_files.damaged)(whole, chance)
    done = subject.given(content)
    if done and done.returncode == 0 and name in ("network", "displacements") and not are_rows_of_numbers(content, name == "displacements" or content[:1].isalpha()):
        attempt.flag("a table with what is no number is taken")
    attempt.words.append(f"({name})")


NUMBER_OPTIONS = {"design": ["--young", "--poisson", "--edge", "--split", "--neo-hookean", "--largest-strain", "--ogden-mu", "--ogden-alpha", "--yeoh"],
                  "eigen": ["--young", "--poisson", "--edge", "--split", "--body", "--modes"], "run": ["--converge"], "gate": ["--workers", "--converge"],
                  "sweep": ["--budget"], "interact": ["--seconds", "--port", "--stiffness", "--spheres", "--threads"], "stress": ["--threads"], "tables": ["--workers"]}


def options(attempt, chance):
    path = attempt.write("case.toml", CASE)
    command = chance.choice(list(NUMBER_OPTIONS) + ["run", "set", "design"])
    if command == "set":
        keys_of = re.findall(r"^\w+(?= =)", CASE, re.M)
        key = chance.choice(["body.", "material.", "load[0].", "fixed[0].", "msm.", "fem.", "measure[9].", "", "a.b.c.", "load[99999999].", "load[-1]."]) + chance.choice(keys_of)
        return attempt.run("run", "--json", path, "--set", f"{key}={chance.choice(ODD_NUMBERS + HOSTILE)}")
    words = [command, chance.choice(NUMBER_OPTIONS[command]), chance.choice(ODD_NUMBERS + HOSTILE[:12])]
    given = {"design": ["--young", "0.3", "--poisson", "0.3"], "eigen": [], "run": [path], "gate": [path], "sweep": ["--quick", path],
             "interact": [path], "stress": ["no-such-case"], "tables": ["4.9"]}[command]
    if command == "sweep":
        words[2] = chance.choice([word for word in ODD_NUMBERS if word not in ("3", "1e9", "0.5", "1_000", "0x10", "4294967296", "2147483648")] + HOSTILE[:5])
    if command == "interact":
        given = ["--seconds", "0.2", *given]
    if words[1] in given:
        given = [word for word in given if word not in (words[1], "0.2")]
    attempt.run(*words, *given)


def names(attempt, chance):
    text = CASE + EXTRAS[6] + EXTRAS[7]
    for old in chance.sample(['"attempt"', 'description = "x"', '"u"', '"volume"', '"l"', '"r"'], chance.randint(1, 3)):
        word = chance.choice(HOSTILE) + chance.choice(["", "", "x", " PWNED", chance.choice(HOSTILE)])
        if "=" in old:
            text = text.replace(old, f'description = "{word}"')
        else:
            text = text.replace(old, f'"{chance.choice(["", "a"]) + word}"')
    path = attempt.write("case.toml", text)
    command = chance.choice([["run", "--report"], ["run", "--report"], ["run"], ["gate", "--annotate", "--junit", attempt.out / "j.xml"], ["export", "--to", "sofa"], ["export", "--to", "csv"]])
    attempt.run(*command, path, "--out", attempt.out)
    for page in attempt.out.rglob("*.html") if attempt.out.is_dir() else []:
        if re.search(r"<script>alert|<img src=x", page.read_text(errors="replace")):
            attempt.flag("markup on a page")
    for table in attempt.out.rglob("*.csv") if attempt.out.is_dir() else []:
        if re.search(r"(^|,)\"?[=@]", table.read_text(errors="replace"), re.M):
            attempt.flag("a formula in a table")


def limits(attempt, chance):
    path = attempt.write("case.toml", CASE.replace("cells = [2, 2, 2]", "cells = [4, 4, 4]"))
    limit = chance.choice([f"--fsize={chance.randint(0, 200_000)}", f"--as={chance.randint(100, 900) * 2 ** 20}", f"--nofile={chance.randint(3, 40)}",
                           f"--stack={chance.randint(512, 8000) * 1024}", f"--data={chance.randint(50, 600) * 2 ** 20}"])
    # 127: the program's libraries did not fit, and the loader said so.
    low = limit.startswith(("--as", "--nofile", "--stack", "--data"))
    words = chance.choice([["run", path, "--out", attempt.out], ["gate", path, "--out", attempt.out], ["run", "--report", path, "--out", attempt.out],
                           ["design", "--young", "0.3", "--poisson", "0.3", "--out", attempt.out]])
    attempt.run(*words, prefix=("prlimit", limit), statuses=(0, 1, 2, 127) if low else (0, 1, 2))


def links(attempt, chance):
    place = attempt.place / "in"
    target = chance.choice(["/dev/zero", "/dev/null", "/dev/full", "/dev/stdin", "/dev/urandom", "/etc/passwd", "/proc/no/such", "loop", ".", "/", "fifo", "/proc/self/mem", str(attempt.place / "canary")])
    kind = chance.choice(["case.toml", "springs.csv", "given.csv", "given.vtu", "body.msh", "body.geo", "body.stl", "body.nii", "pulls.csv", "curve.csv", "skin.vtp", "out", "kept", "result", "junit"])
    path = attempt.write("case.toml", CASE)

    def put(at):
        at.unlink(missing_ok=True)
        if target == "fifo":
            os.mkfifo(at)
        else:
            at.symlink_to(at.name if target == "loop" else target)
    body = lambda shape: path.write_text(re.sub(r'shape = .*\nsize.*\ncells.*', shape, CASE))
    words = ["run", "--only", "msm", path]
    if kind in ("out", "kept", "result", "junit"):
        attempt.out = attempt.place / "out"
        if kind == "out":
            target = "/proc/no/such" if target in (".", "/") else target  # it is the command line's to say where results go
            put(attempt.out)
        else:
            inside = {"kept": "solved/attempt", "result": chance.choice(["results.json", "attempt.vtu", "comparison.csv", "solved", "attempt_springs.vtu", "attempt_bodies", "attempt.html"])}.get(kind)
            if inside:
                (attempt.out / inside).parent.mkdir(parents=True)
                put(attempt.out / inside)
        if kind == "junit":
            if target in ("/etc/passwd", "/", str(attempt.place / "canary"), "/proc/self/mem"):
                return attempt.run("gate", path, "--junit", "/proc/no/such/j.xml")
            put(place / "j.xml")
            if target == "fifo":
                return attempt.run("gate", path)
            return attempt.run("gate", path, "--junit", place / "j.xml")
        return attempt.run(*words[:1], path, *chance.choice([[], ["--report"]]), "--out", attempt.out)
    if kind == "springs.csv":
        words += ["--set", "msm.design=network", "--set", "msm.file=springs.csv"]
    elif kind.startswith("given"):
        words = ["run", path, "--msm-displacements", place / kind]
    elif kind in ("body.msh", "body.geo"):
        body(f'shape = "mesh"\nfile = "{kind}"')
    elif kind == "body.stl":
        body('shape = "voxels"\nsurface = "body.stl"\nedge = 1')
    elif kind == "body.nii":
        body(f'shape = "labels"\nfile = "{kind}"\nedge = 1\n[[body.classes]]\nname = "a"\nlower = 1\nupper = 2')
    elif kind == "pulls.csv":
        path.write_text(CASE.replace("poissons_ratio = 0.3\n", "poissons_ratio = 0.3\ndensity = 1000\n") + '[dynamics]\nscheme = "newmark"\nstep = 0.001\nend = 0.006\n')
        words += ["--replay", place / kind]
    elif kind == "curve.csv":
        words = ["design", "--curve", place / kind, "--strain", "logarithmic", "--unit", "MPa"]
    elif kind == "skin.vtp":
        path.write_text(CASE + '[surface]\nfile = "skin.vtp"\n')
    put(place / kind)
    attempt.run(*words)


def folders(attempt, chance):
    path = attempt.write("case.toml", CASE)
    place = chance.choice(["", "/proc/x", "/dev/null/x", "/dev/full", "/sys/x", "-x", "a\nb", "%s", "$(touch PWNED)", "a" * 300, "a/" * 100, "x\x7fy", "\udcff", "case.toml", "case.toml/x", "./.", "../out", " "])
    where = place if place.startswith("/") or place in ("", "case.toml", "case.toml/x") else os.fsencode(str(attempt.out)) + b"/" + os.fsencode(place.replace("../", ""))
    command = chance.choice([["run", path], ["gate", path], ["design", "--young", "1", "--poisson", "0.3"], ["eigen"], ["export", path, "--to", "csv"], ["sweep", "--quick"] if not where else ["run", path]])
    words = [os.fsdecode(word) if isinstance(word, bytes) else word for word in [*command, chance.choice(["--out", "--out"]) , where]]
    if isinstance(words[-1], str) and words[-1].startswith("-"):
        words[-2:] = [f"--out={words[-1]}"]
    attempt.run(*words, variables={} if chance.randrange(4) else {"TMPDIR": chance.choice(["/proc", "/no/such", "", "/dev/null"])})


GEOMETRY = """Box(1) = {0, 0, 0, 2, 2, 2};
SetFactory("OpenCASCADE");
Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Line(1) = {1, 2};
Extrude {0, 2, 0} { Line{1}; Layers{2}; Recombine; }
Extrude {0, 0, 2} { Surface{5}; Layers{2}; Recombine; }
Physical Volume("all") = {1};
"""


def geometries(attempt, chance):
    wicked = chance.choice(['SystemCall "touch PWNED";', 'NonBlockingSystemCall "touch PWNED";', 'Printf("x") > "PWNED";', 'Save "PWNED";', 'Print "PWNED";', "Exit;", "Abort;",
                            'Include "/etc/passwd";', 'Include "case.toml";', 'OnelabRun("x", "touch PWNED");', "Mesh 3; Delete Model;", 'Plugin(Crack).Run;',
                            "For i In {1:1e5}\nEndFor", "Macro A\nReturn\nCall A;", "a[] = {}; Point(a[1e9]) = {1, 2, 3};", 'Error("%s%n%s%n");', "General.Terminal = 1;",
                            'General.OptionsFileName = "PWNED"; Save Options;', 'CreateDir "PWNED";', 'UnixCall "touch PWNED";', f'Point({chance.choice(ODD_NUMBERS)}) = {{0, 0, 0}};',
                            f"Mesh.MeshSizeMax = {chance.choice(ODD_NUMBERS)};", f'Physical Surface("{chance.choice(HOSTILE)}") = {{1}};', 'Solver.AutoCheck = 1; Solver.Executable0 = "touch PWNED";'])
    lines = GEOMETRY.splitlines()[2:]
    lines.insert(chance.randrange(len(lines) + 1), wicked)  # endless ones are another test's: they have ten minutes
    attempt.write("body.geo", "\n".join(lines) + "\n")
    if chance.randrange(3) == 0:
        attempt.write(chance.choice(["body.geo.opt", "body.opt", ".gmshrc", ".gmsh-options"]), 'SystemCall "touch PWNED";\nMesh.MeshSizeMax = 1;\n')
    path = attempt.write("case.toml", re.sub(r'shape = .*\nsize.*\ncells.*', 'shape = "mesh"\nfile = "body.geo"', CASE).replace('region = "z-"', "near = [0, 0, 0]").replace('region = "z+"\nkind = "traction"', 'near = [2, 2, 2]\nkind = "nodal_force"').replace('"z+ x+ y+"', '"near 2 2 2"'))
    attempt.run("run", path, "--out", attempt.out, ends_confined=True)


def environment(attempt, chance):
    path = attempt.write("case.toml", CASE)
    value = chance.choice(["-log_view :PWNED", "-info PWNED", "-options_file PWNED", "-ksp_view", "-malloc_dump", "-start_in_debugger", "-on_error_abort", "-fp_trap", "-dll_append PWNED.so", "-ksp_monitor",
                           "-ksp_rtol nan", "-ksp_max_it 0", "-pc_type none", "-mat_view binary:PWNED", "-history PWNED", "-viewer_socket_machine x", "-h", "-x" * 5000, "\x01\x02", chance.choice(HOSTILE).encode("unicode_escape").decode()])
    attempt.write(chance.choice([".petscrc", ".gnuplot", "gnuplotrc", ".springproof"]), f'{value}\nsystem "touch PWNED"\n')
    variable = chance.choice(["PETSC_OPTIONS", "PETSC_OPTIONS", "GNUPLOT_LIB", "SPRINGPROOF_INSTRUCTION_SET", "OMP_NUM_THREADS", "COLUMNS", "TERM", "LANG", "LC_ALL", "NO_COLOR"])
    attempt.run("run", *chance.choice([[], ["--report"]]), path, "--out", attempt.out, variables={variable: value})


def same(attempt, chance):
    attempts_same.compare(attempt, chance)


KINDS = {keys: 24, files: 28, options: 12, names: 8, limits: 5, links: 8, folders: 3, geometries: 3, environment: 2, same: 7}  # weights, a hundred in all


def main():
    count, seed = int(sys.argv[3]), int(sys.argv[4]) if len(sys.argv) > 4 else 20261125
    asked = [kind for kind in KINDS if not sys.argv[5:] or kind.__name__ in sys.argv[5:]]
    assert asked, sys.argv[5:]
    keep = Path(tempfile.mkdtemp(prefix="attempts_"))
    plan, tally, faults = random.Random(seed), {kind.__name__: {} for kind in asked}, 0
    for n in range(count):
        kind = plan.choices(asked, [KINDS[kind] for kind in asked])[0]
        attempt = Attempt(keep / f"{kind.__name__}_{n}")
        kind(attempt, random.Random(f"{seed} {n}"))
        status = attempt.done.returncode if attempt.done else "none"
        tally[kind.__name__][status] = tally[kind.__name__].get(status, 0) + 1
        if not attempt.wrong:
            shutil.rmtree(attempt.place, ignore_errors=True)
            continue
        faults += 1
        print(f"FAULT {attempt.place}: {attempt.wrong}: {' '.join(attempt.words)[:400]!r}: {attempt.done.stderr[-300:] if attempt.done else b''!r}", flush=True)
    for kind, statuses in tally.items():
        print(f"{kind}: {sum(statuses.values())} attempts, exit statuses {dict(sorted(statuses.items(), key=str))}")
    print(f"{count} attempts of seed {seed}: {faults} faults")
    if not faults:
        shutil.rmtree(keep)
    sys.exit(1 if faults else 0)


main()
