"""Mass-spring models of soft tissue against finite elements: the cases, solvers, designs and measures of springproof.

    case = springproof.read_case("block.toml", {"material.poissons_ratio": 0.3})
    springs = case.solve("msm")          # or "fem"; springs.displacement is a numpy array
    print(case.measure(springs))

What the program would refuse is an InputError, a load that cannot be carried a SolveError, with the program's messages. Lengths are in mm,
forces in N, stresses in MPa.
"""

import json
import os

from ._springproof import Case, InputError, Solution, SolveError, program_version
from . import _springproof

__all__ = ["Case", "InputError", "Solution", "SolveError", "design", "read_case"]
__version__ = program_version()


def read_case(path, settings=None):
    """A case file. The settings override its keys, as --set does: {"load[0].value": [0, 0, 0.01]}."""
    return _springproof.read_case(os.fspath(path), [f"{key}={json.dumps(value)}" for key, value in (settings or {}).items()])


def design(young, poisson, method="", edge=1.0):
    """Springs for Young's modulus (MPa) and Poisson's ratio, of cubes with this edge (mm): the document of `springproof design --json`."""
    return json.loads(_springproof.design(young, poisson, method, edge))


def _compare(case):
    """Both sides, the limit and the errors: the case's entry in the document of `springproof run --json`."""
    return json.loads(case._compare())


Case.compare = _compare
