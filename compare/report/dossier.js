// A dossier: what a simulation is for, why it can be believed and how far, and what nobody has shown. Each number leads to its gate.
"use strict";
const dossier = report.dossier;
const gate_ids = new Map(dossier ? dossier.gates.map((gate, i) => [gate.name, `gate-${i}`]) : []);

// The gates that hold a number, as links; "no gate" says that none does.
const gate_links = (names) => (names.length === 0 ? make("span", { class: "quiet" }, "no gate")
  : names.map((name, i) => [i > 0 && ", ", make("a", { href: "#" + gate_ids.get(name) }, name)]));
const gate_cell = (names) => cell(gate_links(names), "gates");
// A number with its power of ten where it is small.
const figure = (value, digits = 6) => (missing(value) || value === 0 || Math.abs(value) >= 1e-3 ? general(value, digits)
  : Number(value.toPrecision(digits)).toExponential().replaceAll("-", "−"));
const of_case = (one) => row_head(one.case || "all");
const yes_or_no = (value) => (missing(value) ? "–" : value ? "yes" : "no");
const range = (pair, shown = (value) => general(value, 3)) => (missing(pair) ? "–" : pair[0] === pair[1] ? shown(pair[0])
  : `${shown(pair[0])} to ${shown(pair[1])}`);
const bold = (text) => make("b", null, text);

// What a section lacks, and what would fill it.
function lacks(section) {
  const all = dossier.missing.filter((one) => one.section === section);
  return all.length > 0 && make("div", { class: "problem" }, bold("Missing"), make("ul", null, all.map((one) => make("li", null,
    one.case && `${one.case}: `, typeset(one.what), ". ", make("span", { class: "quiet" }, "Filled by ", one.filled_by, ".")))));
}
// Factors that a section speaks to.
const factors = (...names) => quiet("Factors: ", names.join("; "), ".");
const heads = (texts, units) => row(texts.map((text, i) => (i < units ? text_head(text) : head(text))));

function dossier_context() {
  if (!dossier) return null;
  const { context } = dossier, said = (text) => text || make("em", null, "missing");
  const in_time = ["density", "mass_damping", "stiffness_damping", "prony"];
  const material = (one) => Object.entries(one).filter(([key, value]) => !missing(value) && !in_time.includes(key))
    .map(([key, value]) => `${in_words(key)} ${typeof value === "string" ? in_words(value) : [value].flat().map((v) => general(v)).join(", ")}`)
    .join("; ");
  // What a material adds to its elasticity, where there is anything.
  const inertia = (one) => [!missing(one.density) && `density ${general(one.density)} kg/m³`,
    one.mass_damping > 0 && `mass damping ${figure(one.mass_damping)} 1/s`,
    one.stiffness_damping > 0 && `stiffness damping ${figure(one.stiffness_damping)} s`,
    ...one.prony.map(({ g, k, tau }) => `memory g ${figure(g)}, k ${figure(k)}, τ ${figure(tau)} s`)].filter(Boolean).join("; ");
  const inertias = (materials) => (materials.some(inertia) ? materials.map((one) => inertia(one) || "nothing").join(" | ") : "");
  const place = (xyz) => `(${xyz.map((x) => general(x, 4)).join(", ")}) mm`;
  const tool = (one) => [`${one.name}: ${in_words(one.shape)}`,
    one.path ? `path ${one.path.map(([time, ...xyz]) => `${figure(time)} s ${place(xyz)}`).join(", ")}`
      : `at ${place(one.at_mm)}, moved by ${place(one.displacement_mm)}`, `friction ${general(one.friction)}`].join("; ");
  const force = ({ force_N }) => (force_N ? `total (${force_N.map((f) => general(f, 4)).join(", ")}) N` : "by histories");
  const one_case = (one) => [make("h3", null, one.case), make("p", null, one.description), make("dl", { class: "facts" },
    [["body", `${one.body.size_mm.map((x) => general(x, 4)).join(" × ")} mm, ${one.body.cells} cells, ${one.body.nodes} nodes`],
      ["material, MPa", one.materials.map(material).join(" | ")], ["in time", inertias(one.materials)], ["loads", force(one.loads)],
      ["tools", one.tools.map(tool).join(" | ")], ["finite elements", in_words(one.fem)],
      ["springs", in_words(one.springs)], ["file", `${one.file}; SHA-256 ${one.sha256}`]].filter(([, value]) => value)
      .map(([name, value]) => [make("dt", null, name), make("dd", { class: "wide" }, value)])),
  table("quantities", "Quantities of interest", heads(["measure", "kind", "unit", "gates"], 4), body(one.quantities.map((q) =>
    row([row_head(typeset(q.measure)), text_cell(in_words(q.kind)), text_cell(typeset(q.unit)), gate_cell(q.gates)])))),
  folded("The case file", make("pre", null, one.text))];
  return [make("p", null, dossier.method), factors("question of interest", "context of use", "influence of the model", "consequence of a decision"),
    make("dl", { class: "facts" }, [["question", context.question], ["role of the model", context.role],
      ["a wrong answer", context.consequence]].map(([name, text]) => [make("dt", null, name), make("dd", { class: "wide" }, said(text))])),
    context.settings.length > 0 && make("p", null, "Keys set on the command line: ", code(context.settings.join(" "))),
    lacks("context"), context.cases.map(one_case)];
}

