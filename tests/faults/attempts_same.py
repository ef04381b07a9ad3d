"""Pairs of cases that have one answer, for attempts.py: a box, and the same turned, mirrored, scaled, renumbered, said in other words."""

import itertools
import json

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]  # gmsh's hexahedron
VERTICES = list(itertools.product((0, 1), repeat=3))
NEAR = 1e-6  # relative to the largest displacement; Newton's method ends at 1e-8 of the load or better
NONLINEAR = 1e-3  # relative: what doubling a load of strains of some 1e-5 shows of the springs' nonlinearity


def face(axis, is_upper):
    return "xyz"[axis] + ("+" if is_upper else "-")


def vertex(at):
    return " ".join(face(axis, at[axis]) for axis in range(3))


class Box:
    """A random case, kept so that it can be changed before it is written."""

    def __init__(self, chance):
        self.edge = chance.choice([0.5, 1, 2.5])
        self.cells = [chance.randint(1, 3) for _ in range(3)]
        self.modulus, self.ratio = 10 ** chance.uniform(-3, 3), chance.uniform(0.05, 0.45)
        self.axis, self.is_upper = chance.randrange(3), chance.random() < 0.5
        self.kind = chance.choice(["traction", "total_force", "nodal_force", "moved"])
        self.vector = [chance.uniform(-1, 1) for _ in range(3)]
        self.size_of_load = 10 ** chance.uniform(-4, -2)
        self.formulation = chance.choice(["small_strain", "log_strain", "saint_venant_kirchhoff"])
        self.element = chance.choice(["q1", "q1", "q1_bbar" if self.formulation != "saint_venant_kirchhoff" else "q1", "q2"])
        self.design = chance.choice(["moduli", "hybrid", "matched", "uniform", "linear_method", "given"])
        self.density, self.step, self.tables, self.halves, self.renumbered, self.symmetry, self.patch = 0, 0, None, 1, None, None, 0

    def load(self):
        """Strains of some size_of_load."""
        across = 1
        for axis in range(3):
            across *= 1 if axis == self.axis else self.cells[axis] * self.edge
        unit = {"traction": self.modulus, "total_force": self.modulus * across,
                "nodal_force": self.modulus * across / max(1, sum(self.cells)), "moved": self.cells[self.axis] * self.edge}[self.kind]
        return [x * self.size_of_load * unit for x in self.vector]

    def region(self, axis, is_upper):
        return "held" if self.renumbered and is_upper == self.is_upper else "loaded" if self.renumbered else face(axis, is_upper)

    def node(self, at):
        return vertex(at) if not self.renumbered else "near " + " ".join(repr(x * n * self.edge) for x, n in zip(at, self.cells))

    def text(self):
        body = f'shape = "box"\nsize = {[n * self.edge for n in self.cells]}\ncells = {self.cells}'
        if self.renumbered:
            body = 'shape = "mesh"\nfile = "body.msh"'
        held, loaded = self.region(self.axis, self.is_upper), self.region(self.axis, not self.is_upper)
        tables = [f'[[fixed]]\nregion = "{held}"\n']
        vector = [x / self.halves for x in self.load()]
        for _ in range(self.halves):
            kind = f'kind = "{self.kind}"\nvalue = {vector}' if self.kind != "moved" else f"displacement = {self.load()}"
            history = f"history = {{ ramp = [0, {self.step * 4!r}] }}\n" if self.step else ""
            tables.append(f'[[{"moved" if self.kind == "moved" else "load"}]]\nregion = "{loaded}"\n{kind}\n{history}')
        if self.symmetry is not None:
            tables.append(f'[[symmetry]]\nplane = "{face(self.symmetry, False)}"\n')
        if self.patch:
            at = [n * self.edge / 2 for n in self.cells]
            at[self.axis] = 0 if self.is_upper else 2 * at[self.axis]
            if self.symmetry is not None:
                at[self.symmetry] = 0
            push = [0, 0, 0]
            push[self.axis] = self.modulus * self.size_of_load
            tables.append(f'[[load]]\nnear = {at}\nradius = {self.patch!r}\nkind = "traction"\nvalue = {push}\n')
        dynamics = f'[dynamics]\nscheme = "newmark"\nstep = {self.step!r}\nend = {6 * self.step!r}\n' if self.step else ""
        tables.append(f'[msm]\ndesign = "{self.design}"\n' + (f"stiffness = {[self.modulus * self.edge * k for k in (310, 470, 330)]}\n" if self.design == "given" else ""))
        tables.append(f'[fem]\nformulation = "{self.formulation}"\nelement = "{self.element}"\n' + ("" if self.step else 'accuracy = "none"\n'))
        for at in VERTICES:
            for axis in range(3):
                tables.append(f'[[measure]]\nname = "{vertex(at)} {"xyz"[axis]}"\nkind = "displacement"\nnode = "{self.node(at)}"\ncomponent = "{"xyz"[axis]}"\n')
        if self.tables:
            self.tables.shuffle(tables)
        density = f"density = {self.density!r}\n" if self.density else ""
        return (f'schema = 1\nname = "same"\n[body]\n{body}\n[material]\nmodel = "linear_elastic"\nyoungs_modulus = {self.modulus!r}\n'
                f"poissons_ratio = {self.ratio!r}\n{density}{dynamics}" + "".join(tables))

    def mesh(self, chance):
        """The same body as a .msh: tags, order of cells and first corner of each by chance."""
        nodes = list(itertools.product(*(range(n + 1) for n in self.cells)))
        tags = dict(zip(nodes, chance.sample(range(1, 10 * len(nodes)), len(nodes))))
        cells = []
        for at in itertools.product(*(range(n) for n in self.cells)):
            turn = chance.choice(TURNS)
            corners = [tuple(at[a] + (c if s > 0 else 1 - c) for a, c, s in zip(range(3), (corner[p] for p in turn[0]), turn[1])) for corner in CORNERS]
            cells.append([tags[corner] for corner in corners])
        chance.shuffle(cells)
        sides = []
        for is_held in (True, False):
            level = self.cells[self.axis] if self.is_upper == is_held else 0
            others = [a for a in range(3) if a != self.axis]
            sides.append([])
            for i, j in itertools.product(range(self.cells[others[0]]), range(self.cells[others[1]])):
                quad = []
                for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    at = [0, 0, 0]
                    at[self.axis], at[others[0]], at[others[1]] = level, i + di, j + dj
                    quad.append(tags[tuple(at)])
                sides[-1].append(quad)
        lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", "3", '2 1 "held"', '2 2 "loaded"', '3 3 "all"', "$EndPhysicalNames",
                 "$Entities", "0 0 2 1", "1 0 0 0 1 1 1 1 1 0", "2 0 0 0 1 1 1 1 2 0", "1 0 0 0 1 1 1 1 3 2 1 2", "$EndEntities",
                 "$Nodes", f"1 {len(nodes)} {min(tags.values())} {max(tags.values())}", f"3 1 0 {len(nodes)}", *(str(tags[n]) for n in nodes),
                 *(" ".join(repr(x * self.edge) for x in n) for n in nodes), "$EndNodes"]
        blocks = [(2, 1, 3, sides[0]), (2, 2, 3, sides[1]), (3, 1, 5, cells)]
        count, number = sum(len(block[3]) for block in blocks), 0
        lines += ["$Elements", f"3 {count} 1 {count}"]
        for dimension, entity, kind, elements in blocks:
            lines.append(f"{dimension} {entity} {kind} {len(elements)}")
            for element in elements:
                number += 1
                lines.append(" ".join(map(str, [number, *element])))
        return "\n".join(lines + ["$EndElements", ""])


