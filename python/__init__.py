"""Mass-spring models of soft tissue against finite elements: the cases, solvers, designs and measures of springproof.

    case = springproof.read_case("block.toml", {"material.poissons_ratio": 0.3})
    springs = case.solve("msm")          # or "fem"; springs.displacement is a numpy array
    print(case.measure(springs))

What the program would refuse is an InputError, a load that cannot be carried a SolveError, with the program's messages. Lengths are in mm,
forces in N, stresses in MPa. docs/using/python.md has every name.
"""

import json
import os
import warnings

from ._springproof import Case, InputError, Solution, SolveError, program_version
from . import _springproof

__all__ = ["Case", "InputError", "Solution", "SolveError", "design", "read_case"]
__version__ = program_version()


def _toml(key, value):
    """A value as TOML: numbers, truths, texts, paths, and lists and tables of these; arrays of numpy are lists."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, (str, os.PathLike)):
        return json.dumps(os.fspath(value), ensure_ascii=False)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_toml(key, element) for element in value) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(str(name))} = {_toml(key, of_name)}" for name, of_name in value.items()) + "}"
    raise InputError(f"{key}: is {value!r}, must be a number, a truth, a text, or a list, an array or a dict of these")


def read_case(path, settings=None):
    """A case file. The settings override its keys, as --set does: {"load[0].value": [0, 0, 0.01]}."""
    return _springproof.read_case(os.fspath(path), [f"{key}={_toml(key, value)}" for key, value in (settings or {}).items()])


def design(young=None, poisson=None, method=None, edge=None, **options):
    """Springs for Young's modulus (MPa) and Poisson's ratio, of cubes with this edge (mm): the document of `springproof design --json`.

    Options are those of the command, with _ for -: design(ogden_mu=[0.01], ogden_alpha=[2], method="multi_load", springs_only=True).
    """
    words = []
    for name, value in {"young": young, "poisson": poisson, "method": method, "edge": edge, **options}.items():
        if value is None or value is False:
            continue
        words.append("--" + name.replace("_", "-"))
        if hasattr(value, "tolist"):
            value = value.tolist()
        if value is not True:
            words += [str(each) for each in (value if isinstance(value, (list, tuple)) else [value])]
    return json.loads(_springproof.design(words))


def _solve(case, side):
    """The equilibrium of "msm" or "fem" on the case's own mesh, of a case with [dynamics] its motion.

    A SolveError says why there is none. What the program would print as a warning is a warning.
    """
    solution = case._solve(side)
    for text in solution.warnings:
        warnings.warn(text, stacklevel=2)
    return solution


def _compare(case):
    """Both sides, the limit and the errors: the case's entry in the document of `springproof run --json`."""
    return json.loads(case._compare())


Case.solve = _solve
Case.compare = _compare