const gate_rows = (gates) => gates.map((gate) => make("tr", { id: gate_ids.get(gate.name) }, row_head(typeset(gate.name)),
  text_cell(gate.kind), cell(figure(gate.value, 9)), text_cell(typeset(gate.unit)),
  text_cell(`[${gate.interval.map((end) => figure(end, 10)).join(", ")}]`),
  text_cell(gate.met ? "met" : make("strong", null, gate.judged ? "missed" : "not judged")), cell([typeset(gate.asserts), reason_of(gate.reason)],
    "long")));
const gate_table = (name, title, gates) => gates.length > 0 && table(name, title,
  heads(["gate", "kind", "value", "unit", "interval", "met", "what it asserts"], 7), body(gate_rows(gates)));
const is_own = (gate) => gate.name.startsWith("springproof/");

function peer_table(name, rows) {
  const found = rows.filter((one) => one.status === "converged");
  return found.length > 0 && table(name, "Other programs", row([["case", "measure", "program", "compares"].map((t) => text_head(t)),
    ["ours", "theirs"].map((t) => head(t)), text_head("unit"), head("apart, %"), text_head("within both bars"), text_head("gate of ours")]),
  body(found.map((one) => row([of_case(one), text_cell(typeset(one.measure)), text_cell(one.program), text_cell(one.compares),
    cell(with_bar(one.fem, one.fem_uncertainty, figure)), cell(one.reason ? reason_of(one.reason) : with_bar(one.peer, one.peer_uncertainty, figure)),
    text_cell(typeset(one.unit)), cell(general(one.difference_percent, 2)), text_cell(yes_or_no(one.within_bars)), gate_cell(one.gates)]))));
}

function dossier_code() {
  if (!dossier) return null;
  const { cases, orders, peers, tests } = dossier.code_verification, own = dossier.gates.filter(is_own);
  const order = (one) => row([of_case(one), text_cell(one.model), text_cell(typeset(one.measure)), cell(one.values.map((v) => figure(v)).join(", ")),
    text_cell(typeset(one.unit)), cell(missing(one.order) ? reason_of(one.reason) : number(one.order)), cell(general(one.formal)),
      gate_cell(one.gates)]);
  const parts = [...new Set(tests.map((test) => test.part))];
  return [factors("quality of the software", "verification of the numerical code"),
    make("p", null,
      "This build solved the program’s own cases for this dossier. A gate of kind exact holds a formula, converged a limit, " +
      "peer another program’s value, regression our own earlier result, which verifies nothing."),
    make("ul", null, cases.map((one) => make("li", null, bold(one.case), ": ", typeset(one.description)))),
    gate_table("own-gates", "Gates of the program’s own cases", own),
    orders.length > 0 && table("orders", "Orders of convergence, on meshes of 1, 1/2, 1/4 … of the width", row([["case", "model",
      "measure"].map((t) => text_head(t)),
      head("values"), text_head("unit"), head("observed order"), head("element’s order"), text_head("gate of its limit")]), body(orders.map(order))),
    quiet("An element reaches its order where the solution is smooth. The edge of a clamped face lowers it."),
    peer_table("own-peers", peers), lacks("code_verification"),
    folded(`${tests.length} groups of tests of the project, which were not run for this dossier`, parts.map((part) => table("tests", part,
      heads(["what is checked", "against", "where"], 3), body(tests.filter((test) => test.part === part).map((test) => row([make("th",
        { scope: "row", class: "text long" }, test.checked),
        cell(test.against, "long"), text_cell(test.where || "–")]))))))];
}

