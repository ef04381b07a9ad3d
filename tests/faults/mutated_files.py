"""Damaged files of every kind that the program reads, each given to the program.

usage: mutated_files.py SPRINGPROOF SOURCE_FOLDER [FILES_OF_EACH_KIND [KIND ...]]

Kinds: case, dynamic, msh, tetrahedra, tetrahedra22, tetrahedra_vtu, tetrahedra_vtk, stl, tool, obj, ply, skin, nifti, nifti_world, vtu,
cells, vtk, vtp, displacements, motion, pvd, network, nodes, network_alone, curve, kept. A damaged file ends in exit status 0, 1 or 2 within
5 s (a slow build of the program may have more, in the variable LIMIT_SECONDS), with a line on standard error unless it is 0, and without a
word of a sanitizer's; a damaged kept result ends in the numbers of an undisturbed run. What offends is left in the folder that is named.
The damage is the same in every run. Only Python's standard library is used.
"""

import json
import os
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

from originals import (CASE, BOX, MOTION, NETWORK_CASE, UNTHOUGHT, box_skin_vtp, cube_msh, cube_stl, damaged, grid_vtk, points_vtp)

PROGRAM, SOURCE = (Path(argument).resolve() for argument in sys.argv[1:3])
LIMIT_SECONDS = float(os.environ.get("LIMIT_SECONDS", 5))
FOUND = (b"Sanitizer", b"runtime error:", b"ended without an answer")  # the last: in a confined process
MESHES = SOURCE / "tests/cases/mesh/files"


def springproof(*words):
    return subprocess.run([PROGRAM, *map(str, words)], stdin=subprocess.DEVNULL, capture_output=True, timeout=LIMIT_SECONDS)


class Kind:
    """How a kind of file is made whole, and given to the program in a folder."""
    found = FOUND

    def __init__(self, folder):
        self.folder = folder

    def case(self, body=BOX):
        path = self.folder / "case.toml"
        path.write_text(CASE.format(body=body, measure="volume"))
        return path


class CaseFile(Kind):
    whole = property(lambda self: self.case().read_bytes())

    def given(self, content):
        (self.folder / "case.toml").write_bytes(content)
        return springproof("run", "--only", "msm", self.folder / "case.toml")


class DynamicCase(Kind):
    """Every key of a motion, solved by both models. Most damage to its bytes leaves no TOML: two of three files have other values."""
    numbers = ["0", "-1", "1e-9", "1e-3", "0.5", "3", "1e4", "1e9", "1e300", "5e-324", "nan", "inf", "[]", "[[0, 1], [0, 0]]"]
    words = ["implicit_euler", "newmark", "generalized_alpha", "bdf2", "rest", "equilibrium", "lumped", "consistent", "uniform", "peak",
             "overshoot", "damping_ratio", "trajectory_l2", "end", "x-", "z-", "z+ x+ y+", "torque", "nodal_force", "ogden", "q2_p1"]

    def damaged(self, content, chance):
        if chance.randrange(3) == 0:
            return damaged(content, chance)
        text = content.decode()
        pattern, values = chance.choice(2 * [(r"(?<![\w\"])-?\d[\d.e-]*", self.numbers)] + [(r'(?<=")[\w+ -]+(?=")', self.words)])
        value = chance.choice(list(re.finditer(pattern, text)))
        if values == self.numbers and chance.randrange(4):
            values = [f"{float(value[0]) * chance.choice([-1, 1e-6, 0.1, 0.5, 2, 5, 10, 1e9]):g}"]
        return (text[:value.start()] + chance.choice(values) + text[value.end():]).encode()

    @property
    def whole(self):
        text = self.case().read_text()
        text = text.replace("poissons_ratio = 0.3", "poissons_ratio = 0.3\ndensity = 1070\nmass_damping = 5\nstiffness_damping = 0.001")
        return (text + MOTION).encode()

    def given(self, content):
        (self.folder / "case.toml").write_bytes(content)
        shutil.rmtree(self.folder / "out", ignore_errors=True)
        return springproof("run", self.folder / "case.toml", "--out", self.folder / "out")


class Msh(Kind):
    whole = cube_msh()

    def given(self, content):
        (self.folder / "body.msh").write_bytes(content)
        return springproof("run", "--only", "msm", self.case('[body]\nshape = "mesh"\nfile = "body.msh"'))


class Tetrahedra(Msh):
    """Tetrahedra as gmsh writes them in binary. gmsh asks for as much memory as a damaged file says, which ends a sanitizer's process."""
    found = FOUND[:2]
    name, whole = "body.msh", (MESHES / "gmsh_41_binary.msh").read_bytes()

    def given(self, content):
        (self.folder / self.name).write_bytes(content)
        return springproof("run", "--only", "msm", self.case(f'[body]\nshape = "mesh"\nfile = "{self.name}"'))


