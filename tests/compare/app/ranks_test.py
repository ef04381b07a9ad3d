"""A case solved by several ranks, as its user finds it: measures, files of fields, kept results.

usage: ranks_test.py SPRINGPROOF SAME_FIELDS
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM, SAME_FIELDS = (str(Path(argument).resolve()) for argument in sys.argv[1:3])
ENVIRONMENT = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")

CASE = """schema = 1
name = "block"
description = "Every measure there is."
[body]
%s
[material]
model = "linear_elastic"
youngs_modulus = 0.01
poissons_ratio = 0.3
[[fixed]]
region = "z-"
[[load]]
region = "z+"
kind = "traction"
value = [0.0002, 0.0001, 0.0004]
[fem]
formulation = "%s"
element = "q1_bbar"
accuracy = "none"
[msm]
design = "hybrid"
solver = "%s"
[[measure]]
name = "where"
kind = "coordinate"
node = "near 10 10 10"
axis = "z"
[[measure]]
name = "moved"
kind = "displacement"
node = "near 0 10 10"
component = "norm"
[[measure]]
name = "tilted"
kind = "tilt"
bottom = "near 10 0 0"
top = "near 10 0 10"
toward = "x"
[[measure]]
name = "volume"
kind = "volume"
[[measure]]
name = "mean"
kind = "displacement_field_l2"
[[measure]]
name = "most"
kind = "displacement_field_max"
[[measure]]
name = "held"
kind = "reaction"
region = "z-"
component = "norm"
[[measure]]
name = "energy"
kind = "strain_energy"
[[measure]]
name = "stress"
kind = "stress"
point = [5, 5, 5]
component = "zz"
[[measure]]
name = "strain"
kind = "strain"
point = [2.4, 5, 4.9]
component = "principal_1"
"""
BOX = 'shape = "box"\nsize = [10, 10, 10]\ncells = [%d, %d, %d]'


def springproof(*words, ranks=1):
    """Runs the program."""
    launcher = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    return subprocess.run([*launcher, PROGRAM, *map(str, words)], capture_output=True, text=True, timeout=900, env=ENVIRONMENT)


def solve(folder, case, ranks, *words):
    """A run of a case with fields in folder/RANKS, and its document."""
    file = folder / "block.toml"
    folder.mkdir(exist_ok=True)
    file.write_text(case)
    out = folder / str(ranks)
    done = springproof("run", file, "--out", out, "--json", *words, ranks=ranks)
    assert done.returncode == 0, (ranks, done)
    return json.loads(done.stdout)["cases"][0], out, done.stderr


def assert_near(one, other, what, tolerance=1e-9, least=1e-3):
    assert abs(one - other) <= tolerance * max(abs(one), least), (what, one, other)


def assert_same(alone, together, n_measures=10):
    """Measures, errors and limits of two documents."""
    assert len(alone["measures"]) == n_measures, alone
    for a, b in zip(alone["measures"], together["measures"]):
        assert a.keys() == b.keys() and a["name"] == b["name"], (a, b)
        for key, value in a.items():
            if isinstance(value, float):
                # an error of p percent is a difference of values: it has the values' rounding, in percent (a reaction
                # to the load alone has no error but that)
                if "percent" in key or "uncertainty" in key:
                    assert_near(value, b[key], (a["name"], key), 1e-7, 1 if a["name"] == "held" else 1e-3)
                else:
                    assert_near(value, b[key], (a["name"], key))
            else:
                assert value == b[key], (key, a, b)
    for side in ("fem", "msm"):
        assert alone[side]["unknowns"] == together[side]["unknowns"]
        assert alone[side]["inverted_cells"] == together[side]["inverted_cells"]


def same_fields(whole, pieces, tolerance="1e-8"):  # strains: differences of displacements that agree to 1e-9
    compared = subprocess.run([SAME_FIELDS, whole, pieces, tolerance], capture_output=True, text=True, timeout=300)
    assert compared.returncode == 0, compared
    return compared.stdout


def files_in(out):
    return sorted(str(file.relative_to(out)) for file in out.rglob("*") if file.is_file())


def vtu_files(ranks):
    whole = ["block.vtu"] if ranks == 1 else ["block.pvtu"] + [f"block_pieces/block_{r}.vtu" for r in range(ranks)]
    return whole + ["block_springs.vtu"]


def test_both_models(folder):
    """measures on 1, 2 and 4 ranks agree to 1e-9, and so do the pieces with the one file"""
    for number, (body, formulation, solver) in enumerate([
            (BOX % (12, 11, 13), "log_strain", "snes"),   # both dealt out as grids
            (BOX % (12, 11, 2), "log_strain", "newton"),  # too few planes: the finite elements are whole on every rank
            (BOX % (5, 4, 3), "small_strain", "snes"),    # assembled; the springs' SNES too small to be dealt out
    ]):
        place = folder / str(number)
        place.mkdir()
        case = CASE % (body, formulation, solver)
        alone, out_alone, _ = solve(place, case, 1)
        for ranks in (2, 4):
            together, out, _ = solve(place, case, ranks)
            assert_same(alone, together)
            said = same_fields(out_alone / "block.vtu", out / "block.pvtu")
            assert "difference" in said and "msm_inverted" in said, said
            assert all(f"{side}_{field}:" in said for side in ("fem", "msm") for field in ("stress", "strain", "reaction")), said
            names = files_in(out)
            assert [n for n in names if n.endswith("vtu")] == vtu_files(ranks)
            sizes = [(out / f"block_pieces/block_{r}.vtu").stat().st_size for r in range(ranks)]
            whole = (out_alone / "block.vtu").stat().st_size
            assert max(sizes) < whole * (1 / ranks + 0.3), (sizes, whole)  # a slab, with a plane of its neighbour's


def test_cells_of_terms(folder):
    """cells of more than four stiffnesses, solved on the first rank or over all of them"""
    for design, solver in (("biquadratic", "newton"), ("uniform", "snes")):
        place = folder / design
        place.mkdir()
        case = (CASE % (BOX % (5, 4, 3) if design == "biquadratic" else BOX % (5, 5, 5), "log_strain", solver)).replace('"hybrid"', f'"{design}"')
        alone, out_alone, _ = solve(place, case, 1)
        together, out, _ = solve(place, case, 3)
        assert_same(alone, together)
        same_fields(out_alone / "block.vtu", out / "block.pvtu")


def test_a_network(folder):
    """a network has reactions, energy and strain on any number of ranks, and no stress"""
    lines, nodes = ["node_a,node_b,stiffness_N_per_m"], 4  # 4 x 4 x 4 nodes
    for a in range(nodes ** 3):
        i, j, k = a % nodes, a // nodes % nodes, a // nodes ** 2
        for di, dj, dk in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0, 1, -1)):
            if 0 <= i + di < nodes and 0 <= j + dj < nodes and 0 <= k + dk < nodes:
                lines.append(f"{a},{a + di + nodes * dj + nodes ** 2 * dk},10")
    (folder / "springs.csv").write_text("\n".join(lines) + "\n")
    case = (CASE % (BOX % (3, 3, 3), "log_strain", "newton")).replace('"hybrid"', '"network"\nfile = "springs.csv"')
    (folder / "block.toml").write_text(case)
    refused = springproof("run", folder / "block.toml")
    assert refused.returncode == 2 and 'beside design = "network"' in refused.stderr, refused
    before, _, after = case.partition('[[measure]]\nname = "stress"')
    case = before + after[after.index("[[measure]]"):]
    for solver in ("newton", "snes"):
        place = folder / solver
        place.mkdir()
        (place / "springs.csv").write_text((folder / "springs.csv").read_text())
        alone, out_alone, _ = solve(place, case.replace('"newton"', f'"{solver}"'), 1)
        together, out, _ = solve(place, case.replace('"newton"', f'"{solver}"'), 2)
        assert_same(alone, together, 9)
        said = same_fields(out_alone / "block.vtu", out / "block.pvtu")
        assert "msm_strain:" in said and "msm_reaction:" in said and "msm_stress" not in said, said


MOTION = """schema = 1
name = "block"
description = "A body that is released from its weight, damped, with an end that moves."
[body]
%s
[material]
model = "linear_elastic"
youngs_modulus = 0.1
poissons_ratio = 0.3
density = 1000
mass_damping = 3
stiffness_damping = 0.0005
[[fixed]]
region = "x-"
[[moved]]
region = "x+"
components = ["y"]
displacement = [0, 1, 0]
history = [[0, 0], [0.02, 1]]
[[load]]
kind = "gravity"
value = [0, 0, -9.81]
history = [[0, 1], [0, 0.3]]
[dynamics]
scheme = "newmark"
step = 0.002
end = 0.04
start = "equilibrium"
write_every = 5
[fem]
accuracy = "none"
[msm]
design = "%s"
[[measure]]
name = "tip"
kind = "displacement"
node = "x+ y+ z+"
component = "z"
over_time = "peak"
[[measure]]
name = "volume"
kind = "volume"
over_time = "end"
"""


def test_a_motion(folder):
    """the springs' motion is computed on one rank, and every rank has it; solvers for several ranks are refused"""
    text = MOTION % ('shape = "box"\nsize = [30, 10, 10]\ncells = [9, 3, 3]', "hybrid")
    motions = []
    for ranks, mass in ((1, "consistent"), (2, "consistent"), (2, "cells")):
        document, out, _ = solve(folder, text, ranks, "--only", "msm", "--set", f"msm.mass={mass}")
        assert document["msm"]["status"] == "converged", document
        motions.append(document["motion"])
        assert [n for n in files_in(out) if n.startswith("block_motion/")] == [f"block_motion/block_{i:04}.vtu" for i in range(5)], files_in(out)
    assert len(motions[0]["time"]) == 21 and motions[0] == motions[1] != motions[2], motions
    for solver in ("snes", "fire"):
        case = folder / "block.toml"
        case.write_text(text.replace('design = "hybrid"', f'design = "hybrid"\nsolver = "{solver}"'))
        refused = springproof("run", case)
        assert refused.returncode == 2 and f'solver is "{solver}", must be "newton"' in refused.stderr and len(refused.stderr.splitlines()) == 1, refused