// A part of a model's error, or why it is not known.
const known_part = (budget, name) => cell(!budget ? "–" : missing(budget[name].percent) ? reason_of(budget[name].reason || budget.reason)
  : budget[name].reason ? "0" : with_bar(budget[name].percent, budget[name].uncertainty || null, signed));

function dossier_calculation() {
  if (!dossier) return null;
  const one_case = (one) => {
    const values = (m) => row([row_head([typeset(m.measure), ", ", typeset(m.unit)]), cell(figure(m.fem)), gate_cell(m.gates.fem),
      cell(missing(m.fem_limit) ? reason_of(m.note) : with_bar(m.fem_limit, m.fem_limit_uncertainty, figure)), cell(number(m.order)),
        cell(figure(m.msm)),
      gate_cell(m.gates.msm), cell(with_bar(m.error_percent, m.error_uncertainty_percent, signed)), gate_cell(m.gates.error_percent)]);
    const parts = (m) => [["finite elements", m.parts.fem], ["springs", m.parts.msm]].map(([model, budget]) => budget && !missing(budget.whole)
      && row([row_head(typeset(m.measure)),
      text_cell(model), ["mesh", "step", "iterations", "law"].map((name) => known_part(budget, name)), gate_cell([])]));
    const solver = (name, side) => row([row_head(name), text_cell(in_words(side.status)), cell(general(side.unknowns)), cell(general(side.residual,
      2)),
      cell(general(side.newton_iterations)), cell(general(side.inverted_cells)), gate_cell([])]);
    const budgets = one.measures.flatMap((m) => [m.parts.fem, m.parts.msm]).filter(Boolean);
    const has_parts = budgets.some((budget) => !missing(budget.whole));
    const unknown = [...new Set(budgets.filter((budget) => missing(budget.whole)).map((budget) => budget.reason))];
    const lattices = one.lattices.length > 0 ? ` Springs were solved on ${one.lattices.length} lattices.` : "";
    return [make("h3", null, one.case), make("p", null, one.meshes.length > 0 ? "Finite elements were solved on meshes of " +
      `${one.meshes.map((mesh) => mesh.unknowns.toLocaleString("en")).join(", ")} unknowns.`
        : "Finite elements were solved on the case’s mesh alone.", lattices),
    table("limits", "Values, limits and their error bars", row([text_head("measure"), head("finite elements"), text_head("its gate"),
      head("their limit"), head("order"),
      head("springs"), text_head("its gate"), head("springs’ error, %"), text_head("its gate")]), body(one.measures.map(values))),
    has_parts && table("parts", "Errors of both models by their causes, % of the limit", row([text_head("measure"), text_head("model"),
      ["mesh", "step", "iterations", "law"].map((t) => head(t)), text_head("gate")]), body(one.measures.map(parts))),
    unknown.map((reason) => quiet("Errors by their causes are missing: ", typeset(reason), ".")),
    table("solvers", "How far the equations are solved", row([text_head("model"), text_head("state"), head("unknowns"), head("residual"),
      head("iterations"),
      head("inverted cells"), text_head("gate")]), body([solver("finite elements", one.fem), solver("springs", one.msm)])),
    peer_table("peers", one.peers), one.note && quiet(one.note)];
  };
  return [factors("discretisation error", "error of the solvers", "error of use: the case file, its digest and the command are on this page"),
    make("p", null, "± is the largest expected distance to the limit under refinement. The law’s part is what no finer mesh of springs removes."),
    gate_table("gates", "Gates of the cases", dossier.gates.filter((gate) => !is_own(gate))),
    dossier.calculation_verification.map(one_case), lacks("calculation_verification")];
}