class Tetrahedra22(Tetrahedra):
    """In gmsh's format 2, as text, whose groups the program reads itself."""
    found = FOUND
    whole = (MESHES / "gmsh_22_text.msh").read_bytes()


class TetrahedraVtu(Tetrahedra):
    """The same by meshio."""
    found = FOUND
    name, whole = "body.vtu", (MESHES / "meshio.vtu").read_bytes()


class TetrahedraVtk(Tetrahedra):
    name, whole = "body.vtk", (MESHES / "meshio.vtk").read_bytes()


class Stl(Kind):
    whole = cube_stl()
    name, body = "body.stl", 'shape = "voxels"\nsurface = "body.stl"\nedge = 1'

    def given(self, content):
        (self.folder / self.name).write_bytes(content)
        return springproof("run", "--only", "msm", self.case("[body]\n" + self.body))


class ToolFile(Stl):
    """A cube that presses a box from above."""
    name = "tool.stl"
    body = BOX + """
[[tool]]
name = "cube"
shape = "surface"
file = "tool.stl"
centre = [0, 0, 2]
displacement = [0, 0, -0.1]
"""

    def given(self, content):
        (self.folder / self.name).write_bytes(content)
        return springproof("run", "--only", "msm", self.case(self.body))


class Obj(Stl):
    """A cube of squares, which cubes fill."""
    corners = [(2 * (i & 1), 2 * (i >> 1 & 1), 2 * (i >> 2)) for i in range(8)]
    squares = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    whole = "\n".join(["# a cube", *(f"v {x} {y} {z}" for x, y, z in corners), *("f " + " ".join(str(v + 1) for v in face) for face in squares), ""]).encode()
    name, body = "body.obj", 'shape = "surface"\nfile = "body.obj"\nsize = 1\nfill = "cubes"'


class Ply(Stl):
    """The same. VTK 9.1 frees memory twice on some damaged files of this format: its confined process ends, and the program says so."""
    found = FOUND[:2]
    whole = "\n".join(["ply", "format ascii 1.0", "element vertex 8", "property float x", "property float y", "property float z", "element face 6",
                       "property list uchar int vertex_indices", "end_header", *(f"{x} {y} {z}" for x, y, z in Obj.corners),
                       *("4 " + " ".join(map(str, face)) for face in Obj.squares), ""]).encode()
    name, body = "body.ply", 'shape = "surface"\nfile = "body.ply"\nsize = 1\nfill = "cubes"'


class Skin(Kind):
    """A .vtp of squares and of a strip about the box, which the body takes along, and on which distances are measured."""

    @property
    def whole(self):
        return box_skin_vtp()

    def damaged(self, content, chance):
        """Most damage to its bytes leaves no XML: two of three files have another number."""
        if chance.randrange(3) == 0:
            return damaged(content, chance)
        number = chance.choice(list(re.finditer(rb'(?<=[\s"])\d+(?=[\s"])', content)))
        value = chance.choice([chance.choice(UNTHOUGHT), b"%d" % chance.randint(-2, 25), b"%g" % chance.uniform(-3, 3)])
        return content[:number.start()] + value + content[number.end():]

    def given(self, content):
        (self.folder / "skin.vtp").write_bytes(content)
        path = self.case()
        path.write_text(path.read_text() + '[surface]\nfile = "skin.vtp"\n[[landmark]]\nname = "top"\npoint = [1, 1, 2]\n')
        return springproof("run", path)


class Nifti(Kind):
    """A picture of 12 x 3 x 2 voxels."""
    name = "body.nii"
    voxels = struct.pack("<72h", *([100] * 6 + [50] * 6) * 6)
    numbers = [0, 39, *range(40, 56, 2), 70, 72, *range(76, 108, 4), 108, 112, 116, 123, 252, 254, 344]
    keys = 'keep = "largest"'

    @property
    def whole(self):
        header = bytearray(352)
        struct.pack_into("<i", header, 0, 348)
        struct.pack_into("<8h", header, 40, 3, 12, 3, 2, 1, 1, 1, 1)
        struct.pack_into("<2h", header, 70, 4, 16)
        struct.pack_into("<8f", header, 76, 1, 1, 2, 3, 0, 0, 0, 0)
        struct.pack_into("<3f", header, 108, 352, 1, 0)
        header[344:348] = b"n+1\0"
        return bytes(header) + self.voxels

    def damaged(self, content, chance):
        """Half of the damage is to numbers of the header."""
        if chance.randrange(2):
            return damaged(content, chance)
        data = bytearray(content)
        for _ in range(chance.randint(1, 3)):
            at = chance.choice(self.numbers)
            value = chance.choice([0, 1, -1, 2, 3, 4, 7, 9, 255, 1000, 32767, -32768])
            struct.pack_into(*(("<h", data, at, value) if chance.randrange(3) else
                               ("<f", data, at, chance.choice([0.0, -1.0, 1e-30, 1e30, float("nan"), float("inf"), 351.0, 1e9]))))
        return bytes(data)

    def given(self, content):
        (self.folder / self.name).write_bytes(content)
        classes = "".join(f'[[body.classes]]\nname = "{name}"\nlower = {lower}\nupper = {upper}\n'
                          for name, lower, upper in (("bone", 80, 120), ("skin", 40, 60)))
        body = f'[body]\nshape = "labels"\nfile = "{self.name}"\nedge = 1.5\n{self.keys}\n{classes}'
        return springproof("run", "--only", "msm", self.case(body))