def test_a_motion_of_finite_elements(folder):
    """the motion of a grid's finite elements has the same digits on 1, 2 and 3 ranks"""
    body = 'shape = "box"\nsize = [30, 10, 10]\ncells = [9, 8, 11]'
    motions = [solve(folder, MOTION % (body, "hybrid"), ranks, "--only", "fem")[0] for ranks in (1, 2, 3)]
    for document in motions:
        assert document["fem"]["status"] == "converged", document
        assert document["motion"] == motions[0]["motion"]


def test_a_mesh_study(folder):
    """the limit of a mesh study, and the error of a field against it"""
    case = (CASE % (BOX % (4, 4, 4), "log_strain", "newton")).replace('accuracy = "none"\n', "")
    alone, out_alone, _ = solve(folder, case, 1, "--converge=3")
    together, out, _ = solve(folder, case, 2, "--converge=3")
    assert alone["measures"][4]["reference"] == "limit", alone["measures"]
    assert_same(alone, together)
    same_fields(out_alone / "block.vtu", out / "block.pvtu")


def test_kept_results(folder):
    """what ranks have kept, any number of ranks takes up; and what is damaged none"""
    case = CASE % (BOX % (6, 6, 9), "log_strain", "snes")
    first, out, said = solve(folder, case, 3)
    assert "solved already" not in said
    fields = (out / "block_pieces/block_0.vtu").read_bytes()
    assert [n for n in files_in(out) if n.startswith("solved")] == ["solved/block"]
    os.rename(out, folder / "kept")
    for ranks in (3, 1, 2, 4):
        os.rename(folder / "kept", folder / str(ranks))
        again, place, said = solve(folder, case, ranks)
        assert said.count("solved already") == 1, (ranks, said)
        assert again["measures"] == first["measures"] or ranks != 3
        assert_same(first, again)
        if ranks == 3:
            assert (place / "block_pieces/block_0.vtu").read_bytes() == fields
        assert ranks == 4 or [n for n in files_in(place) if "vtu" in n] == vtu_files(ranks)
        os.rename(place, folder / "kept")
    os.rename(folder / "kept", out)
    whole = (out / "solved/block").read_bytes()
    (out / "solved/block").write_bytes(whole[:-8] + bytes(255 - byte for byte in whole[-8:]))
    _, _, said = solve(folder, case, 3)
    assert "solved already" not in said and "is damaged" in said, said


