"""Solves a scene of springproof's with GetFEM: quadratic elements on meshes that it refines itself.

Usage: getfem_peer.py SCENE ANSWER

SCENE is a line of JSON that lists the arrays after it, little-endian doubles; mm, N, MPa. ANSWER has the same form.
compare/peers/getfem.cpp writes the one and reads the other.

Displacements are Q2 on hexahedra and P2 on tetrahedra. Where the pressure matters it is a field of its own, of degree 1
and continuous (Taylor and Hood) but for jumps between materials.
"""

import json
import sys

try:
    import getfem as gf
    import numpy as np
except ImportError:
    sys.exit(3)  # which says that there is no GetFEM

RESIDUAL = 1e-7  # relative to the loads, or to the reactions where only supports move: far below what meshes err by
MOST_UNKNOWNS = 60_000  # whose tangent a direct solver factorises in some ten seconds
MOST_ITERATIONS, SMALLEST_STEP = 25, 1 / 64
DEFORMATION = "(Id(3)+Grad_u)"


def read_message(path):
    """Returns the header, and the arrays by name."""
    with open(path, "rb") as file:
        header, arrays = json.loads(file.readline()), {}
        for one in header["arrays"]:
            rows, columns = one["shape"]
            arrays[one["name"]] = np.frombuffer(file.read(8 * rows * columns), "<f8").reshape(rows, columns)
    return header, arrays


def write_message(path, header, arrays):
    header["arrays"] = [{"name": name, "shape": list(values.shape)} for name, values in arrays.items()]
    with open(path, "wb") as file:
        file.write(json.dumps(header).encode() + b"\n")
        for values in arrays.values():
            file.write(np.ascontiguousarray(values, "<f8").tobytes())


class Lattice:
    """The nodes of a cell's quadratic element: each is the mean of the cell's vertices `parents`."""

    def __init__(self, vertices, powers, parents, children, family, integration):
        self.parents, self.children = parents, children
        self.transformation = gf.GeoTrans(f"GT_{family}(3,1)")
        self.displacement, self.pressure, self.constant = (gf.Fem(f"FEM_{family}(3,{n})") for n in (2, 1, 0))
        self.integration = gf.Integ(integration)
        places = np.array([np.mean([vertices[v] for v in one], axis=0) for one in parents])

        def monomials(x):
            return np.prod(x[:, None, :] ** np.array(powers), axis=2)

        def nodes_in(child):
            return np.array([np.mean(places[[child[v] for v in one]], axis=0) for one in parents])

        # The shape functions of the cell at the nodes of its children.
        to_coefficients = np.linalg.inv(monomials(places))
        self.interpolation = np.array([monomials(nodes_in(child)) @ to_coefficients for child in children])


def hexahedron():
    """Returns the nodes in GetFEM's order, x fastest, as the vertices are."""
    places = [(i, j, k) for k in range(3) for j in range(3) for i in range(3)]
    sides = [[0], [0, 1], [1]]
    parents = [[x + 2 * y + 4 * z for z in sides[k] for y in sides[j] for x in sides[i]] for i, j, k in places]
    vertices = [(i, j, k) for k in range(2) for j in range(2) for i in range(2)]
    children = [[places.index((a + i, b + j, c + k)) for i, j, k in vertices] for a, b, c in vertices]
    return Lattice(vertices, places, parents, children, "QK", "IM_GAUSS_PARALLELEPIPED(3,5)")


def tetrahedron():
    """The children are Bey's: one at each vertex, and four around a diagonal of the octahedron that is left."""
    parents = [[0], [0, 1], [1], [0, 2], [1, 2], [2], [0, 3], [1, 3], [2, 3], [3]]
    at = {tuple(p): n for n, p in enumerate(parents)}
    of_vertices = ["0 01 02 03", "01 1 12 13", "02 12 2 23", "03 13 23 3"]
    around_diagonal = ["01 02 03 13", "01 02 12 13", "02 03 13 23", "02 12 13 23"]
    children = [[at[tuple(map(int, node))] for node in child.split()] for child in of_vertices + around_diagonal]
    vertices = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    powers = [(i, j, k) for k in range(3) for j in range(3) for i in range(3) if i + j + k <= 2]
    return Lattice(vertices, powers, parents, children, "PK", "IM_TETRAHEDRON(5)")