class NiftiWorld(Nifti):
    """The same with a quarter of a turn to the world, in both of NIfTI's forms, and a case in its coordinates."""
    numbers = [*range(40, 48, 2), *range(76, 92, 4), 123, *2 * [252, 254, *range(256, 328, 4)]]
    keys = 'frame = "world"\nkeep = [-1, 2, 3.5]\ncrop = [[-7, 0, 1], [1, 20, 7]]'

    @property
    def whole(self):
        header = bytearray(super().whole)
        struct.pack_into("<2h6f", header, 252, 1, 1, 0, 0, 0.5 ** 0.5, -1, 2, 3)
        struct.pack_into("<12f", header, 280, 0, -2, 0, -1, 1, 0, 0, 2, 0, 0, 3, 3)
        return bytes(header)


class Displacements(Kind):
    name, options = "given.csv", ()

    @property
    def whole(self):
        rows = [f"{i},{j},{k},0,{0.01 * k},0" for k in range(3) for j in range(3) for i in range(3)]
        return "\n".join(["x,y,z,ux,uy,uz", *rows, ""]).encode()

    def given(self, content):
        (self.folder / self.name).write_bytes(content)
        return springproof("run", *self.options, "--msm-displacements", self.folder / self.name, self.case())


class Vtu(Displacements):
    name = "given.vtu"

    @property
    def whole(self):
        out = self.folder / "whole"
        if not out.exists():
            assert springproof("run", self.case(), "--out", out).returncode == 0
        return next(path for path in out.glob("*.vtu") if not path.stem.endswith("_springs")).read_bytes()


class Cells(Vtu):
    """The same, to be interpolated in its cells."""
    options = ("--interpolate",)


class Vtk(Displacements):
    """A legacy file in binary, with hexahedra to be interpolated in."""
    name, options = "given.vtk", ("--interpolate",)

    @property
    def whole(self):
        return grid_vtk()


class Vtp(Displacements):
    name = "given.vtp"

    @property
    def whole(self):
        return points_vtp()


class Motion(Displacements):
    """A motion as a .csv of times."""
    name = "motion.csv"

    @property
    def whole(self):
        rows = [f"{t},{i},{j},{k},0,{t * k},0" for t in (0, 0.01, 0.02) for k in range(3) for j in range(3) for i in range(3)]
        return "\n".join(["time,x,y,z,ux,uy,uz", *rows, ""]).encode()

    def case(self):
        path = super().case()
        text = path.read_text().replace("[material]", "[material]\ndensity = 1000", 1)
        path.write_text(text + '[dynamics]\nscheme = "implicit_euler"\nstep = 0.01\nend = 0.02\n')
        return path


class Pvd(Motion):
    """The list of a motion's files."""
    name = "motion.pvd"

    @property
    def whole(self):
        for step in range(3):
            (self.folder / f"{step}.csv").write_bytes(super(Motion, self).whole)
        files = "".join(f'    <DataSet timestep="{step / 100}" part="0" file="{step}.csv"/>\n' for step in range(3))
        return f'<?xml version="1.0"?>\n<VTKFile type="Collection" version="1.0">\n  <Collection>\n{files}  </Collection>\n</VTKFile>\n'.encode()


class Network(Kind):
    """Springs between all of the nodes of the box that are neighbours, or a diagonal apart."""

    @property
    def whole(self):
        nodes = [(i, j, k) for k in range(3) for j in range(3) for i in range(3)]
        near = [(a, b) for b in range(27) for a in range(b) if max(abs(x - y) for x, y in zip(nodes[a], nodes[b])) == 1]
        return "\n".join(["node_a,node_b,stiffness", *(f"{a},{b},{40 + a}" for a, b in near), ""]).encode()

    def given(self, content):
        (self.folder / "springs.csv").write_bytes(content)
        return springproof("run", "--only", "msm", self.case(), "--set", "msm.design=network", "--set", "msm.file=springs.csv")


