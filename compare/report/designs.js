// The designs: what each is, its errors on the cube at every tabulated Poisson's ratio, its stiffnesses; and the tables of what was
// solved: designs in the thesis's tests, volumes, cases.
"use strict";

// How a design did in its tests, where that is not "stable".
function state_of(a) {
  if (a.reason) return typeset(in_words(a.reason).replace(/springs: /g, ""));
  const unstable = ["small", "large"].filter((set) => !a[set].stable);
  return unstable.length > 0 ? [`unstable under ${unstable.join(" and ")} loads`] : null;
}

function errors_at(ratio) {
  const commands = new Commands("advice-" + ratio);
  const rank = (a) => (is_stable(a) && !a.reason ? loads_of.both(a) : 1000);
  const rows = advice.filter((a) => a.poissons_ratio === ratio).sort((a, b) => rank(a) - rank(b)).map((a) => {
    const name = in_words(a.design), state = state_of(a);
    const worst = (set) => cell(missing(a[set].worst_error_percent) ? "–" : commands.traced(number(a[set].worst_error_percent, 1),
      `${name}, worst error under the ${set} loads`, a[set].command_of_worst));
    return row([row_head([a.recommended ? make("strong", null, name, " (best)") : name, reason_of(state)]), worst("small"), worst("large"),
      cell(number(a.small.mean_error_percent, 1)), cell(number(a.large.mean_error_percent, 1)), cell(number(loads_of.volume(a), 1)),
      cell(a.seconds.msm > 0 ? general(1000 * a.seconds.msm, 2) : "–")], a.recommended ? "recommended" : undefined);
  });
  const pair = () => [head("small"), head("large")];
  return commands.below(table("advice-" + ratio, [symbol("ν"), ` = ${ratio}: |error| on the cube, %`],
    [row([text_head("design", { rowspan: 2 }), head("worst", { colspan: 2, scope: "colgroup" }), head("mean", { colspan: 2,
      scope: "colgroup" }), head("volume", { rowspan: 2 }), head("time, ms", { rowspan: 2 })]), row([pair(), pair()])], body(rows)));
}

function stiffnesses() {
  const commands = new Commands("stiffness");
  const rows = advice.filter((a) => a.stiffness_per_E_L0).map((a) => row([cell(general(a.poissons_ratio)),
    row_head(commands.traced(in_words(a.design), `${in_words(a.design)}, ν = ${a.poissons_ratio}`, a.command)),
    a.stiffness_per_E_L0.map((over) => cell(number(over, 4))), cell(number(a.volume_stiffness_per_E, 4)),
    cell(a.exponents ? a.exponents.map((p) => number(p, 3)).join(", ") : "–")]));
  return folded("Stiffnesses of every design, for any E and edge", table("stiffnesses",
    ["Stiffnesses over ", symbol("E"), " ", symbol("L", "0"), ", of the volume term over ", symbol("E")],
    row([head(symbol("ν")), text_head("design"), [..."efd"].map((index) => head(symbol("k", index))), head(symbol("k", "v")),
      head("exponents")]), body(rows)), commands.list());
}

function designs() {
  if (advice.length === 0) return null;
  return [make("p", null, "Errors against finite elements (", words("log_strain q1_bbar"), ") on the same mesh, over all measures but " +
    "volumes. The best has the smallest worst error under both load sets among the designs that stay stable in every test. Time: median " +
    "of the six tests, setup and solve, on the machine named below, ", `as this page was made (solves side by side: ${report.workers}); ` +
    `finite elements take ${duration(advice[0].seconds.fem)}.`),
  make("div", { class: "side-by-side" }, ratios.map(errors_at)),
  folded("What each design is", make("dl", { class: "methods" }, report.methods.map((m) => [make("dt", null, in_words(m.name), " ",
    code(`design = "${m.name}"`)), make("dd", null, words(m.what), ". ", make("span", { class: "quiet" }, m.published_in))]))),
  stiffnesses()];
}

// The ways in which figures are missing: those that differ by the load reached alone are one.
function reasons_in_words(reasons) {
  const reached = [], others = new Set();
  for (const reason of reasons) {
    const found = reason.match(/no equilibrium was found beyond this load \(reached: ([.\d]+) of the load\)/);
    if (found) reached.push(Math.round(100 * found[1]));
    else others.add(in_words(reason).replace(/springs: /, ""));
  }
  const low = Math.min(...reached), high = Math.max(...reached);
  return [...(reached.length > 0 ? [`no equilibrium beyond ${low === high ? low : `${low} to ${high}`} % of the load`] : []),
    ...others].join("; ");
}

