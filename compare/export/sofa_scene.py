"""The springs of scene.json as a SOFA scene: runSofa scene.py

Made by `springproof export CASE --to sofa`. This program is the same for every case; the case is in scene.json beside it, with lengths in
mm, forces in mN, stiffnesses in mN/mm, masses in kg and times in s, which go together: kg mm/s² is a mN.

For SOFA v25.06 or newer, with SofaPython3. Earlier versions have no NewtonRaphsonSolver, which StaticSolver and BDFOdeSolver solve their
equations with, and before v24.12 SpringForceField had no stiffness matrix (StiffSpringForceField had).

Every spring of Hooke's law is in one list, with its own stiffness and rest length. SOFA's RegularGridSpringForceField is no substitute: it gives
the springs at the boundary of a grid the stiffness of those inside, where they belong to half as many cells, or a quarter. What no component of SOFA has is
a force field in numpy: springs of other laws, midlines, volume terms and biquadratic tetrahedra, whose forces are in forces.py beside this file.

A static case is in equilibrium after the first step of the animation. A case in time takes a step of its own length with every step of the
animation: BDFOdeSolver of order 1 is the implicit Euler method, of order 2 bdf2, whose first step is one of order 1. Linear systems are
factorised. CGLinearSolver is no substitute as it comes: its threshold of 1e-9 bounds an absolute p.Ap, which small bodies are below from the start.
"""

import json
import math
import os
import sys

import numpy as np

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, FOLDER)
import forces

TOLERANCE = 1e-8  # residual relative to the scene's own forces
PLUGINS = ["Sofa.Component.Constraint.Projective", "Sofa.Component.LinearSolver.Direct", "Sofa.Component.Mass",
           "Sofa.Component.MechanicalLoad", "Sofa.Component.ODESolver.Backward", "Sofa.Component.SolidMechanics.Spring",
           "Sofa.Component.StateContainer", "Sofa.Component.Topology.Container.Dynamic", "Sofa.Component.Visual",
           "Sofa.GL.Component.Rendering3D"]


def factor_at(history, time):
    """Factor of a load or motion; at a jump what comes after it."""
    if isinstance(history, dict):
        return math.sin(2 * math.pi * history["sine"] * time)
    if not history:
        return 1.0
    before = [point for point in history if point[0] <= time]
    after = [point for point in history if point[0] > time]
    if not before or not after:
        return (before or after)[-1 if before else 0][1]
    (t0, f0), (t1, f1) = before[-1], after[0]
    way = (time - t0) / (t1 - t0)
    return (1 - way) * f0 + way * f1


def displacement_of(moved, rest, part, factor):
    """mm, of a node of a moved region: s times a displacement, or a rotation by s times an angle about an axis through a centre."""
    s = part * factor
    if moved["angle"] == 0:
        return [s * u for u in moved["displacement"]]
    angle, k = math.radians(s * moved["angle"]), moved["axis"]
    arm = [x - c for x, c in zip(rest, moved["centre"])]
    along = sum(a * b for a, b in zip(k, arm))
    across = [k[1] * arm[2] - k[2] * arm[1], k[2] * arm[0] - k[0] * arm[2], k[0] * arm[1] - k[1] * arm[0]]
    return [(math.cos(angle) - 1) * (a - along * n) + math.sin(angle) * c for a, n, c in zip(arm, k, across)]


def size_of_forces(model):
    """mN: norm of all loads; where there is none, of the forces when moved nodes alone have moved, by less where cells would turn inside out."""
    motion = model["motion"]
    loads = [load for part in motion["loads"] for load in part["forces"]] if motion else model["loads"]
    squared = sum(f * f for load in loads for f in load[1:])
    if squared > 0:
        return math.sqrt(squared)
    lattice = forces.Body(forces.read_package(FOLDER))
    far = np.zeros(lattice.rest.shape)
    for node, *u in model["start"]:
        far[node] = u
    for moved in motion["moved"] if motion else []:
        for node, part in zip(moved["nodes"], moved["parts"]):
            far[node] = displacement_of(moved, model["positions"][node], part, 1)
    for halvings in range(60):
        size = float(np.linalg.norm(lattice.forces(lattice.rest + far / 2**halvings)))
        if math.isfinite(size):
            return size
    return 0.0


def terms_of(model):
    """The terms that no component of SOFA has. Stiffness is that of the state whose forces were computed last, as in SOFA's own springs."""
    import Sofa.Core

    class Terms(Sofa.Core.ForceFieldVec3d):
        def __init__(self, *args, **kwargs):
            Sofa.Core.ForceFieldVec3d.__init__(self, *args, **kwargs)
            self.lattice = forces.Body(forces.arrays_of(dict(model["terms"], nodes=model["positions"])))
            self.at = self.lattice.rest

        def addForce(self, parameters, force, position, velocity):
            self.at = np.array(position.value)
            with force.writeableArray() as array:
                array += self.lattice.forces(self.at)

        def addDForce(self, parameters, df, dx):
            with df.writeableArray() as array:
                array -= parameters["kFactor"] * self.lattice.stiffness_product(self.at, np.array(dx.value))

        def addKToMatrix(self, parameters, n_nodes, n_components):
            entries = self.lattice.stiffness(self.at)
            entries[:, 2] *= -parameters["kFactor"]
            return entries

    return Terms(name="terms")


