"""Files before they are damaged, and the damage. Only Python's standard library is used."""

import struct

UNTHOUGHT = [b"0", b"-1", b"nan", b"-inf", b"1e308", b"1e-320", b"2147483648", b"9223372036854775807", b"18446744073709551616",
             b"0x1p-1074", b"1e", b"", b"%s%n", b"\xff\xfe", b"'", b"../../x"]

CASE = """schema = 1
name = "damaged"
description = "x"
{body}
[material]
model = "linear_elastic"
youngs_modulus = 0.3
poissons_ratio = 0.3
[[fixed]]
region = "z-"
[[load]]
region = "z+"
kind = "traction"
value = [0, 0.002, 0]
[[measure]]
name = "{measure}"
kind = "volume"
"""
BOX = '[body]\nshape = "box"\nsize = [2, 2, 2]\ncells = [2, 2, 2]'

NETWORK_CASE = """schema = 1
name = "damaged"
[body]
shape = "network"
nodes = "nodes.csv"
springs = "springs.csv"
[[fixed]]
region = "z-"
[[load]]
region = "z+"
kind = "total_force"
value = [0, 0.002, 0]
[[load]]
kind = "gravity"
value = [0, 0, -1]
[[measure]]
name = "reaction"
kind = "reaction"
region = "z-"
component = "y"
"""

MOTION = """over_time = "settled"
[[measure]]
name = "frequency"
kind = "displacement"
node = "x+ y+ z+"
component = "y"
over_time = "frequency"
[[load]]
kind = "gravity"
value = [0, 0, -9.81]
history = [[0, 0], [0.01, 1], [0.02, 1], [0.02, 0.5]]
[[load]]
region = "z+ y+"
kind = "total_force"
value = [0.001, 0, 0]
history = { sine = 40 }
[[moved]]
region = "z+ x-"
displacement = [0.01, 0, 0]
components = ["x"]
history = { ramp = [0, 0.01] }
[[mass]]
region = "z+"
value = 0.0002
[dynamics]
scheme = "generalized_alpha"
rho_infinity = 0.8
step = 0.002
end = 0.06
start = "rest"
write_every = 10
[fem]
mass = "lumped"
[msm]
mass = "uniform"
"""


