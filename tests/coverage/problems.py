"""The problems of the coverage test, each told once: make_truths.py solves them, coverage.py has springproof solve them.

A body is a box, a union of boxes (filled with cubes from a surface in STL) or a block with eight corners of its own, meshed by gmsh.
Points are given in coordinates of reference: those of the body itself, and for a block fractions of its edges. Lengths in mm, forces in
N, moduli in MPa, angles in degrees.
"""

import itertools
import math

AXES = "xyz"


def box(size, cells):
    return {"kind": "box", "size": size, "cells": cells}


def voxels(boxes, edge):
    size = [max(b[1][d] for b in boxes) for d in range(3)]
    return {"kind": "voxels", "boxes": boxes, "edge": edge, "size": size, "cells": [round(s / edge) for s in size]}


def block(corners, cells):
    """Corners in the order (0,0,0), (1,0,0), (0,1,0), (1,1,0), (0,0,1) ..."""
    return {"kind": "block", "corners": corners, "size": [1, 1, 1], "cells": cells}


def elastic(modulus, ratio):
    return {"model": "linear_elastic", "youngs_modulus": modulus, "poissons_ratio": ratio}


def ogden(mu, alpha, bulk=None):
    law = {"model": "ogden", "mu": mu, "alpha": alpha}
    if bulk:
        law["bulk_modulus"] = bulk
    return law


def u(name, point, component):
    return {"name": name, "kind": "displacement", "point": point, "component": component, "unit": "mm"}


ENERGY = {"name": "energy", "kind": "strain_energy", "unit": "N mm"}
L2 = {"name": "l2", "kind": "displacement_field_l2", "unit": "mm"}
VOLUME = {"name": "volume", "kind": "volume", "unit": "mm3"}


def reaction(name, face, component):
    return {"name": name, "kind": "reaction", "face": face, "component": component, "unit": "N"}


def patch_reaction(name, where, component):
    return {**where, "name": name, "kind": "reaction", "component": component, "unit": "N"}


def stress(name, point, component):
    return {"name": name, "kind": "stress", "point": point, "component": component, "unit": "MPa"}


def twist(name, point, centre, axis="z"):
    return {"name": name, "kind": "twist", "point": point, "centre": centre, "axis": axis, "unit": "deg"}


def tilt(name, top, bottom, toward, up="z"):
    return {"name": name, "kind": "tilt", "top": top, "bottom": bottom, "toward": toward, "up": up, "unit": "deg"}


def traction(where, value):
    return {**where, "kind": "traction", "value": value}


def torque(where, value, axis, centre):
    return {**where, "kind": "torque", "value": value, "axis": axis, "centre": centre}


def face(name):
    return {"face": name}


def patch(centre):
    """The four faces on top of a block around a point, or those of them that are there. The point is lifted: sides are out of reach."""
    return {"near": [centre[0], centre[1], centre[2] + 0.6], "radius": 1}


def moved(where, displacement, components=AXES):
    return {**where, "displacement": displacement, "components": components}


def turned(where, angle, axis, centre):
    return {**where, "angle": angle, "axis": axis, "centre": centre}


def problem(name, about, body, material, measures, lines, fixed=("z-",), held=(), symmetry=(), load=(), move=(), inclusions=(),
            formulation=None, element=None, width=2, levels=None, steps=1, h=None):
    """lines: by axis, where the graded mesh of make_truths.py ends elements: a coordinate towards which it is graded has a * behind it.
    fixed: faces; held: (face, components). width: percent, of what is expected of the springs' error, so that a limit is sought to a
    quarter of it; None: springproof's default. h: the longest element by axis, half of the body by default."""
    return {"name": name, "about": about, "body": body, "material": material, "measures": measures, "lines": lines, "fixed": fixed,
            "held": held, "symmetry": symmetry, "load": load, "move": move, "inclusions": inclusions,
            "formulation": formulation or ("hyperelastic" if material["model"] == "ogden" else "small_strain"), "element": element,
            "width": width, "levels": levels, "steps": steps, "h": h or [side / 2 for side in body["size"]]}


