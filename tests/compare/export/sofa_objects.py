"""What an exported scene.py adds to SOFA's graph: SOFA is in no package here."""

import importlib.util
import sys
import types

import numpy as np

KNOWN = {  # components and their data, of SOFA v25.06 and later: https://www.sofa-framework.org/api/master/sofa/html
    "RequiredPlugin": {"pluginName"}, "DefaultAnimationLoop": set(), "VisualStyle": {"displayFlags"},
    "NewtonRaphsonSolver": {"name", "maxNbIterationsNewton", "maxNbIterationsLineSearch", "relativeSuccessiveStoppingThreshold",
                            "relativeInitialStoppingThreshold", "absoluteResidualStoppingThreshold"},
    "StaticSolver": {"newtonSolver"}, "BDFOdeSolver": {"newtonSolver", "order", "rayleighMass", "rayleighStiffness"},
    "SparseLDLSolver": {"template"}, "MechanicalObject": {"name", "template", "position", "rest_position"},
    "EdgeSetTopologyContainer": {"name", "position", "edges"}, "DiagonalMass": {"name", "template", "topology", "vertexMass"},
    "SpringForceField": {"name", "template", "spring"},
    "PartialFixedProjectiveConstraint": {"name", "template", "indices", "fixedDirections"},
    "ConstantForceField": {"name", "template", "indices", "forces"}, "OglModel": {"name", "position", "triangles"},
}


class Data:
    """A value that a controller changes."""

    def __init__(self, data, key):
        self.data, self.key = data, key

    value = property(lambda self: self.data[self.key], lambda self, value: self.data.__setitem__(self.key, value))

    def writeable(self):
        return self

    def __enter__(self):
        return self.data[self.key]

    def __exit__(self, *_):
        return False


class Array:
    """Numbers that a force field reads, or adds to."""

    def __init__(self, values):
        self.value = np.array(values, float)

    def writeableArray(self):
        return self

    def __enter__(self):
        return self.value

    def __exit__(self, *_):
        return False


class Component:
    def __init__(self, data):
        self.data = data

    def findData(self, key):
        assert key in self.data, key
        return Data(self.data, key)

    position = property(lambda self: self.findData("position"))


class ForceField:
    def __init__(self, *args, **kwargs):
        pass

    def forces(self, x):
        total = Array(np.zeros((len(x), 3)))
        self.addForce({"kFactor": 1}, total, Array(x), None)
        return total.value

    def change(self, dx):
        """Finds how the forces change along dx, at the state of the last forces."""
        total = Array(np.zeros((len(dx), 3)))
        self.addDForce({"kFactor": 1}, total, Array(dx))
        return total.value

    def slope(self, n):
        """Row, column and value of the forces' derivative."""
        return [(int(i), int(j), value) for i, j, value in self.addKToMatrix({"kFactor": 1}, n, 3)]


class Controller:
    def __init__(self, *args, **kwargs):
        pass


class Node:
    """Takes what a scene adds, if SOFA has such a component with such data."""

    def __init__(self, objects):
        self.objects = objects

    def addChild(self, name):
        return Node(self.objects)

    def addObject(self, component, **data):
        for kind in (Controller, ForceField):
            if isinstance(component, kind):
                self.objects.append((kind.__name__, component))
                return component
        assert set(data) <= KNOWN[component], (component, data.keys())
        for link in ("newtonSolver", "topology"):  # a link leads to what stands before it
            assert link not in data or any(known.get("name") == data[link][1:] for _, known in self.objects), link
        self.objects.append((component, data))
        return Component(data)


def scene_of(folder):
    """Pairs of a component's name and its data, in the order of the scene; of the root ("root", its data)."""
    sofa = types.ModuleType("Sofa")
    sofa.Core = types.ModuleType("Sofa.Core")
    sofa.Core.Controller, sofa.Core.ForceFieldVec3d = Controller, ForceField
    sys.modules.update({"Sofa": sofa, "Sofa.Core": sofa.Core})
    spec = importlib.util.spec_from_file_location("scene", folder / "scene.py")
    scene = importlib.util.module_from_spec(spec)
    sys.dont_write_bytecode = True
    spec.loader.exec_module(scene)
    root = Node([])
    scene.createScene(root)
    assert root.gravity == [0, 0, 0]
    return [("root", {"dt": getattr(root, "dt", None)})] + root.objects


def springs_of(fields):
    """Node, node, mN/mm, mm of each; none has damping."""
    for field in fields:
        values = field["spring"].split()
        for n in range(0, len(values), 5):
            assert float(values[n + 3]) == 0
            yield int(values[n]), int(values[n + 1]), float(values[n + 2]), float(values[n + 4])
