"""The libraries behind deal.II, gmsh and VTK are loaded by the commands that need them, and by no other; what is in the library is
not in the solvers' shared object again; neither offers other libraries' functions.

shared_objects_test.py PROGRAM SOURCE
"""

import pathlib
import re
import subprocess
import sys
import tempfile

program, source = (pathlib.Path(word).resolve() for word in sys.argv[1:])
cube = """schema = 1
name = "cube"
[body]
shape = "box"
size = [1, 1, 1]
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
value = [0, 0, 0.001]
[fem]
formulation = "small_strain"
element = "q1"
accuracy = "none"
[msm]
design = "moduli"
[[measure]]
name = "top"
kind = "coordinate"
node = "z+ x+ y+"
axis = "z"
"""
plate = source / "cases/studies/plate_with_hole/case.toml"
heavy = {"deal.II": "libdeal.ii", "PETSc": "libpetsc", "gmsh": "libgmsh", "VTK": "libvtk"}
solvers = {"deal.II", "PETSc", "gmsh"}  # deal.II is linked to gmsh too
faults = []


def loaded_by(*words):
    """The heavy libraries that a command initialises; every command must end with status 0."""
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "cube.toml").write_text(cube)
        run = subprocess.run([program, *words], cwd=folder, env={"LD_DEBUG": "files", "PATH": "/usr/bin:/bin", "OPENBLAS_NUM_THREADS": "1"},
                             capture_output=True, text=True)
    if run.returncode != 0:
        said = [line for line in run.stderr.splitlines() if not re.match(r" *\d+:\t", line)]
        faults.append(f"springproof {' '.join(map(str, words))}: exit status {run.returncode}: {said[-3:]}")
    return {name for name, file in heavy.items() if re.search(rf"calling init: \S*/{file}", run.stderr)}


for expected, words in [
    (set(), ["--version"]),
    (set(), ["run", "--help"]),
    (set(), ["new", "mine"]),
    (set(), ["design", "--young", "0.3", "--poisson", "0.3", "--method", "linear_method"]),
    (set(), ["run", "--only", "msm", "cube.toml"]),
    ({"VTK"}, ["run", "--only", "msm", "--out", "out", "cube.toml"]),
    (set(), ["eigen", "--poisson", "0.3"]),
    (solvers, ["eigen", "--poisson", "0.3", "--body", "2"]),
    (solvers, ["run", "--only", "fem", "cube.toml"]),
]:
    found = loaded_by(*words)
    if found != expected:
        faults.append(f"springproof {' '.join(map(str, words))} loads {sorted(found)}, not {sorted(expected)}")
gmsh = loaded_by("design", "--case", plate, "--method", "moduli")
if gmsh != {"gmsh"}:
    faults.append(f"a design for a .geo loads {sorted(gmsh)}, not gmsh alone")


def symbols(file, *options):
    """Names of functions and data that a file defines and others cannot replace."""
    lines = subprocess.run(["nm", "--defined-only", *options, file], capture_output=True, text=True, check=True).stdout
    return {words[2] for words in map(str.split, lines.splitlines()) if len(words) == 3 and words[1] in "TDBR"}


def of_others(names):
    plain = subprocess.run(["c++filt"], input="\n".join(sorted(names)), capture_output=True, text=True, check=True).stdout.split("\n")
    return [name for name in plain if name and "springproof" not in name]


folder = program.parent
library = symbols(folder / "libspringproof.so", "-D")
if len(library) < 300:
    faults.append(f"libspringproof.so offers {len(library)} functions only")
twice = library & symbols(folder / "springproof_solvers.so")
faults += [f"{name} is in libspringproof.so and in springproof_solvers.so" for name in sorted(twice)[:5]]
for file in ("libspringproof.so", "springproof_solvers.so", "springproof_gmsh.so", "springproof_vtk.so"):
    strange = of_others(symbols(folder / file, "-D"))
    faults += [f"{file} offers {name}" for name in strange[:5]]

print("\n".join(faults) or f"{len(library)} functions of the library, none twice; heavy libraries wait until they are needed")
sys.exit(1 if faults else 0)