TAPERED = [[0, 0, 0], [10, 0, 0], [0, 8, 0], [10, 8, 0], [2, 1, 12], [8, 1, 12], [2, 6, 12], [8, 6, 12]]
SKEW = [[0, 0, 0], [8, 1, 0], [-1, 8, 0], [7, 9, 0], [2, 2, 6], [10, 3, 7], [1, 10, 6], [9, 11, 7]]
WEDGE = [[0, 0, 0], [12, 0, 0], [0, 10, 0], [12, 5, 0], [0, 0, 8], [12, 0, 8], [0, 10, 8], [12, 5, 8]]
L_BRACKET = [([0, 0, 0], [4, 4, 12]), ([0, 0, 8], [12, 4, 12])]
T_BODY = [([4, 0, 0], [8, 4, 8]), ([0, 0, 8], [12, 4, 12])]
RING = [([0, 0, 0], [6, 2, 4]), ([0, 0, 8], [6, 2, 12]), ([2, 0, 4], [6, 2, 8])]
NOTCHED = [([0, 0, 0], [6, 3, 4]), ([2, 0, 4], [6, 3, 6]), ([0, 0, 6], [6, 3, 10])]

PROBLEMS = [
    # bending of clamped bodies
    problem("sheared_cube_01", "a clamped cube under a shear traction, nu 0.1", box([10, 10, 10], [4, 4, 4]), elastic(0.3, 0.1),
            [u("u_x", [5, 5, 10], "x"), u("u_z", [10, 5, 10], "z"), ENERGY, L2, stress("s_xz", [6.25, 6.25, 3.75], "xz")],
            ["0* 10*", "0* 10*", "0* 10*"], load=[traction(face("z+"), [0.003, 0, 0])], width=None),
    problem("bar_03", "a cantilever of 3 x 2 x 12, nu 0.3", box([3, 2, 12], [3, 2, 12]), elastic(1, 0.3),
            [u("u_tip", [3, 1, 12], "x"), u("u_mid", [0, 1, 6], "z"), tilt("tilt", [3, 2, 12], [3, 2, 6], "x"), ENERGY,
             stress("s_zz", [0.5, 0.5, 2.5], "zz")],
            ["0* 3*", "0* 2*", "0* 12*"], load=[traction(face("z+"), [0.001, 0, 0])], h=(9, 9, 3)),
    problem("bar_049", "half a cantilever of 2 x 4 x 10 bent about its stiff axis, nu 0.49", box([1, 4, 10], [1, 4, 10]), elastic(0.5, 0.49),
            [u("u_tip", [0, 4, 10], "y"), u("u_z", [0, 0, 5], "z"), ENERGY, L2],
            ["0 1*", "0* 4*", "0* 10*"], symmetry=("x-",), load=[traction(face("z+"), [0, 0.001, -0.0005])], h=(9, 9, 3)),
    problem("beam_0499", "a wide beam in plane strain, clamped, nu 0.499", box([14, 3, 2], [6, 2, 1]), elastic(0.3, 0.499),
            [u("u_tip", [14, 1.5, 0], "y"), u("u_x", [7, 3, 0], "x"), ENERGY, L2],
            ["0* 14*", "0* 3*", "0 2"], fixed=("x-",), symmetry=("z-", "z+"), load=[traction(face("x+"), [0, 2e-5, 0])], h=(3, 2, 9), width=6,
            levels=[(4, 2), (5, 3), (7, 3)]),
    problem("block_04999", "half a short block sheared by a traction, nu 0.4999", box([6, 3, 5], [2, 1, 2]), elastic(0.2, 0.4999),
            [u("u_x", [3, 0, 5], "x"), u("u_z", [6, 0, 5], "z"), ENERGY],
            ["0* 6*", "0 3*", "0* 5*"], symmetry=("y-",), width=16, load=[traction(face("z+"), [0.002, 0, 0])], levels=[(4, 1), (5, 2), (6, 2)]),
    # bonded pads
    problem("pad_03", "a block between bonded plates, pressed, nu 0.3", box([8, 8, 6], [4, 4, 4]), elastic(0.4, 0.3),
            [reaction("r_z", "z-", "z"), u("bulge", [8, 4, 3], "x"), ENERGY, L2, stress("s_zz", [5, 5, 0.75], "zz")],
            ["0* 8*", "0* 8*", "0* 6*"], move=[moved(face("z+"), [0, 0, -0.3])]),
    problem("pad_0495", "half a flat pad between bonded plates, pressed and sheared, nu 0.495", box([8, 4, 2], [8, 4, 2]), elastic(0.4, 0.495),
            [reaction("r_z", "z-", "z"), reaction("r_x", "z-", "x"), u("bulge", [8, 0, 1], "x"), ENERGY],
            ["0* 8*", "0 4*", "0* 2*"], move=[moved(face("z+"), [0.1, 0, -0.05], "xz")], held=[("z+", "y")], symmetry=("y-",)),
    # torsion
    problem("torsion_square", "a square bar under a torque, nu 0.25", box([4, 4, 12], [4, 4, 12]), elastic(1, 0.25),
            [twist("twist", [4, 4, 12], [2, 2, 12]), u("u_y", [4, 2, 6], "y"), ENERGY, L2],
            ["0* 4*", "0* 4*", "0* 12*"], load=[torque(face("z+"), 0.02, "z", [2, 2, 12])], h=(9, 9, 4)),
    problem("torsion_rectangle", "a bar of 6 x 2 whose end is turned by 2 degrees: it does not warp there, nu 0.4", box([6, 2, 8], [6, 2, 8]),
            elastic(0.5, 0.4), [twist("twist", [6, 1, 4], [3, 1, 4]), u("warp", [6, 2, 2], "z"), ENERGY, L2],
            ["0* 6*", "0* 2*", "0* 8*"], move=[turned(face("z+"), 2, "z", [3, 1, 8])], h=(9, 9, 4), width=4),
    # punches
    problem("smooth_punch", "a quarter of a smooth square punch on a block, nu 0.3", box([4, 4, 4], [4, 4, 4]), elastic(0.3, 0.3),
            [patch_reaction("r_z", patch([0, 0, 4]), "z"), u("u_z", [2, 0, 4], "z"), u("u_x", [3, 0, 4], "x"), ENERGY],
            ["0 1* 4", "0 1* 4", "0* 4*"], symmetry=("x-", "y-"), move=[moved(patch([0, 0, 4]), [0, 0, -0.1], "z")], width=20),
    problem("bonded_punch", "half a bonded square punch, moved aslant, nu 0.45", box([6, 3, 4], [6, 3, 4]), elastic(0.3, 0.45),
            [patch_reaction("r_z", patch([3, 0, 4]), "z"), patch_reaction("r_x", patch([3, 0, 4]), "x"), u("u_z", [6, 0, 4], "z"), ENERGY],
            ["0 2* 4* 6", "0 1* 3", "0* 4*"],
            move=[moved(patch([3, 0, 4]), [0.1, 0, -0.1], "xz")], symmetry=("y-",), levels=[(3, 2), (4, 2)], width=16),
    problem("pressed_patch", "a quarter of a block with a pressure on a square patch, nu 0.35", box([4, 4, 6], [4, 4, 6]), elastic(0.3, 0.35),
            [u("u_z", [0, 0, 6], "z"), u("u_x", [4, 0, 6], "x"), ENERGY, L2, stress("s_zz", [0.5, 0.5, 3.5], "zz")],
            ["0 1* 4", "0 1* 4", "0* 6*"], symmetry=("x-", "y-"), levels=[(3, 1), (4, 2), (5, 2)],
            load=[traction(patch([0, 0, 6]), [0, 0, -0.02])], width=8),
    problem("rubbed_patch", "a shear traction on a patch near an edge, nu 0.48", box([6, 6, 4], [6, 6, 4]), elastic(0.3, 0.48),
            [u("u_x", [4, 2, 4], "x"), u("u_y", [6, 0, 4], "y"), ENERGY, L2],
            ["0 3* 5* 6", "0 1* 3* 6", "0* 4*"], levels=[(3, 1), (4, 1), (5, 1)],
            load=[traction(patch([4, 2, 4]), [0.01, 0.004, 0])], width=4),
    # inclusions
    problem("stiff_inclusion", "a quarter of a block, pulled, with a cube in it that is twenty times stiffer",
            box([3, 3, 6], [3, 3, 6]), elastic(0.3, 0.3),
            [u("u_z", [0, 0, 6], "z"), u("u_x", [3, 0, 3], "x"), ENERGY, stress("s_zz", [0.5, 0.5, 2.5], "zz")],
            ["0 1* 3", "0 1* 3", "0* 2* 4* 6"], width=4, symmetry=("x-", "y-"), levels=[(3, 1), (4, 1), (5, 1)],
            load=[traction(face("z+"), [0, 0, 0.01])],
            inclusions=[([[0, 0, 2], [1, 1, 4]], elastic(6, 0.3))]),
    problem("soft_inclusion", "half a block, sheared, with a cube in it, ten times softer and nearly incompressible", box([6, 3, 6], [6, 3, 6]),
            elastic(0.3, 0.25), [u("u_x", [3, 0, 6], "x"), u("u_z", [6, 0, 6], "z"), ENERGY, L2, stress("s_xz", [3.5, 0.5, 3.5], "xz")],
            ["0* 2* 4* 6*", "0 1* 3", "0* 2* 4* 6*"], width=6, symmetry=("y-",), levels=[(3, 1), (4, 1)], load=[traction(face("z+"), [0.004, 0, 0])],
            inclusions=[([[2, 0, 2], [4, 1, 4]], elastic(0.03, 0.49))]),
    problem("layers", "a cantilever of two layers", box([12, 3, 4], [12, 3, 4]), elastic(1, 0.3),
            [u("u_z", [12, 0, 2], "z"), u("u_x", [6, 0, 4], "x"), ENERGY, stress("s_xx", [4.5, 1.5, 3.5], "xx")],
            ["0* 12*", "0* 3*", "0* 2* 4*"], fixed=("x-",), levels=[(3, 2), (4, 2)], load=[traction(face("x+"), [0, 0, 0.001])], h=(4, 9, 9),
            inclusions=[([[0, 0, 2], [12, 3, 4]], elastic(0.1, 0.45))]),
    # thin plates
    problem("plate_cantilever", "a plate of thickness 1 under pressure, clamped at one edge, nu 0.3", box([10, 8, 1], [10, 8, 1]), elastic(10, 0.3),
            [u("u_z", [10, 4, 1], "z"), u("u_corner", [10, 0, 1], "z"), ENERGY, L2],
            ["0* 10*", "0* 8*", "0* 1*"], fixed=("x-",), load=[traction(face("z+"), [0, 0, -0.001])], h=(5, 5, 9)),
    problem("plate_clamped", "a quarter of a clamped plate under pressure, nu 0.3", box([8, 8, 0.8], [8, 8, 1]), elastic(10, 0.3),
            [u("u_z", [0, 0, 0], "z"), u("u_z_half", [4, 4, 0], "z"), ENERGY, L2],
            ["0 8*", "0 8*", "0* 0.8*"], fixed=("x+", "y+"), symmetry=("x-", "y-"), load=[traction(face("z+"), [0, 0, -0.002])], h=(4, 4, 9)),
    problem("plate_twisted", "a strip of 12 x 4 x 1 under a torque, nu 0.2", box([12, 4, 1], [12, 4, 1]), elastic(10, 0.2),
            [twist("twist", [12, 4, 0], [12, 2, 0], "x"), u("u_z", [6, 4, 0], "z"), ENERGY],
            ["0* 12*", "0* 4*", "0* 1*"], fixed=("x-",), width=4, load=[torque(face("x+"), 0.05, "x", [12, 2, 0.5])], h=(4, 9, 9)),
    # meshes by gmsh
    problem("tapered_gmsh", "a tapered block, bent, nu 0.3", block(TAPERED, [4, 4, 6]), elastic(0.5, 0.3),
            [u("u_x", [0.5, 0.5, 1], "x"), u("u_z", [1, 0.5, 0.5], "z"), ENERGY, L2],
            ["0* 1*", "0* 1*", "0* 1*"], load=[traction(face("z+"), [0.002, 0.001, 0])], h=(9, 9, 0.5)),
    problem("skew_gmsh", "a skewed block between bonded plates, pressed, nu 0.4", block(SKEW, [4, 4, 4]), elastic(0.5, 0.4),
            [reaction("r_z", "z-", "z"), reaction("r_x", "z-", "x"), u("u_x", [1, 0.5, 0.5], "x"), ENERGY],
            ["0* 1*", "0* 1*", "0* 1*"], width=12, move=[moved(face("z+"), [0, 0, -0.2])]),
    problem("wedge_gmsh", "a wedge, clamped at its thick end, under pressure on its top, nu 0.48", block(WEDGE, [6, 4, 4]), elastic(0.5, 0.48),
            [u("u_z", [1, 0.5, 1], "z"), u("u_y", [0.5, 1, 0.5], "y"), ENERGY, L2],
            ["0* 1*", "0* 1*", "0* 1*"], fixed=("x-",), load=[traction(face("z+"), [0, 0, -0.002])], width=4, element="q1_p0", h=(0.5, 9, 9)),
    # voxels
    problem("bracket_voxels", "an L of cubes, its arm pressed at the end, nu 0.3", voxels(L_BRACKET, 2), elastic(1, 0.3),
            [u("u_z", [12, 2, 12], "z"), u("u_x", [4, 2, 8], "x"), ENERGY, L2],
            ["0* 4* 12*", "0* 4*", "0* 8* 12*"], load=[traction(face("x+"), [0, 0, -0.002])], h=(4, 9, 4), width=4, levels=[(3, 2), (4, 2)]),
    problem("t_voxels", "a T of cubes, sheared at its top, nu 0.4", voxels(T_BODY, 2), elastic(1, 0.4),
            [u("u_x", [6, 2, 12], "x"), u("u_z", [12, 0, 12], "z"), ENERGY],
            ["0 4* 8* 12", "0* 4*", "0* 8* 12*"], load=[traction(face("z+"), [0.001, 0, 0])], h=(9, 9, 4), width=4, levels=[(3, 2), (4, 2)]),
    problem("ring_voxels", "a quarter of a ring of cubes, squeezed between plates, nu 0.2", voxels(RING, 2), elastic(1, 0.2),
            [reaction("r_z", "z-", "z"), u("u_x", [6, 0, 6], "x"), u("u_z", [0, 0, 8], "z"), ENERGY],
            ["0 2* 6*", "0 2*", "0* 4* 8* 12*"],
            move=[moved(face("z+"), [0, 0, -0.1], "z")], held=[("z+", "xy")], symmetry=("x-", "y-"), width=4, levels=[(3, 2), (4, 2)]),
    problem("notched_voxels", "half a notched block of cubes, pulled, nu 0.495", voxels(NOTCHED, 1), elastic(0.5, 0.495),
            [u("u_z", [0, 0, 10], "z"), u("opening", [0, 0, 6], "z"), ENERGY],
            ["0* 2* 6*", "0 3*", "0* 4* 6* 10"], symmetry=("y-",), load=[traction(face("z+"), [0, 0, 0.004])], width=4, levels=[(3, 2), (4, 2)]),
    # quadratic elements
    problem("q2_bar", "a sheared bar by quadratic elements, nu 0.3", box([4, 3, 6], [4, 3, 6]), elastic(0.3, 0.3),
            [u("u_y", [2, 3, 6], "y"), u("u_z", [4, 3, 3], "z"), ENERGY, L2],
            ["0* 4*", "0* 3*", "0* 6*"], load=[traction(face("z+"), [0, 0.002, -0.001])], element="q2", h=(9, 9, 3)),
    # large strains
    problem("ogden_sheared", "half a cube in large shear, neo-Hookean and compressible", box([6, 3, 6], [4, 2, 4]), ogden([0.1], [2], 0.25),
            [u("u_x", [6, 0, 6], "x"), tilt("tilt", [0, 0, 6], [0, 0, 0], "x"), ENERGY, VOLUME],
            ["0* 6*", "0 3*", "0* 6*"], symmetry=("y-",), load=[traction(face("z+"), [0.02, 0, 0])], steps=8),
    problem("ogden_pressed", "a quarter of a bonded block pressed by a fifth, Ogden of alpha 6", box([3, 3, 5], [2, 2, 4]), ogden([0.1], [6], 0.4),
            [reaction("r_z", "z-", "z"), u("bulge", [3, 0, 2.5], "x"), ENERGY, VOLUME],
            ["0 3*", "0 3*", "0* 5*"], move=[moved(face("z+"), [0, 0, -1], "z")], held=[("z+", "xy")], symmetry=("x-", "y-"), steps=5, width=4),
    problem("ogden_bar", "half a bar, bent far, nearly incompressible, Ogden of alpha 5", box([2, 1, 8], [2, 1, 8]), ogden([0.1], [5], 5),
            [u("u_x", [1, 0, 8], "x"), u("u_z", [2, 0, 8], "z"), ENERGY, L2],
            ["0* 2*", "0 1*", "0* 8*"], symmetry=("y-",), load=[traction(face("z+"), [0.001, 0, 0])], steps=10, h=(9, 9, 3), width=4),
    problem("ogden_stretched", "a quarter of a block stretched by 40 %, alpha -3, kappa 1000 mu", box([2, 2, 6], [2, 2, 6]), ogden([0.1], [-3]),
            [reaction("r_z", "z-", "z"), u("neck", [2, 0, 3], "x"), ENERGY],
            ["0 2*", "0 2*", "0* 6*"], move=[moved(face("z+"), [0, 0, 2.4], "z")], held=[("z+", "xy")], symmetry=("x-", "y-"), steps=8, width=4),
    problem("ogden_turned", "a block whose top is turned by 50 degrees, Mooney-Rivlin", box([4, 4, 6], [4, 4, 6]), ogden([0.08, 0.02], [2, -2], 0.5),
            [reaction("r_z", "z-", "z"), twist("twist", [4, 4, 2], [2, 2, 2]), ENERGY, VOLUME],
            ["0* 4*", "0* 4*", "0* 6*"], move=[turned(face("z+"), 50, "z", [2, 2, 6])], steps=5, width=4),
    problem("log_bar", "half a cantilever bent far, log_strain, nu 0.3", box([2, 1.5, 10], [2, 2, 10]), elastic(0.3, 0.3),
            [u("u_x", [1, 0, 10], "x"), u("u_z", [2, 0, 10], "z"), ENERGY, VOLUME],
            ["0* 2*", "0 1.5*", "0* 10*"], symmetry=("y-",), load=[traction(face("z+"), [0.0008, 0, 0])],
            formulation="log_strain", levels=[(3, 1), (4, 1), (4, 2)], steps=10, h=(9, 9, 3), width=4),
    problem("log_cube", "half a cube in large shear, log_strain, nu 0.45", box([5, 2.5, 5], [4, 2, 4]), elastic(0.3, 0.45),
            [u("u_x", [5, 0, 5], "x"), u("u_z", [0, 0, 5], "z"), ENERGY, VOLUME],
            ["0* 5*", "0 2.5*", "0* 5*"], symmetry=("y-",), load=[traction(face("z+"), [0.012, 0, -0.005])],
            formulation="log_strain", steps=5, width=4),
    problem("svk_pulled", "half a block pulled and sheared, Saint Venant-Kirchhoff, nu 0.3", box([5, 2.5, 6], [4, 2, 4]), elastic(0.3, 0.3),
            [u("u_z", [2.5, 0, 6], "z"), u("u_x", [5, 0, 6], "x"), ENERGY, VOLUME],
            ["0* 5*", "0 2.5*", "0* 6*"], symmetry=("y-",), load=[traction(face("z+"), [0.01, 0, 0.05])],
            formulation="saint_venant_kirchhoff", element="q1", levels=[(3, 1), (4, 1), (4, 2)], steps=8, width=4),
]