class Mesh:
    """Cells, and the parts of the body's surface that supports and loads have: rows of one to four nodes."""

    def __init__(self, nodes, cells, parts, lattice):
        self.nodes, self.cells, self.parts, self.lattice = nodes, cells, parts, lattice
        self.middles = {}
        self.all_nodes = [tuple(x) for x in nodes]
        self.of_cells = np.array([[self.middle(cell[p]) for p in lattice.parents] for cell in cells])

    def middle(self, vertices):
        """Returns the node of the mesh refined once that is the mean of these vertices."""
        if len(vertices) == 1:
            return int(vertices[0])
        key = tuple(sorted(vertices))
        if key not in self.middles:
            self.middles[key] = len(self.all_nodes)
            self.all_nodes.append(tuple(self.nodes[list(key)].mean(axis=0)))
        return self.middles[key]

    def split(self, part):
        """Returns the parts that a node, an edge, a triangle or a quadrilateral falls into."""
        if len(part) == 1:
            return [part]
        between = [self.middle([part[v], part[(v + 1) % len(part)]]) for v in range(len(part))]
        if len(part) == 2:
            return [[part[0], between[0]], [between[0], part[1]]]
        corners = [[part[v], between[v], between[v - 1]] for v in range(len(part))]
        if len(part) == 3:
            return corners + [between]
        centre = self.middle(part)
        return [[vertex, after, centre, before] for vertex, after, before in corners]

    def refined(self):
        parts = [[child for part in some for child in self.split(part)] for some in self.parts]
        cells = self.of_cells[:, self.lattice.children].reshape(-1, self.cells.shape[1])
        return Mesh(np.array(self.all_nodes), cells, parts, self.lattice)


def law(name, material, unknown):
    """Returns the weak form of the internal forces in GetFEM's language: P : Grad_Test_u, and the equation of the pressure.

    The law is linear in the small strain, Saint Venant and Kirchhoff's, linear between Cauchy's stress and the logarithmic
    strain, Ogden's or Yeoh's. `unknown` names the pressure's field; without one the pressure is the law's at every point.
    """
    mu, kappa = material["mu"], material["kappa"]
    f = DEFORMATION
    b, j = f"({f}*{f}')", f"Det({f})"
    strain = f"(0.5*({f}'*{f}-Id(3)))"
    # The pressure is its modulus times what changes with the volume. Stress is conjugate to Grad_Test_u once `left`
    # and `right` are beside it: Cauchy's as it is, the second of Piola and Kirchhoff, or Kirchhoff's.
    if name == "small_strain":
        modulus, volume, scale = kappa, "Trace(Grad_u)", "1"
        stress, left, right = f"{2 * mu}*Deviator(Sym(Grad_u))", "", ""
    elif name == "saint_venant_kirchhoff":
        modulus, volume, scale = kappa - 2 * mu / 3, f"Trace({strain})", "1"
        stress, left, right = f"{2 * mu}*{strain}", f"{f}*", ""
    elif name == "log_strain":
        modulus, volume, scale = kappa, f"log({j})", j  # Cauchy's stress is linear in the strain
        stress, left, right = f"{j}*{mu}*Deviator(Logm({b}))", "", f"*Inv({f})'"
    else:
        modulus, volume, scale = kappa, f"(({j}-1/{j})/2)", j
        left, right = "", f"*Inv({f})'"
        powers = {2: b, -2: f"Inv({b})", 4: f"({b}*{b})", -4: f"(Inv({b})*Inv({b}))"}
        stress = "+".join(
            f"({2 * mu_i / alpha})*pow({j},{-alpha / 3})*Deviator({powers.get(alpha) or f'Expm({alpha / 2}*Logm({b}))'})"
            for mu_i, alpha in material.get("terms", ())
        )
        if "yeoh" in material:
            i, (c10, c20, c30) = f"(pow({j},-2/3)*Trace({b})-3)", material["yeoh"]
            stress = f"2*({c10}+{2 * c20}*{i}+{3 * c30}*sqr({i}))*pow({j},-2/3)*Deviator({b})"
    pressure = unknown or f"({modulus})*{volume}"
    form = f"({left}({stress}+{scale}*{pressure}*Id(3)){right}):Grad_Test_u"
    return form + (f"+({unknown}/({modulus})-{volume})*Test_{unknown}" if unknown else "")