def damaged(content, chance):
    """One of eight kinds of damage."""
    data = bytearray(content)
    kind = chance.randrange(8)
    if kind == 0:  # bits
        for _ in range(chance.randint(1, 8)):
            data[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
    elif kind == 1:  # cut short
        del data[chance.randrange(len(data)):]
    elif kind == 2:  # a piece lost
        at = chance.randrange(len(data))
        del data[at:at + chance.randint(1, 200)]
    elif kind == 3:  # a piece twice
        at = chance.randrange(len(data))
        data[at:at] = data[at:at + chance.randint(1, 200)]
    elif kind == 4:  # noise
        at = chance.randrange(len(data))
        data[at:at + 16] = chance.randbytes(16)
    else:  # words, or lines, replaced or exchanged
        separator = b"\n" if kind == 5 else b" "
        words = bytes(data).split(separator)
        if kind == 7:
            words[chance.randrange(len(words))] = chance.choice(UNTHOUGHT)
        else:
            a, b = chance.randrange(len(words)), chance.randrange(len(words))
            words[a], words[b] = words[b], words[a]
        data = separator.join(words)
    return bytes(data)


def cube_stl():
    corners = [(float(i & 1) * 3, float(i >> 1 & 1) * 3, float(i >> 2) * 3) for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    lines = ["solid cube"]
    for q in quads:
        for triangle in ((q[0], q[1], q[2]), (q[0], q[2], q[3])):
            lines += ["facet normal 0 0 0", "outer loop"]
            lines += ["vertex {} {} {}".format(*corners[v]) for v in triangle]
            lines += ["endloop", "endfacet"]
    return "\n".join(lines + ["endsolid cube", ""]).encode()


def cube_msh():
    """2 x 1 x 1 hexahedra with the groups z- and z+."""
    nodes = {1 + i + 3 * j + 6 * k: (i, j, k) for k in range(2) for j in range(2) for i in range(3)}
    cell = lambda i: [1 + i, 2 + i, 5 + i, 4 + i, 7 + i, 8 + i, 11 + i, 10 + i]
    side = lambda i, k: [1 + i + 6 * k, 2 + i + 6 * k, 5 + i + 6 * k, 4 + i + 6 * k]
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '2 1 "z-"', '2 2 "z+"', '3 3 "all"', "$EndPhysicalNames",
             "$Entities", "0 0 2 1", "1 0 0 0 2 1 0 1 1 0", "2 0 0 1 2 1 1 1 2 0", "1 0 0 0 2 1 1 1 3 2 1 2", "$EndEntities",
             "$Nodes", f"1 {len(nodes)} 1 {len(nodes)}", f"3 1 0 {len(nodes)}", *map(str, nodes),
             *(f"{x} {y} {z}" for x, y, z in nodes.values()), "$EndNodes", "$Elements", "3 6 1 6"]
    number = 0
    for dimension, entity, kind, elements in ((2, 1, 3, [side(i, 0) for i in range(2)]), (2, 2, 3, [side(i, 1) for i in range(2)]),
                                              (3, 1, 5, [cell(i) for i in range(2)])):
        lines.append(f"{dimension} {entity} {kind} 2")
        for element in elements:
            number += 1
            lines.append(" ".join(map(str, [number, *element])))
    return "\n".join(lines + ["$EndElements", ""]).encode()


def box_skin_vtp():
    """Squares and a strip about the box."""
    corners = [f"{2 * (i & 1)} {2 * (i >> 1 & 1)} {2 * (i >> 2)}" for i in range(8)]
    array = lambda name, values, kind="Int32": f'<DataArray type="{kind}" Name="{name}" format="ascii">\n' + "\n".join(values) + "\n</DataArray>\n"
    squares = ["0 2 3 1", "4 5 7 6", "0 1 5 4", "2 6 7 3", "0 4 6 2"]
    points = array("points", corners, "Float64").replace("Name=", 'NumberOfComponents="3" Name=')
    return ('<?xml version="1.0"?>\n<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian">\n<PolyData>\n'
            '<Piece NumberOfPoints="8" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="1" NumberOfPolys="5">\n'
            f"<Points>\n{points}</Points>\n"
            f'<Strips>\n{array("connectivity", ["1 3 5 7"])}{array("offsets", ["4"])}</Strips>\n'
            f'<Polys>\n{array("connectivity", squares)}{array("offsets", ["4", "8", "12", "16", "20"])}</Polys>\n'
            "</Piece>\n</PolyData>\n</VTKFile>\n").encode()


def grid_vtk():
    """A legacy file in binary, with hexahedra and displacements."""
    node = lambda i, j, k: i + 3 * j + 9 * k
    corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    cells = [[node(i + a, j + b, k + c) for a, b, c in corners] for k in range(2) for j in range(2) for i in range(2)]
    nodes = [(i, j, k) for k in range(3) for j in range(3) for i in range(3)]
    numbers = lambda code, values: struct.pack(f">{len(values)}{code}", *values) + b"\n"
    return b"".join([
        b"# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 27 float\n",
        numbers("f", [x for n in nodes for x in n]), b"CELLS 8 72\n", numbers("i", [v for cell in cells for v in (8, *cell)]),
        b"CELL_TYPES 8\n", numbers("i", [12] * 8), b"POINT_DATA 27\nVECTORS displacement double\n",
        numbers("d", [0.01 * x for n in nodes for x in n])])


def points_vtp():
    """Nodes of the grid with displacements."""
    nodes = [f"{i} {j} {k}" for k in range(3) for j in range(3) for i in range(3)]
    array = '<DataArray type="Float64" Name="u" NumberOfComponents="3" format="ascii">\n' + "\n".join(nodes) + "\n</DataArray>\n"
    return ('<?xml version="1.0"?>\n<VTKFile type="PolyData" version="0.1" byte_order="LittleEndian">\n<PolyData>\n'
            '<Piece NumberOfPoints="27" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="0">\n'
            f"<Points>\n{array}</Points>\n<PointData>\n{array}</PointData>\n</Piece>\n</PolyData>\n</VTKFile>\n").encode()