def physical(body, point):
    """A point of reference in mm."""
    if body["kind"] != "block":
        return [float(x) for x in point]
    result = [0.0, 0.0, 0.0]
    for corner, (k, j, i) in zip(body["corners"], itertools.product((0, 1), repeat=3)):
        weight = math.prod(t if side else 1 - t for t, side in zip(point, (i, j, k)))
        result = [r + weight * c for r, c in zip(result, corner)]
    return result


def patch_rectangle(body, near, radius):
    """The ranges in x and y of a patch on top of a box of cells of edge 1: of the faces whose centre is at most the radius away."""
    counts = [range(n) for n in body["cells"][:2]]
    chosen = [(i, j) for i, j in itertools.product(*counts) if math.dist((i + 0.5, j + 0.5, body["size"][2]), near) <= radius]
    ranges = [(d, min(c[d] for c in chosen), max(c[d] for c in chosen) + 1) for d in range(2)]
    if list(body["size"]) != list(body["cells"]) or len(chosen) != math.prod(high - low for _, low, high in ranges):
        raise ValueError("the patch is no rectangle of faces")
    return ranges


def toml(value):
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(toml(v) for v in value) + "]"
    return repr(value)


GMSH_FACES = {"x-": "left", "x+": "right", "y-": "front", "y+": "back", "z-": "bottom", "z+": "top"}


