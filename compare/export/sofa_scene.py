"""The springs of scene.json as a SOFA scene: runSofa scene.py

Made by `springproof export CASE --to sofa`. This program is the same for every case; the case is in scene.json beside it, with lengths in
mm, forces in N and stiffnesses in N/mm, which SOFA takes as they are.

Every spring is in one list, with its own stiffness and rest length. SOFA's RegularGridSpringForceField is no substitute: it gives
the springs at the boundary of a grid the stiffness of those inside, where they belong to half as many cells, or a quarter.

For SOFA v24.06 or newer, with SofaPython3. Before v24.06 the two components below had the names StiffSpringForceField and
PartialFixedConstraint. The equilibrium is static, under the full load: StaticSolver may make as few as one Newton iteration a step unless
it is told otherwise (newton_iterations; in later versions a NewtonRaphsonSolver beside it), so animate until nothing moves. A motion too
large for that is to be given in steps: "moved" has its end, mm.
"""

import json
import os

SPRINGS, SUPPORT = "SpringForceField", "PartialFixedProjectiveConstraint"
PLUGINS = ["Sofa.Component.Constraint.Projective", "Sofa.Component.LinearSolver.Direct", "Sofa.Component.MechanicalLoad",
           "Sofa.Component.ODESolver.Backward", "Sofa.Component.SolidMechanics.Spring", "Sofa.Component.StateContainer",
           "Sofa.Component.Visual"]


def createScene(rootNode):
    folder = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "scene.json"), encoding="ascii") as file:
        model = json.load(file)
    rootNode.gravity = [0, 0, 0]
    rootNode.addObject("RequiredPlugin", pluginName=PLUGINS)
    rootNode.addObject("DefaultAnimationLoop")
    rootNode.addObject("VisualStyle", displayFlags="showBehaviorModels showForceFields")
    body = rootNode.addChild("body")
    body.addObject("StaticSolver")
    body.addObject("SparseLDLSolver", template="CompressedRowSparseMatrixd")
    # Nodes of moved regions begin where their motion ends: they are among the supports.
    position = [list(place) for place in model["positions"]]
    for node, *displacement in model["moved"]:
        position[node] = [x + u for x, u in zip(position[node], displacement)]
    body.addObject("MechanicalObject", name="nodes", template="Vec3d", position=position, rest_position=model["positions"])
    # Of each spring its two nodes, stiffness, damping and rest length.
    springs = " ".join(f"{a} {b} {stiffness!r} 0 {rest_length!r}" for a, b, stiffness, rest_length in model["springs"])
    body.addObject(SPRINGS, name="springs", template="Vec3d", spring=springs)
    for n, support in enumerate(model["supports"]):
        body.addObject(SUPPORT, name=f"support_{n}", template="Vec3d", indices=support["nodes"],
                       fixedDirections=support["directions"])
    if model["loads"]:
        body.addObject("ConstantForceField", name="loads", template="Vec3d", indices=[load[0] for load in model["loads"]],
                       forces=[load[1:] for load in model["loads"]])
    return rootNode
