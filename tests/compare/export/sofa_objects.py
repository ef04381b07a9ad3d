"""What an exported scene.py adds to SOFA's graph: SOFA is in no package here."""

import importlib.util
import sys
import types

KNOWN = {  # components and their data, of SOFA v25.06 and later: https://www.sofa-framework.org/api/master/sofa/html
    "RequiredPlugin": {"pluginName"}, "DefaultAnimationLoop": set(), "VisualStyle": {"displayFlags"},
    "NewtonRaphsonSolver": {"name", "maxNbIterationsNewton", "maxNbIterationsLineSearch", "relativeSuccessiveStoppingThreshold",
                            "relativeInitialStoppingThreshold", "absoluteResidualStoppingThreshold"},
    "StaticSolver": {"newtonSolver"}, "BDFOdeSolver": {"newtonSolver", "order", "rayleighMass", "rayleighStiffness"},
    "SparseLDLSolver": {"template"}, "MechanicalObject": {"name", "template", "position", "rest_position"},
    "EdgeSetTopologyContainer": {"name", "position", "edges"}, "DiagonalMass": {"name", "template", "topology", "vertexMass"},
    "SpringForceField": {"name", "template", "spring"},
    "PartialFixedProjectiveConstraint": {"name", "template", "indices", "fixedDirections"},
    "ConstantForceField": {"name", "template", "indices", "forces"},
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


class Component:
    def __init__(self, data):
        self.data = data

    def findData(self, key):
        assert key in self.data, key
        return Data(self.data, key)

    position = property(lambda self: self.findData("position"))


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
        if isinstance(component, Controller):
            self.objects.append(("Controller", component))
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
    sofa.Core.Controller = Controller
    sys.modules.update({"Sofa": sofa, "Sofa.Core": sofa.Core})
    spec = importlib.util.spec_from_file_location("scene", folder / "scene.py")
    scene = importlib.util.module_from_spec(spec)
    sys.dont_write_bytecode = True
    spec.loader.exec_module(scene)
    root = Node([])
    scene.createScene(root)
    assert root.gravity == [0, 0, 0]
    return [("root", {"dt": getattr(root, "dt", None)})] + root.objects


def springs_of(field):
    """Node, node, mN/mm, mm of each; none has damping."""
    values = field["spring"].split()
    for n in range(0, len(values), 5):
        assert float(values[n + 3]) == 0
        yield int(values[n]), int(values[n + 1]), float(values[n + 2]), float(values[n + 4])