def write_geo(body, path):
    """A block with transfinite volumes: its nodes are those of the trilinear map."""
    lines = [f"Point({n}) = {{{', '.join(repr(float(x)) for x in c)}}};" for n, c in enumerate(body["corners"], 1)]
    edges = [(a, a + step, d) for d, step in enumerate((1, 2, 4)) for a in range(1, 9) if not (a - 1) & step]
    for n, (a, b, d) in enumerate(edges, 1):
        lines.append(f"Line({n}) = {{{a}, {b}}}; Transfinite Curve {{{n}}} = {body['cells'][d] + 1};")
    number = {(a, b): n for n, (a, b, _) in enumerate(edges, 1)}
    for n, name in enumerate(GMSH_FACES, 1):
        axis, side = AXES.index(name[0]), name[1] == "+"
        s, t = [step for d, step in enumerate((1, 2, 4)) if d != axis]
        a = 1 + (1, 2, 4)[axis] * side
        loop = [number[a, a + s], number[a + s, a + s + t], -number[a + t, a + s + t], -number[a, a + t]]
        lines.append(f"Curve Loop({n}) = {{{', '.join(map(str, loop))}}}; Surface({n}) = {{{n}}}; "
                     f"Transfinite Surface {{{n}}} = {{{a}, {a + s}, {a + s + t}, {a + t}}}; Recombine Surface {{{n}}};")
        lines.append(f'Physical Surface("{GMSH_FACES[name]}") = {{{n}}};')
    lines += ["Surface Loop(1) = {1, 2, 3, 4, 5, 6}; Volume(1) = {1};", "Transfinite Volume {1} = {1, 2, 4, 3, 5, 6, 8, 7};",
              'Physical Volume("body") = {1};']
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write_stl(body, path):
    """The surface of a union of boxes, two triangles for a face of a cube."""
    edge = body["edge"]

    def inside(i, j, k):
        centre = [(n + 0.5) * edge for n in (i, j, k)]
        return any(all(b[0][d] < centre[d] < b[1][d] for d in range(3)) for b in body["boxes"])

    lines = ["solid body"]
    for cell in itertools.product(*(range(n) for n in body["cells"])):
        if not inside(*cell):
            continue
        for axis, side in itertools.product(range(3), (0, 1)):
            beyond = [n + (2 * side - 1) * (d == axis) for d, n in enumerate(cell)]
            if inside(*beyond):
                continue
            s, t = (axis + 1) % 3, (axis + 2) % 3
            corner = [0, 0, 0]
            quad = []
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner[axis], corner[s], corner[t] = cell[axis] + side, cell[s] + a, cell[t] + b
                quad.append(" ".join(repr(float(c * edge)) for c in corner))
            quad = quad if side else quad[::-1]
            for triangle in ((0, 1, 2), (0, 2, 3)):
                lines += ["facet normal 0 0 0", "outer loop", *(f"vertex {quad[v]}" for v in triangle), "endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid body"]) + "\n", encoding="utf-8")