// ", small loads" of a table of such alone.
function loads_in(sheet) {
  const sets = new Set(report.entries.filter((p) => p.table === sheet.table && p.load_set).map((p) => p.load_set));
  return sets.size > 0 ? `, ${[...sets].join(" and ")} loads` : "";
}

function designs_in_tables() {
  if (!report.designs || report.designs.length === 0) return [];
  return report.sheets.filter((sheet) => report.designs.some((d) => d.table === sheet.table)).map((sheet) => {
    const commands = new Commands("designs-" + sheet.table);
    const rows = report.designs.filter((d) => d.table === sheet.table).map((d) => {
      const name = in_words(d.design).replace("in print", "as published");
      return row([row_head([name, d.reasons.length > 0 && reason_of(reasons_in_words(d.reasons))]),
        cell(d.missing > 0 ? `${d.figures} of ${d.figures + d.missing}` : d.figures), cell(number(d.mean_error_percent, 1)),
        cell(commands.traced(number(d.worst_error_percent, 1), [name, ": ", words(d.worst_at)], d.command_of_worst)),
        text_cell(words(d.worst_at))]);
    });
    return commands.below(table("designs-" + sheet.table, [`Every design in the tests of ${sheet.name.toLowerCase()}`,
      `${loads_in(sheet)}: |error|, %`], row([text_head("design"), head("figures"), head("mean"), head("worst"), text_head("worst at")]),
    body(rows)));
  });
}

function volumes() {
  if (!report.volumes || report.volumes.length === 0) return null;
  const commands = new Commands("volumes");
  const rows = report.volumes.flatMap((v) => [["finite elements", v.fem], ["springs", v.msm]].map(([model, of], i) => row([
    i === 0 && row_head(commands.traced(in_words(v.case.replace(/-/g, " ")), v.case, v.command), { rowspan: 2 }), text_cell(model),
    of ? [cell(number(of.total_mm3)), cell(signed(100 * (of.total_mm3 / v.rest_mm3 - 1))), [of.whiskers[0], ...of.quartiles,
      of.whiskers[1]].map((value) => cell(number(value, 4))), cell(of.outliers.length)]
      : make("td", { class: "text", colspan: 8 }, "no equilibrium")])));
  return commands.below(table("volumes", "Deformed volumes, mm³: the body’s, and the box plot of its cells’",
    row([text_head("case"), text_head("model"), ["body", "change, %", "lower whisker", "quartile", "median", "quartile", "upper whisker",
      "outliers"].map((name) => head(name))]), body(rows)), quiet("Whiskers end at the outermost values within " +
    "1.5 times the interquartile range of the box. ", report.cell_volume_changes.map((change) => `Figure 5.10, ${change.load_set} loads: ` +
    `the springs’ cells between the whiskers change their volume by up to ${number(change.computed_percent)} %; the thesis says ${
      general(change.published_percent)} %. `)));
}

function cases() {
  if (!report.cases || report.cases.length === 0) return null;
  const commands = new Commands("cases");
  const outcome = (side) => (side.status !== "converged" ? make("td", { class: "long", colspan: 3 }, words(side.message))
    : [cell(side.unknowns.toLocaleString("en")), cell(side.residual.toExponential(0).replace("-", "−")),
      cell(general(1000 * (side.seconds.setup + side.seconds.solve), 2))]);
  const solved = () => ["unknowns", "residual", "time, ms"].map((name) => head(name));
  const rows = report.cases.map((one) => row([row_head(commands.traced(one.name.replace(/-/g, " "), one.case, one.command)),
    text_cell(words(one.reference)), outcome(one.fem), cell(one.msm.stiffness_N_per_m ? one.msm.stiffness_N_per_m.map((s) =>
      general(s, 4)).join(", ") : "–"), outcome(one.msm)]));
  return commands.below(table("cases", "What was solved: both models of every case that is drawn above",
    [row([text_head("case", { rowspan: 2 }), head("finite elements", { colspan: 4, scope: "colgroup" }), head("springs", { colspan: 4,
      scope: "colgroup" })]), row([text_head("formulation"), solved(), head([symbol("k", "e"), ", ", symbol("k", "f"), ", ",
      symbol("k", "d"), ", N/m"]), solved()])], body(rows)));
}

const tables = () => {
  const parts = [designs_in_tables(), volumes(), cases()].flat().filter(Boolean);
  return parts.length > 0 ? make("div", { class: "side-by-side" }, parts) : null;
};