class Nodes(Kind):
    """The nodes of a network without cells, with masses, between which the same springs are."""
    whole = "\n".join(["x,y,z,mass", *(f"{n % 3},{n // 3 % 3},{n // 9}.5,{1e-6 * (1 + n)}" for n in range(27)), ""]).encode()

    def given(self, content):
        (self.folder / "nodes.csv").write_bytes(content)
        (self.folder / "springs.csv").write_bytes(Network(self.folder).whole)
        (self.folder / "case.toml").write_text(NETWORK_CASE)
        return springproof("run", "--only", "msm", self.folder / "case.toml")


class NetworkAlone(Nodes):
    """The springs of the same."""
    whole = property(lambda self: Network(self.folder).whole)

    def given(self, content):
        (self.folder / "nodes.csv").write_bytes(Nodes.whole)
        (self.folder / "springs.csv").write_bytes(content)
        (self.folder / "case.toml").write_text(NETWORK_CASE)
        return springproof("run", "--only", "msm", self.folder / "case.toml")


class Curve(Kind):
    whole = "\n".join(["stretch,stress", *(f"{1 + 0.02 * i},{0.012 * i}" for i in range(20)), ""]).encode()

    def given(self, content):
        (self.folder / "curve.csv").write_bytes(content)
        return springproof("design", "--curve", self.folder / "curve.csv", "--strain", "stretch", "--unit", "MPa", "--method", "nonlinear_method")


class Kept(Kind):
    """What --out keeps of a finished case. The measures must come out as they were."""

    def __init__(self, folder):
        super().__init__(folder)
        assert springproof("run", self.case(), "--out", folder / "out").returncode == 0
        self.kept = folder / "out/solved/damaged"
        self.whole, self.measures = self.kept.read_bytes(), self.measured()

    def measured(self):
        return json.loads((self.folder / "out/results.json").read_text())["cases"][0]["measures"]

    def given(self, content):
        self.kept.write_bytes(content)
        done = springproof("run", self.case(), "--out", self.folder / "out")
        if done.returncode != 0 or self.measured() != self.measures:
            done.returncode = f"{done.returncode}, or other numbers"
        return done


KINDS = {"case": CaseFile, "dynamic": DynamicCase, "msh": Msh, "tetrahedra": Tetrahedra, "tetrahedra22": Tetrahedra22,
         "tetrahedra_vtu": TetrahedraVtu, "tetrahedra_vtk": TetrahedraVtk, "stl": Stl, "tool": ToolFile,
         "obj": Obj, "ply": Ply, "skin": Skin, "nifti": Nifti,
         "nifti_world": NiftiWorld, "vtu": Vtu, "cells": Cells, "vtk": Vtk, "vtp": Vtp,
         "displacements": Displacements, "motion": Motion, "pvd": Pvd, "network": Network, "nodes": Nodes,
         "network_alone": NetworkAlone, "curve": Curve, "kept": Kept}


def try_out(kind, count, keep):
    """Number of offenders among so many damaged files, and the count of each exit status."""
    statuses, offenders = {}, 0
    chance = random.Random(20261122)
    with tempfile.TemporaryDirectory() as name:
        subject = KINDS[kind](Path(name))
        whole = subject.whole
        sound = subject.given(whole)
        assert sound.returncode == 0, (kind, sound)
        for n in range(count):
            content = getattr(subject, "damaged", damaged)(whole, chance)
            try:
                done = subject.given(content)
                status, said = done.returncode, done.stderr
            except subprocess.TimeoutExpired:
                status, said = f"above {LIMIT_SECONDS:g} s", b""
            statuses[status] = statuses.get(status, 0) + 1
            is_found = any(words in said for words in subject.found)
            if not is_found and (status == 0 or (status in (1, 2) and (said or status == 1))):
                continue
            offenders += 1
            left = keep / f"{kind}_{n}"
            left.write_bytes(content)
            print(f"{left}: exit {status}: {said[:300]!r}")
    print(f"{kind}: {count} files, exit statuses {statuses}", flush=True)
    return offenders


def main():
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 500
    keep = Path(tempfile.mkdtemp(prefix="damaged_"))
    offenders = sum(try_out(kind, count, keep) for kind in sys.argv[4:] or KINDS)
    if not offenders:
        shutil.rmtree(keep)
    sys.exit(1 if offenders else 0)


if __name__ == "__main__":
    main()
