"""What `./do package` makes, unpacked into an empty prefix that is then moved, with the sources and the build hidden: the program, its
data, the man page, the completion, the library for other people's programs, the Python module.

prefix_test.py SOURCE BUILD
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

source, build = (pathlib.Path(word).resolve() for word in sys.argv[1:])
faults = []


def run(words, **options):
    return subprocess.run([str(word) for word in words], capture_output=True, text=True, **options)


def check(condition, complaint):
    if not condition:
        print(complaint, flush=True)  # what follows may stop at a file that is not there
        faults.append(complaint)


def hidden(words, folder, **environment):
    """Runs a command where neither the sources nor the build exist (a mount namespace of its own)."""
    hide = f'for f in "{source}" "{build}"; do [ ! -d "$f" ] || mount -t tmpfs none "$f"; done; cd "$0" && exec "$@"'
    environment = {"PATH": "/usr/bin:/bin", "OPENBLAS_NUM_THREADS": "1", "HOME": str(folder), **environment}
    done = run(["unshare", "--mount", "sh", "-c", hide, folder, *words], env=environment)
    check(done.returncode == 0, f"{' '.join(map(str, words))}: status {done.returncode}: {done.stderr[-2000:]}")
    return done.stdout


if run(["unshare", "--mount", "true"]).returncode != 0:
    print("this user may not make a mount namespace: nothing was compared")
    sys.exit(0)

with tempfile.TemporaryDirectory() as name:
    scratch = pathlib.Path(name)
    packed = run(["cpack", "--config", build / "CPackConfig.cmake", "-B", scratch / "packed"])
    check(packed.returncode == 0, f"cpack: {packed.stdout}{packed.stderr}")
    package = next((scratch / "packed").glob("springproof_*.deb"))

    fields = run(["dpkg-deb", "--info", package]).stdout
    depends = re.search(r"Depends: (.*)", fields)[1]
    for wanted in ("libdeal.ii", "libgmsh", "libvtk9", "libopenblas0-pthread", "libpetsc", "libcholmod", "libc6 (>="):
        check(wanted in depends, f"the package does not depend on {wanted}: {depends}")
    run(["dpkg-deb", "-x", package, scratch / "unpacked"], check=True)
    (scratch / "unpacked" / "usr").rename(scratch / "moved")
    prefix = scratch / "moved"

    for file in prefix.rglob("*"):
        if not file.is_file():
            continue
        content = file.read_bytes()
        check(str(source).encode() not in content and str(build).encode() not in content, f"{file} names the folder it was built from")

    program = prefix / "bin/springproof"
    work = scratch / "work"
    work.mkdir()
    check("springproof" not in hidden([program, "--version"], work), "--version")
    hidden([program, "new", "mine"], work)
    check("top" in hidden([program, "run", prefix / "share/doc/springproof/examples/library/block.toml", "--out", "out"], work), "run")
    check((work / "out/block.vtu").exists(), "run --out left no .vtu")
    check("4.1" in hidden([program, "tables", "4.1"], work), "tables 4.1")

    man = hidden(["man", "--warnings", "-l", prefix / "share/man/man1/springproof.1"], work, MANPAGER="cat", MANWIDTH="100", LC_ALL="C.UTF-8")
    for word in ("--msm-displacements", "EXIT STATUS", "tables", "sweep", "--shard"):
        check(word in man, f"the man page does not mention {word}")
    check("springproof worker" not in man and "describe" not in man, "the man page mentions a hidden command")

    completion = prefix / "share/bash-completion/completions/springproof"
    for words, expected in [("springproof ta", "tables"), ("springproof run --onl", "--only"), ("springproof run --only ms", "msm"),
                            ("springproof new x --template vo", "")]:
        typed = words.split(" ")
        script = f'source {completion}; COMP_WORDS=({words}); COMP_CWORD={len(typed) - 1}; _springproof; echo "${{COMPREPLY[*]}}"'
        proposed = hidden(["bash", "-c", script], work).strip()
        check(proposed == expected, f"completion of '{words}' is '{proposed}', not '{expected}'")

    # The Python module of the package, and its example.
    python = prefix / "lib/python3/dist-packages"
    hidden(["/usr/bin/python3", prefix / "share/doc/springproof/examples/python/compare_designs.py",
            prefix / "share/doc/springproof/examples/library/block.toml"], work, PYTHONPATH=str(python))
    table = [line.split() for line in (work / "compare_designs.txt").read_text().splitlines()]
    check(len(table) == 6 and all(0 < float(word) < 60 for line in table[1:] for word in line[1:]), f"compare_designs.txt: {table}")
    check((work / "compare_designs.svg").read_text().rstrip().endswith("</svg>"), "compare_designs.svg is not whole")

    # A build without VTK's module, as `./do tables` makes: text, and one message where files are asked for.
    module = prefix / "lib/springproof/springproof_vtk.so"
    module.rename(scratch / module.name)
    block = prefix / "share/doc/springproof/examples/library/block.toml"
    check("top" in hidden([program, "run", block], work), "run without VTK's module")
    hidden(["sh", "-c", '! "$0" run "$1" --out refused 2> said', program, block], work)
    said = (work / "said").read_text()
    check("no VTK" in said and "./do packages" in said and said.count("\n") == 1, f"run --out without VTK's module says {said}")
    check(not (work / "refused").exists(), "a refused run has left its folder")
    (scratch / module.name).rename(module)

    # A program of somebody else's, built and run against the prefix alone.
    shutil.copytree(prefix / "share/doc/springproof/examples/library", work / "library")
    hidden(["cmake", "-S", "library", "-B", "library/build", f"-DCMAKE_PREFIX_PATH={prefix}", "-DCMAKE_BUILD_TYPE=Debug"], work)
    hidden(["cmake", "--build", "library/build"], work)
    said = hidden(["library/build/pull", "library/block.toml"], work)
    values = dict(re.findall(r"^(\w+) = (\S+)", said, re.MULTILINE))
    check(abs(float(values.get("top", "nan")) - 0.156817) < 1e-6, f"examples/library prints {said}")

print(f"{len(faults)} faults" if faults else "the package works from a moved prefix, with the sources and the build hidden")
sys.exit(1 if faults else 0)