def test_another_number_of_ranks(folder):
    """a solve on fewer ranks, or on one, leaves nothing of the earlier one's files"""
    case = CASE % (BOX % (6, 6, 9), "log_strain", "newton")
    _, out, _ = solve(folder, case, 4)
    for ranks, modulus in ((2, 0.02), (1, 0.03), (2, 0.04)):
        os.rename(out, folder / str(ranks))
        _, out, said = solve(folder, case, ranks, "--set", f"material.youngs_modulus={modulus}")
        assert "solved already" not in said
        assert [n for n in files_in(out) if "vtu" in n] == vtu_files(ranks), files_in(out)


def test_no_list_without_its_pieces(folder):
    """a piece that cannot be written: every rank ends with its reason, and no .pvtu is left"""
    case = CASE % (BOX % (6, 6, 9), "log_strain", "newton")
    _, out, _ = solve(folder, case, 2)
    assert (out / "block.pvtu").exists()
    piece = out / "block_pieces/block_1.vtu"
    piece.unlink()
    piece.mkdir()
    (piece / "in the way").write_text("")
    failed = springproof("run", folder / "block.toml", "--out", out, ranks=2)
    assert failed.returncode == 2 and failed.stderr.count("block_1.vtu") == 1, failed
    assert not (out / "block.pvtu").exists()