def write_case(p, folder):
    """The case file, and what it needs beside it.  @return its path"""
    body, name = p["body"], p["name"]
    on_mesh = body["kind"] == "block"
    out = ["schema = 1", f'name = "{name}"', f'description = "{p["about"]}"', "", "[body]"]
    if body["kind"] == "box":
        out += ['shape = "box"', f"size = {toml(body['size'])}", f"cells = {toml(body['cells'])}"]
    elif on_mesh:
        write_geo(body, folder / f"{name}.geo")
        out += ['shape = "mesh"', f'file = "{name}.geo"']
    else:
        write_stl(body, folder / f"{name}.stl")
        out += ['shape = "voxels"', f'surface = "{name}.stl"', f"edge = {body['edge']}"]

    def where(entry):
        if "near" in entry:
            return [f"near = {toml(physical(body, entry['near']))}", f"radius = {entry['radius']}"]
        return [f'region = "{GMSH_FACES[entry["face"]] if on_mesh else entry["face"]}"']

    def node(point):
        return '"near ' + " ".join(repr(x) for x in physical(body, point)) + '"'

    def table(title, entries):
        out.extend(["", title, *entries])

    def law(material):
        return [f"{key} = {toml(value)}" for key, value in material.items()]

    table("[material]", law(p["material"]))
    for corners, material in p["inclusions"]:
        table("[[region_material]]", [*law(material), f"box = {toml(corners)}"])
    for region in p["fixed"]:
        table("[[fixed]]", where({"face": region}))
    for region, components in p["held"]:
        table("[[fixed]]", [*where({"face": region}), f"components = {toml(list(components))}"])
    for region in p["symmetry"]:
        table("[[symmetry]]", [f'plane = "{region}"'])
    for entry in p["load"]:
        more = [f'axis = "{entry["axis"]}"', f"centre = {toml(entry['centre'])}"] if entry["kind"] == "torque" else []
        table("[[load]]", [*where(entry), f'kind = "{entry["kind"]}"', f"value = {toml(entry['value'])}", *more])
    for entry in p["move"]:
        if "angle" in entry:
            motion = [f"angle = {entry['angle']}", f'axis = "{entry["axis"]}"', f"centre = {toml(entry['centre'])}"]
        else:
            motion = [f"displacement = {toml(entry['displacement'])}", f"components = {toml(list(entry['components']))}"]
        table("[[moved]]", [*where(entry), *motion])
    table("[fem]", [f'formulation = "{p["formulation"]}"', 'accuracy = "auto"', *([f'element = "{p["element"]}"'] if p["element"] else [])])
    for m in p["measures"]:
        keys = [f'name = "{m["name"]}"', f'kind = "{m["kind"]}"']
        if m["kind"] == "displacement":
            keys.append(f"node = {node(m['point'])}")
        elif m["kind"] == "twist":
            keys += [f"node = {node(m['point'])}", f"centre = {node(m['centre'])}", f'axis = "{m["axis"]}"']
        elif m["kind"] == "tilt":
            keys += [f"top = {node(m['top'])}", f"bottom = {node(m['bottom'])}", f'toward = "{m["toward"]}"', f'up = "{m["up"]}"']
        elif m["kind"] == "stress":
            keys.append(f"point = {toml(physical(body, m['point']))}")
        elif m["kind"] == "reaction":
            keys += where(m)
        if "component" in m:
            keys.append(f'component = "{m["component"]}"')
        table("[[measure]]", keys)
        if p["width"]:
            table("[[expect]]", [f'measure = "{m["name"]}"', f"error_percent = [{-p['width'] / 2}, {p['width'] / 2}]",
                                 'reference = "converged"', 'reason = "how well the limit is to be known: to a quarter of the width"'])
    path = folder / f"{name}.toml"
    path.write_text("\n".join(out) + "\n", encoding="utf-8")
    return path