function dossier_validation() {
  if (!dossier) return null;
  const { data, description, rows, inputs, published } = dossier.validation;
  const verdict_on = (side) => (missing(side.difference) ? reason_of(side.reason) : missing(side.uncertainty) ? "no uncertainty is known"
    : [Math.abs(side.difference) <= side.uncertainty ? "within" : "beyond", !side.is_complete && ", of what is known"]);
  const size = (value) => cell(missing(value) ? make("em", null, "missing") : general(value, 3));
  const line = (one) => [["finite elements", one.fem], ["springs", one.msm]].map(([model, side]) => row([of_case(one),
    text_cell([typeset(one.measure), reason_of(one.settings.join(" "))]),
    text_cell(model), cell(general(one.datum, 5)), size(one.standard_uncertainty), cell(general(side.value, 5)), cell(missing(side.difference) ? "–"
      : signed(side.difference, 3)),
    size(side.numerical), size(side.input), cell(general(side.uncertainty, 3)), text_cell(verdict_on(side)), text_cell(typeset(one.unit)),
      gate_cell(side.gates)]));
  const effect = (one) => row([of_case(one), text_cell(code(one.key)), cell(with_bar(one.value, one.standard_uncertainty)),
    text_cell(typeset(one.measure)),
    cell(missing(one.fem) ? reason_of(one.reason) : signed(one.fem, 4)), cell(missing(one.msm) ? reason_of(one.reason) : signed(one.msm, 4)),
      text_cell(typeset(one.unit)), gate_cell([])]);
  return [factors("model form", "model inputs", "test samples and conditions", "comparison of outputs"),
    data && make("p", null, "Data: ", code(data), ". ", description),
    rows.length > 0 && [table("measured", "Measured and computed", row([["case", "measure", "model"].map((t) => text_head(t)), ["measured", "its σ",
      "computed", "difference",
      "numerical bar", "σ of inputs", "uncertainty"].map((t) => head(t)), text_head("difference is"), text_head("unit"), text_head("gate")]),
        body(rows.map(line))),
    quiet("The uncertainty is √(bar² + (2 σ of inputs)² + (2 σ measured)²) of the parts that are known. ",
      "A difference within it may have no cause in the model; one beyond it has, where no part is missing.")],
    inputs.length > 0 && table("inputs", "What the inputs’ uncertainty does to the measures", row([["case", "input"].map((t) => text_head(t)),
      head("value ± σ"), text_head("measure"),
      head("finite elements"), head("springs"), text_head("unit"), text_head("gate")]), body(inputs.map(effect))),
    published.length > 0 && make("p", null, "Gates that hold published values: ", gate_links(published), "."), lacks("validation")];
}

function dossier_applicability() {
  if (!dossier) return null;
  const percent = (value) => `${number(100 * value, 2)} %`;
  const line = (one) => row([of_case(one), text_cell(`${one.body.cells} ${one.body.cells === 1 ? one.cells : one.cells.replace(/on$/, "a")}`),
    cell(range(one.poissons_ratio)), cell(range(one.verified_poissons_ratio)),
    cell(range(one.fem.strain, percent)), cell(range(one.msm.strain, percent)), cell(general(one.fem.largest_gradient, 3)),
      cell(general(one.verified_gradient, 3)),
    cell(one.stability
      ? [`compression ${general(one.stability.compression, 3)}, stretch ${general(one.stability.stretch, 3)}, ` +
        `shear ${general(one.stability.simple_shear, 3)}`,
      one.stability.holds_strains === false && make("strong", null, "; the case goes beyond")] : "–", "long"), gate_cell([])]);
  const told = (one) => [...one.doubts, ...one.warnings, ...one.choices].map((text) => make("li", null, bold(one.case), ": ", typeset(text)));
  const all = dossier.applicability.map(told).flat();
  return [factors("relevance of the quantities of interest", "relevance of the validation to the context of use"),
    table("range", "What the results cover", row([["case", "cells"].map((t) => text_head(t)), ["Poisson’s ratio", "in the program’s cases",
      "strain, finite elements", "strain, springs",
      "largest gradient", "in the program’s cases"].map((t) => head(t)), text_head("springs are stable to"), text_head("gate")]),
        body(dossier.applicability.map(line))),
    quiet("Strains are principal logarithmic strains of cells, from the most compressed to the most stretched. ",
      "Beyond these ranges, and for other bodies, loads or meshes, nothing was shown."),
    all.length > 0 && [make("p", null, bold("Warnings and choices of the run")), make("ul", null, all)], lacks("applicability")];
}

function dossier_missing() {
  if (!dossier) return null;
  return table("missing", `${dossier.missing.length} things that nobody has shown here`, heads(["section", "case", "what is missing", "filled by"],
    4),
    body(dossier.missing.map((one) => row([row_head(in_words(one.section)), text_cell(one.case || "all"), cell(typeset(one.what), "long"),
      cell(one.filled_by, "long")]))));
}