def turned(motion, nodes):
    """Returns a function of the load factor: where a support's nodes are moved to, less where they are."""
    axis, centre = np.array(motion["axis"]), np.array(motion["centre"])
    arm = nodes - centre

    def at(factor):
        angle = np.radians(factor * motion["angle"])
        across = np.cross(axis, arm)
        turn = np.sin(angle) * across + (1 - np.cos(angle)) * np.cross(axis, across)
        return factor * np.array(motion["displacement"]) + turn

    return at


class Body:
    """GetFEM's model of a scene on one mesh."""

    def __init__(self, header, material, mesh):
        self.header, self.mesh = header, mesh
        lattice = mesh.lattice
        self.gf_mesh = gf.Mesh("empty", 3)
        for cell in mesh.cells:
            self.gf_mesh.add_convex(lattice.transformation, mesh.nodes[cell].T)
        if self.gf_mesh.nbpts() != len(np.unique(mesh.cells)):
            raise ValueError("nodes at the same place, such as a cut's, would be glued")
        self.u = gf.MeshFem(self.gf_mesh, 3)
        self.u.set_fem(lattice.displacement)
        self.constant = gf.MeshFem(self.gf_mesh, 1)
        self.constant.set_fem(lattice.constant)
        self.integration = gf.MeshIm(self.gf_mesh, lattice.integration)
        self.find_dofs()
        self.find_constrained()
        self.make_model(material)

    def find_dofs(self):
        """Finds the first of the three degrees of freedom of each node of the quadratic elements."""
        self.dof_of_node = np.full(len(self.mesh.all_nodes), -1)
        for c, nodes in enumerate(self.mesh.of_cells):
            self.dof_of_node[nodes] = self.u.basic_dof_from_cvid(c)[0][::3]
        places = self.u.basic_dof_nodes()[:, self.dof_of_node].T
        size = np.ptp(self.mesh.nodes, axis=0).max()
        if not np.abs(places - np.array(self.mesh.all_nodes)).max() < 1e-9 * size:
            raise AssertionError("GetFEM numbers the nodes of its elements otherwise than this program")

    def nodes_of(self, parts):
        """Returns the nodes of the elements on parts of the surface."""
        return np.unique([node for part in parts for child in self.mesh.split(part) for node in child])

    def find_constrained(self):
        self.values = []  # degrees of freedom, and their displacements as a function of the load factor
        constrained = []
        for support in self.header["supports"]:
            nodes = self.nodes_of(self.mesh.parts[support["parts"]])
            for axis in support["components"]:
                constrained.append(self.dof_of_node[nodes] + axis)
        for motion in self.header["motions"]:
            nodes = self.nodes_of(self.mesh.parts[motion["parts"]])
            at = turned(motion, np.array(self.mesh.all_nodes)[nodes])
            for axis in motion["components"]:
                self.values.append((self.dof_of_node[nodes] + axis, axis, at))
        self.constrained = np.unique(np.concatenate(constrained)) if constrained else np.array([], int)

    def make_model(self, material):
        header = self.header
        self.model = gf.Model("real")
        self.model.add_fem_variable("u", self.u)
        parts = [(1 + m, one, np.flatnonzero(material == m)) for m, one in enumerate(header["materials"])]
        parts = [part for part in parts if len(part[2]) > 0]  # later materials may have all cells of an earlier one
        for number, _, cells in parts if header["mixed"] else []:
            pressure = gf.MeshFem(self.gf_mesh, 1)
            pressure.set_fem(self.mesh.lattice.pressure, cells)
            self.model.add_fem_variable(f"p{number}", pressure)
        first = self.model.interval_of_variable("u")[0]  # a model's variables are in alphabetical order
        self.constrained += first
        self.values = [(dofs + first, axis, at) for dofs, axis, at in self.values]
        self.model.add_initialized_data("factor", [1.0])
        for number, one, cells in parts:
            self.gf_mesh.set_region(number, np.array([cells, np.full(len(cells), -1)]))
            form = law(header["law"], one, f"p{number}" if header["mixed"] else None)
            self.model.add_nonlinear_term(self.integration, form, number)
            self.add_load(f"[{','.join(str(one['density'] * a) for a in header['acceleration'])}]", number)
        faces = self.outer_faces()
        for number, load in enumerate(header["loads"], 1 + len(header["materials"])):
            loaded = [faces[tuple(sorted(face))] for face in self.mesh.parts[load["parts"]]]
            self.gf_mesh.set_region(number, np.array(loaded).T)
            components = [
                f"({constant})" + "".join(f"+({slope})*X({axis})" for axis, slope in enumerate(slopes, 1))
                for constant, slopes in zip(load["constant"], load["gradient"])
            ]
            self.add_load(f"[{','.join(components)}]", number)

    def add_load(self, force, region):
        self.model.add_nonlinear_term(self.integration, f"-factor*({force}).Test_u", region)

    def outer_faces(self):
        """Returns the cell and GetFEM's number of each outer face, by its vertices."""
        number = np.empty(self.gf_mesh.nbpts(), int)
        for c, cell in enumerate(self.mesh.cells):
            number[self.gf_mesh.pid_from_cvid(c)[0]] = cell
        outer = self.gf_mesh.outer_faces()
        return {tuple(sorted(number[self.gf_mesh.pid_in_faces(face[:, None])])): face for face in outer.T}

    def displacement(self):
        return self.model.variable("u")

    def at_nodes(self):
        """Returns the displacement of the elements' nodes."""
        return self.displacement()[self.dof_of_node[:, None] + np.arange(3)]

    def interpolated(self, coarse):
        """Returns the displacement of a body on the mesh that this one was refined from."""
        of_cells = coarse.at_nodes()[coarse.mesh.of_cells]
        values = np.einsum("rnm,cmx->crnx", self.mesh.lattice.interpolation, of_cells)
        displacement = np.zeros(self.u.nbdof())
        dofs = self.dof_of_node[self.mesh.of_cells.reshape(*values.shape[:3])]
        displacement[dofs[..., None] + np.arange(3)] = values
        return displacement

    def residual(self):
        """Returns the imbalance of all equations, and what it is measured against: the loads, or the reactions."""
        self.model.assembly("build_rhs")
        imbalance = self.model.rhs()
        reactions = np.linalg.norm(imbalance[self.constrained])
        imbalance[self.constrained] = 0
        return imbalance, self.load_norm or reactions

    def step_to(self, factor):
        """Takes Newton's steps at a load factor from where the body is.  Returns whether they converge."""
        unknown = self.model.from_variables()
        prescribed = unknown.copy()
        for dofs, axis, at in self.values:
            prescribed[dofs] = at(factor)[:, axis]
        change = prescribed - unknown
        change[self.free] = 0
        self.model.set_variable("factor", [factor])
        for iteration in range(MOST_ITERATIONS):
            self.model.assembly("build_all")
            tangent, imbalance = self.model.tangent_matrix(), self.model.rhs()
            imbalance -= tangent.mult(change)
            imbalance[self.constrained] = 0
            tangent.clear(self.constrained, self.all)
            tangent.clear(self.all, self.constrained)
            tangent.add(self.constrained, self.constrained, gf.Spmat("identity", len(self.constrained)))
            unknown = unknown + change + gf.linsolve_mumps(tangent, imbalance).ravel()
            if not np.isfinite(unknown).all():
                return False
            change[:] = 0
            self.model.to_variables(unknown)
            self.n_iterations += 1
            left, scale = self.residual()
            self.relative = np.linalg.norm(left) / scale if scale > 0 else 0.0
            if self.relative <= RESIDUAL:
                return True
            if not self.relative < 1e6:
                return False
        return False

    def solve(self, start):
        """Solves at full load, from a coarser mesh's displacement where there is one, else from rest.

        Returns the load factor reached.
        """
        n = self.model.nbdof()
        self.all = np.arange(n)
        self.free = np.setdiff1d(self.all, self.constrained)
        self.n_iterations = 0
        self.load_norm = 0
        self.model.assembly("build_rhs")  # at rest, where there are no internal forces
        self.load_norm = np.linalg.norm(self.model.rhs()[self.free])
        if start is not None:
            self.model.set_variable("u", start)
            if self.step_to(1.0):
                return 1.0
        unknown, reached, step = np.zeros(n), 0.0, 1.0
        while reached < 1:
            self.model.to_variables(unknown)
            if self.step_to(min(1.0, reached + step)):
                reached = min(1.0, reached + step)
                unknown = self.model.from_variables()
            else:
                step /= 2
                if step < SMALLEST_STEP:
                    return reached
        return reached

    def integrals(self, form):
        """Returns the integral of a scalar over each cell."""
        n = self.constant.nbdof()
        known, sought = ("u", 0, self.u, self.displacement()), ("one", 1, self.constant, np.zeros(n))
        return gf.asm_generic(self.integration, 1, f"({form})*Test_one", -1, *known, *sought).ravel()[-n:]

    def answer(self, level, n_nodes, n_cells):
        """Returns what the body's own nodes and cells have of the solution."""
        displacement = self.at_nodes()
        volumes = self.integrals(f"Det({DEFORMATION})")
        rest, squares = self.integrals("1").sum(), self.integrals("u.u").sum()
        header = {
            "refine": level,
            "unknowns": len(self.free),
            "iterations": self.n_iterations,
            "residual": self.relative,
            "root_mean_square": float(np.sqrt(squares / rest)),
            "largest": float(np.linalg.norm(displacement, axis=1).max()),
            "inverted": int((volumes <= 0).sum()),
        }
        return header, displacement[:n_nodes], volumes.reshape(n_cells, -1).sum(axis=1)[:, None]