def test_results_on_another_mesh(folder):
    """results that are interpolated, and what that may add"""
    _, other, _ = solve(folder, CASE % (BOX % (3, 3, 4), "log_strain", "newton"), 1)
    results = folder / "results.vtu"
    results.write_bytes((other / "block.vtu").read_bytes())
    case = CASE % (BOX % (6, 6, 9), "log_strain", "newton")
    case = case[:case.index('[[measure]]\nname = "held"')]  # from there on: what displacements alone do not tell
    words = ("--msm-displacements", results, "--interpolate")
    alone, _, _ = solve(folder / "whole", case, 1, *words)
    together, _, _ = solve(folder / "shared", case, 2, *words)
    assert_same(alone, together, 6)
    assert alone["measures"][4]["interpolation_error"] > 1e-6, alone["measures"]  # mm; measure 4 is the mean
    assert alone["msm"]["interpolated"] == together["msm"]["interpolated"] == {
        "points": 80, "nodes_outside": 0, "largest_distance_outside": 0}, alone["msm"]


def test_shards_on_ranks(folder):
    """a shard's results kept by two ranks are merged by one process"""
    case = CASE % (BOX % (6, 6, 9), "log_strain", "snes") + '[[expect]]\nmeasure = "moved"\nmsm = [0, 10]\nreference = "published"\nreason = "a test"\n'
    files = [folder / f"{name}.toml" for name in ("one", "two")]
    for file in files:
        file.write_text(case.replace('"block"', f'"{file.stem}"'))
    alone = springproof("gate", *files)
    assert alone.returncode == 0, alone
    for shard, ranks in ((1, 2), (2, 1)):
        done = springproof("gate", *files, "--shard", f"{shard}/2", "--out", folder / f"shard{shard}", ranks=ranks)
        assert done.returncode == 0, done
    merged = springproof("merge", folder / "shard1", folder / "shard2", "--out", folder / "merged")
    assert merged.returncode == 0, merged
    assert [line.split(",")[0] for line in merged.stdout.splitlines()] == [line.split(",")[0] for line in alone.stdout.splitlines()]


def main():
    for name, test in list(globals().items()):
        if not name.startswith("test_") or (len(sys.argv) > 3 and name not in sys.argv[3:]):
            continue
        with tempfile.TemporaryDirectory() as folder:
            test(Path(folder))
        print("passed:", test.__doc__, flush=True)


if __name__ == "__main__":
    main()