def parity(order):
    return sum(order[i] > order[j] for i in range(3) for j in range(i + 1, 3)) % 2


TURNS = [(order, signs) for order in itertools.permutations(range(3)) for signs in itertools.product((1, -1), repeat=3)
         if (-1) ** parity(order) * signs[0] * signs[1] * signs[2] > 0]  # right-handed ones


def answers(attempt, name, text):
    """{side: {(vertex, axis): mm}} of the sides that converged."""
    done = attempt.run("run", "--json", attempt.write(name, text))
    if done is None or attempt.wrong:
        return None
    if done.returncode == 2:
        return attempt.flag("a sound case is refused")
    [case] = json.loads(done.stdout)["cases"]
    values = {measure["name"]: measure for measure in case["measures"]}
    found = {}
    for side in ("fem", "msm"):
        if case[side]["status"] == "converged":
            found[side] = {(at, axis): values[f'{vertex(at)} {"xyz"[axis]}'][side] for at in VERTICES for axis in range(3)}
    return found


def compare(attempt, chance):
    """The first case and another, whose answer follows from the first."""
    first, way = Box(chance), chance.choice(["turned", "longer", "stiffer", "doubled", "renumbered", "halves", "order", "slower", "half"])
    if way == "doubled":
        first.formulation, first.size_of_load = "small_strain", 1e-5
        first.element = chance.choice(["q1", "q1_bbar", "q2"])
    if way == "halves" and first.kind == "moved":
        first.kind = "traction"
    if way == "slower":
        first.density, first.step = 1000, 1e-3
    across = (first.axis + 1) % 3
    if way == "half":
        first.kind = "traction"
        first.vector[across] = 0
        first.cells = [4 if axis == across else 2 for axis in range(3)]
        first.patch = chance.choice([0, 1.1 * first.edge])
    one = answers(attempt, "first.toml", first.text())
    if one is None:
        return
    place, factor, near = (lambda at, axis: (at, axis, 1)), 1, {"fem": NEAR, "msm": NEAR}
    if way == "turned":
        order, signs = chance.sample(range(3), 3), [chance.choice([1, -1]) for _ in range(3)]  # mirrored ones too
        moved_to = {old: new for new, old in enumerate(order)}
        load = first.vector
        second = first
        second.cells = [first.cells[old] for old in order]
        second.vector = [load[old] * signs[new] for new, old in enumerate(order)]
        new_axis = moved_to[first.axis]
        second.is_upper = first.is_upper if signs[new_axis] > 0 else not first.is_upper
        second.axis = new_axis
        place = lambda at, axis: (tuple(at[old] if signs[new] > 0 else 1 - at[old] for new, old in enumerate(order)), moved_to[axis], signs[moved_to[axis]])
    elif way == "half":
        first.symmetry, first.cells[across] = across, 2
        one = {side: {at: value for at, value in values.items() if at[0][across]} for side, values in one.items()}
    elif way == "longer":
        factor = chance.choice([0.01, 3, 1000])
        first.edge *= factor
    elif way == "stiffer":
        first.modulus *= chance.choice([1e-3, 7, 1e4])
    elif way == "doubled":
        factor, first.size_of_load, near = 2, 2e-5, {"fem": NEAR, "msm": NONLINEAR}
    elif way == "renumbered":
        first.renumbered = True
        attempt.write("body.msh", first.mesh(chance))
    elif way == "halves":
        first.halves = chance.randint(2, 4)
    elif way == "order":
        first.tables = chance
    elif way == "slower":
        times = chance.choice([0.1, 3])
        first.density, first.step = first.density * times ** 2, first.step * times
    other = answers(attempt, "second.toml", first.text())
    if other is None:
        return
    attempt.words.append(f"({way}{' with a patch' if first.patch else ''}, {first.design}, {first.formulation} {first.element}, {first.kind})")
    for side in ("fem", "msm"):
        if (side in one) != (side in other):
            attempt.flag(f"{way}: {side} converged in one of two")
        if side not in one or side not in other:
            continue
        largest = max(abs(value) for value in one[side].values()) * factor
        for (at, axis), value in one[side].items():
            at, axis, sign = place(at, axis)
            if not abs(other[side][at, axis] - sign * factor * value) <= near[side] * largest:
                attempt.flag(f"{way}: {side} has {other[side][at, axis]!r} for {sign * factor * value!r}, at most {largest!r}")