def main():
    header, arrays = read_message(sys.argv[1])
    gf.util("trace level", 0)
    kind = "hexahedra" if "hexahedra" in arrays else "tetrahedra"
    parts = [sum((arrays[name].astype(int).tolist() for name in names), []) for names in header["parts"]]
    lattice = hexahedron() if kind == "hexahedra" else tetrahedron()
    mesh = Mesh(arrays["nodes"], arrays[kind].astype(int), parts, lattice)
    n_nodes, n_cells = len(mesh.nodes), len(mesh.cells)
    meshes, found, reason, failed, coarse = [], {}, "", False, None
    for level in range(header["meshes"]):
        material = np.repeat(arrays["material_of_cell"][:, 0].astype(int), 8**level)
        pressures = [len(np.unique(mesh.cells[material == one])) for one in np.unique(material)]
        unknowns = 3 * len(mesh.all_nodes) + (sum(pressures) if header["mixed"] else 0)
        if unknowns > MOST_UNKNOWNS:
            reason = f"it has {unknowns} unknowns, of which at most {MOST_UNKNOWNS} are solved here"
            break
        body = Body(header, material, mesh)
        reached = body.solve(coarse and body.interpolated(coarse))
        if reached < 1:
            reason, failed = f"Newton's method stops at {reached:.4g} of the load, mesh {level}", True
            break
        one, found[f"displacement_{level}"], found[f"volume_{level}"] = body.answer(level, n_nodes, n_cells)
        meshes.append(one)
        coarse = body
        mesh = mesh.refined()
    write_message(sys.argv[2], {"meshes": meshes, "reason": reason, "failed": failed}, found)


if __name__ == "__main__":
    main()