def add_skin(body, model, state):
    """A surface to look at, which moves as the nodes whose weighted sums its vertices are."""
    import Sofa.Core

    vertices, nodes, weights = np.array(model["skin"]["weights"], float).reshape(-1, 3).T
    vertices, nodes = vertices.astype(int), nodes.astype(int)

    def places():
        all_places = np.zeros((vertices.max() + 1, 3))
        np.add.at(all_places, vertices, weights[:, None] * np.array(state.position.value)[nodes])
        return all_places

    surface = body.addChild("skin").addObject("OglModel", name="surface", position=places().tolist(), triangles=model["skin"]["triangles"])

    class Follow(Sofa.Core.Controller):
        def onAnimateEndEvent(self, event):
            surface.position.value = places()

    body.addObject(Follow(name="follow"))


def controller_of(model, state, fields):
    """What loads and moved regions do over time: at the beginning of a step they get what they have at its end, where the step is solved."""
    import Sofa.Core

    class History(Sofa.Core.Controller):
        def __init__(self, *args, **kwargs):
            Sofa.Core.Controller.__init__(self, *args, **kwargs)
            self.n_steps = 0

        def onAnimateBeginEvent(self, event):
            self.n_steps += 1
            time = self.n_steps * model["motion"]["step"]
            for field, load in zip(fields, model["motion"]["loads"]):
                factor = factor_at(load["history"], time)
                field.findData("forces").value = [[factor * f for f in force[1:]] for force in load["forces"]]
            if not model["motion"]["moved"]:
                return
            with state.position.writeable() as position:
                for moved in model["motion"]["moved"]:
                    factor = factor_at(moved["history"], time)
                    for node, part in zip(moved["nodes"], moved["parts"]):
                        rest = model["positions"][node]
                        for a, u in enumerate(displacement_of(moved, rest, part, factor)):
                            if moved["components"][a]:
                                position[node][a] = rest[a] + u

    return History(name="history")


def add_solvers(body, model):
    motion = model["motion"]
    per_step = motion["step"] if motion else 1  # residuals of BDFOdeSolver are momenta
    body.addObject("NewtonRaphsonSolver", name="newton", maxNbIterationsNewton=100, maxNbIterationsLineSearch=20,
                   relativeSuccessiveStoppingThreshold=0, relativeInitialStoppingThreshold=0,
                   absoluteResidualStoppingThreshold=TOLERANCE * per_step * size_of_forces(model))
    if motion:
        body.addObject("BDFOdeSolver", newtonSolver="@newton", order={"implicit_euler": 1, "bdf2": 2}[motion["scheme"]],
                       rayleighMass=motion["mass_damping"], rayleighStiffness=motion["stiffness_damping"])
    else:
        body.addObject("StaticSolver", newtonSolver="@newton")
    body.addObject("SparseLDLSolver", template="CompressedRowSparseMatrixd")


def add_force_field(body, name, forces):
    return body.addObject("ConstantForceField", name=name, template="Vec3d", indices=[force[0] for force in forces],
                          forces=[force[1:] for force in forces])


def createScene(rootNode):
    with open(os.path.join(FOLDER, "scene.json"), encoding="ascii") as file:
        model = json.load(file)
    motion = model["motion"]
    rootNode.gravity = [0, 0, 0]  # a weight is among the loads
    if motion:
        rootNode.dt = motion["step"]
    rootNode.addObject("RequiredPlugin", pluginName=PLUGINS)
    rootNode.addObject("DefaultAnimationLoop")
    rootNode.addObject("VisualStyle", displayFlags="showBehaviorModels showForceFields")
    body = rootNode.addChild("body")
    add_solvers(body, model)
    # Nodes of a static case's moved regions begin where their motion ends: they are among the supports.
    position = [list(place) for place in model["positions"]]
    for node, *displacement in model["start"]:
        position[node] = [x + u for x, u in zip(position[node], displacement)]
    state = body.addObject("MechanicalObject", name="nodes", template="Vec3d", position=position, rest_position=model["positions"])
    if motion:  # masses need a topology; it has no part in the forces
        body.addObject("EdgeSetTopologyContainer", name="topology", position=model["positions"],
                       edges=[list(map(int, spring[:2])) for spring in model["springs"] + model["terms"]["springs"]])
        body.addObject("DiagonalMass", name="masses", template="Vec3d", topology="@topology", vertexMass=motion["masses"])
    # A spring: its two nodes, stiffness, damping and rest length.
    springs = " ".join(f"{a} {b} {stiffness!r} 0 {rest_length!r}" for a, b, stiffness, rest_length in model["springs"])
    if springs:
        body.addObject("SpringForceField", name="springs", template="Vec3d", spring=springs)
    if any(model["terms"].values()):
        body.addObject(terms_of(model))
    for n, support in enumerate(model["supports"]):
        body.addObject("PartialFixedProjectiveConstraint", name=f"support_{n}", template="Vec3d", indices=support["nodes"],
                       fixedDirections=support["directions"])
    if model["loads"]:
        add_force_field(body, "loads", model["loads"])
    if motion:
        fields = [add_force_field(body, f"load_{n}", load["forces"]) for n, load in enumerate(motion["loads"])]
        if motion["moved"] or any(load["history"] for load in motion["loads"]):
            body.addObject(controller_of(model, state, fields))
    if model["skin"]["triangles"]:
        add_skin(body, model, state)
    return rootNode
