// What the springs of a case are: their stiffnesses by kind, the moduli of their lattice, and how far it is stable.
"use strict";
const kinds_of_springs = ["edge", "face diagonal", "body diagonal"];

// Springs of one kind and stiffness: { kind, axes: the ways in which they lie, n: in a cell, stiffness, exponent }.
function kinds_of(springs) {
  const powers = springs.exponents || [];
  if (springs.stiffness_N_per_m)
    return [12, 12, 4].map((n, kind) => ({ kind, axes: new Set(), n, stiffness: springs.stiffness_N_per_m[kind], exponent: powers[kind] }));
  const found = new Map(), of_cell = springs.cell ? springs.cell.springs : [];
  const is_tetrahedron = of_cell.every((spring) => Math.max(...spring.vertices) < 4); // all of its springs are edges
  for (const spring of of_cell) {
    const [from, to] = spring.vertices, axes = is_tetrahedron ? [] : [0, 1, 2].filter((axis) => ((from ^ to) >> axis) & 1);
    const kind = is_tetrahedron ? 0 : axes.length - 1;
    const key = [kind, general(spring.stiffness_N_per_m), spring.exponent].join(" ");
    if (!found.has(key)) found.set(key, { kind, axes: new Set(), n: 0, stiffness: spring.stiffness_N_per_m, exponent: spring.exponent });
    if (!is_tetrahedron) found.get(key).axes.add(axes.map((axis) => "xyz"[axis]).join(""));
    ++found.get(key).n;
  }
  return [...found.values()].sort((a, b) => a.kind - b.kind);
}

function stiffness_table(springs) {
  const all = kinds_of(springs), has_exponents = all.some((one) => !missing(one.exponent));
  const name = (one) => kinds_of_springs[one.kind] + (one.axes.size > 0 && one.axes.size < 3 && one.kind < 2
    ? ` ${one.kind === 0 ? "along" : "in the plane"} ${[...one.axes].join(", ")}` : "");
  const rows = all.map((one) => row([row_head(name(one)), cell(one.n), cell(general(one.stiffness, 5)), text_cell("N/m"),
    has_exponents && cell(general(one.exponent, 4))]));
  const more = (what, n, value, unit, exponent = "–") =>
    rows.push(row([row_head(what), cell(n), cell(value), text_cell(unit), has_exponents && cell(exponent)]));
  const of_edges = all.find((one) => one.kind === 0); // midlines have the law of the edges beside them
  const midline = (what, n, stiffness) =>
    more(what, n, general(stiffness, 5), "N/m", of_edges && has_exponents ? general(of_edges.exponent, 4) : "–");
  if (springs.midline_stiffness_N_per_m) midline(["midline, between centres of faces ", symbol("k", "m")], 3, springs.midline_stiffness_N_per_m);
  for (const own of springs.cell ? springs.cell.midlines : []) midline(`midline along ${own.axis}`, 1, own.stiffness_N_per_m);
  if (springs.volume_stiffness_MPa) more(["volume term ", symbol("k", "v")], 1, general(springs.volume_stiffness_MPa, 5), "MPa");
  const tetrahedra = springs.cell ? springs.cell.tetrahedra : [];
  if (tetrahedra.length > 0)
    more("tetrahedron of biquadratic springs, Lamé’s λ and μ", tetrahedra.length,
      `${general(tetrahedra[0].lambda_MPa, 5)}, ${general(tetrahedra[0].mu_MPa, 5)}`, "MPa");
  if (rows.length === 0) return make("p", null, "Every spring has its own stiffness and rest length, from the case’s file.");
  return table("springs", "Stiffnesses of a cell; springs that cells share have the sum", row([text_head("spring"), head("in a cell"), head("stiffness"), text_head("unit"),
    has_exponents && head("exponent")]), body(rows));
}

const names_of_moduli = { zener: ["Zener ratio", ""], youngs_modulus: ["Young’s modulus along an axis", "MPa"],
  poissons_ratio: ["Poisson’s ratio along an axis", ""], shear_modulus: ["shear modulus between axes", "MPa"],
  youngs_modulus_along: ["Young’s modulus along the fibre", "MPa"], youngs_modulus_across: ["Young’s modulus across it", "MPa"],
  poissons_ratio_along: ["Poisson’s ratio along the fibre", ""], poissons_ratio_across: ["Poisson’s ratio across it", ""],
  shear_modulus_along: ["shear modulus along the fibre", "MPa"], misfit_percent: ["largest misfit of a strain’s energy", "%"] };

function moduli_table(moduli) {
  if (!moduli || Object.values(moduli).every((value) => !value)) return null;
  const line = ([key, value]) => {
    const [name, unit] = names_of_moduli[key] || [symbol("C", key.slice(1)), "MPa"];
    return row([row_head(name), cell(general(value, 5)), text_cell(unit)]);
  };
  return table("moduli", "Small-strain moduli of the lattice, means over its axes", null, body(Object.entries(moduli).map(line)));
}

function stability_table(stability) {
  if (!stability) return null;
  const limit = (key) => (stability[key] === stability.searched[key] ? `beyond ${general(stability[key], 3)}` : general(stability[key], 4));
  const line = (name, key) => row([row_head(name), cell(limit(key))]);
  return table("stability", "How far the lattice is stable", null, body([line("stretch along an axis, to", "stretch"),
    line("compression along an axis, to a stretch of", "compression"), line("simple shear, to", "simple_shear")]));
}

function case_springs() {
  const springs = report.springs;
  if (!springs) return null;
  const of = springs.kinds_of_cells > 2 ? " The first cell is shown; others have springs of their own." : "";
  return [make("p", null, in_words(springs.design), ": ", words(springs.what), ".", of, " ", make("span", { class: "quiet" },
    springs.published_in)), make("div", { class: "side-by-side" }, stiffness_table(springs), moduli_table(springs.moduli),
  stability_table(springs.stability))];
}
