"""The Python module: arrays of the right shapes and numbers, the program's messages, and nothing heavy loaded by the import.

python_test.py SOURCE PROGRAM
"""

import json
import pathlib
import subprocess
import sys

import springproof

loaded = pathlib.Path("/proc/self/maps").read_text()
for heavy in ("libdeal.ii", "libpetsc", "libgmsh", "libvtk"):
    assert heavy not in loaded, f"import springproof loads {heavy}"

import numpy as np

source, program = pathlib.Path(sys.argv[1]), sys.argv[2]
block = source / "examples/library/block.toml"
case = springproof.read_case(block)
assert case.nodes.shape == (5 * 5 * 9, 3) and case.cells.shape == (4 * 4 * 8, 8)
assert np.allclose(case.nodes.max(axis=0), [4, 4, 8]) and case.units == {"top": "mm", "volume": "mm3"}

# What the program prints of the same case.
document = json.loads(subprocess.run([program, "run", "--json", block], capture_output=True, text=True, check=True).stdout)["cases"][0]
printed = {measure["name"]: measure for measure in document["measures"]}
for side in ("msm", "fem"):
    solution = case.solve(side)
    assert solution.displacement.shape == case.nodes.shape and solution.stress.shape == (128, 6)
    assert np.abs(solution.displacement[case.nodes[:, 2] == 0]).max() == 0
    for name, value in case.measure(solution).items():
        assert np.isclose(value, printed[name][side], rtol=1e-9), (side, name, value, printed[name][side])
    assert np.isclose(solution.cell_volume.sum(), case.measure(solution)["volume"])
    # The reaction equals the applied load: 0.006 MPa on 16 mm2.
    assert np.allclose(solution.reaction.sum(axis=0), [0, 0, -0.096], atol=1e-9), solution.reaction.sum(axis=0)
compared = {measure["name"]: measure["error_percent"] for measure in case.compare()["measures"]}
assert all(np.isclose(error, printed[name]["error_percent"], rtol=1e-6) for name, error in compared.items()), compared

stiffness = springproof.design(0.3, 0.35, "moduli")
words = [program, "design", "--young", "0.3", "--poisson", "0.35", "--method", "moduli", "--json"]
of_program = json.loads(subprocess.run(words, capture_output=True, text=True, check=True).stdout)
assert stiffness["stiffness_N_per_m"] == of_program["stiffness_N_per_m"], stiffness


def message(kind, function):
    try:
        function()
    except kind as error:
        return str(error)
    raise AssertionError(f"no {kind.__name__}")


said = message(springproof.InputError, lambda: springproof.read_case(block, {"material.poisons_ratio": 0.3}))
refused = subprocess.run([program, "run", block, "--set", "material.poisons_ratio=0.3"], capture_output=True, text=True)
assert refused.returncode == 2 and refused.stderr.strip() == said, (said, refused.stderr)
assert "poissons_ratio" in said
assert issubclass(springproof.InputError, ValueError) and issubclass(springproof.SolveError, RuntimeError)
message(springproof.InputError, lambda: case.solve("both"))
# A column under five thousand times its load, pressed: neither model carries it.
crushed = springproof.read_case(block, {"load[0].value": [0, 0, -30], "fem.formulation": "log_strain"})
assert message(springproof.SolveError, lambda: crushed.solve("msm"))
assert message(springproof.SolveError, lambda: crushed.solve("fem"))
print("the Python module agrees with the program")
