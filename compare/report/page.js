// Renders the report from its data: tables.json's document and what stands behind the figures, cases and views. Every text of the
// data becomes a text node, never markup.
"use strict";
const report = JSON.parse(document.getElementById("report-data").textContent);
(function () {
  // An element; children are nodes or texts, nested lists are laid flat, null is left out.
  function make(tag, attributes, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes || {}))
      if (value !== undefined && value !== false) element.setAttribute(name, value === true ? "" : value);
    element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
    return element;
  }
  const lines = (texts) => texts.flatMap((text, i) => (i === 0 ? [text] : [make("br"), text]));
  const missing = (value) => value === null || value === undefined;
  // A rounded number that is never a negative zero, or a dash.
  const number = (value, decimals = 2) => (missing(value) ? "–" : value.toFixed(decimals).replace(/^-(?=[0.]*$)/, ""));
  const signed = (value, decimals = 2) => (number(value, decimals).startsWith("-") ? "" : "+") + number(value, decimals);
  const general = (value) => String(Number(value.toPrecision(6)));
  const cell = (content, kind) => make("td", { class: kind }, content);
  const text_cell = (content) => cell(content, "text");
  const head = (content, more) => make("th", { scope: "col", ...more }, content);
  const text_head = (content, more) => head(content, { class: "text", ...more });
  const row_head = (content, more) => make("th", { class: "text", scope: "row", ...more }, content);
  const row = (cells, kind) => make("tr", { class: kind }, cells);
  const code = (text) => make("code", null, text);
  const sub = (letter, index) => [letter, make("sub", null, index)];
  const k = (index) => sub("k", index);
  const folded = (summary, ...content) => make("details", null, make("summary", null, summary), content);
  const table = (name, caption, heads, body) => make("div", { class: "scroll" }, make("table", { "data-table": name },
    caption && make("caption", null, caption), heads && make("thead", null, heads), body));
  const provenance = (trace) => [trace.case && "case: " + trace.case, ...(trace.settings || []).map((one) => "setting: " + one),
    "command: " + trace.command].filter(Boolean).join("\n");
  // A number that shows its command when it is clicked.
  const traced = (text, trace) => (!trace || !trace.command ? text
    : make("details", null, make("summary", { title: provenance(trace) }, text), code(trace.command)));

  const name_of = (p) => [`${p.test} ${p.measure}`, ...column_of(p).filter(Boolean)].join(", ");
  const column_of = (p) => [p.design, `nu = ${general(p.poissons_ratio)}`, p.load_set];
  // One cell of the springs is compared in absolute figures, which need more digits than percents.
  const decimals = (p) => (p.measure.includes("multiplicity") ? 0 : p.test === "cell" ? 4 : 2);
  const nearest = (p) => p.computed_by.find((c) => c.reference === p.nearest);

  function summary() {
    const groups = report.summary.groups;
    const counts = (group) => make("tbody", { class: "measure" }, group.within.map((w, i) => row([
      i === 0 && row_head(traced(`${group.name}, ${group.entries} figures`, group), { rowspan: group.within.length }),
      cell(`${general(w.bound)} ${group.unit}`), cell(w.declared), cell(w.other_only), cell(w.neither)].filter(Boolean))));
    const beyond = ({ entry, explanation }) => {
      const p = report.entries[entry];
      const computed = p.computed_by.map((c) => make("div", null, c.reference + ": ",
        missing(c.value) ? "no value, " + c.reason : traced(number(c.value, p.test === "cell" ? 4 : 2), c)));
      return row([text_cell(make("a", { href: "#table-" + p.table }, p.table)), text_cell(name_of(p)), cell(general(p.published)),
        cell(computed), cell(explanation, "long")]);
    };
    return groups.length && [
      table("summary", "Published figures that are reproduced; a click on a group shows the command that counts it again",
        row([head(""), head("within"), head("by the declared reference"), head("only by the other"), head("by neither")]),
        groups.map(counts)),
      groups.filter((group) => group.beyond.length).map((group) => folded(
        `${group.name}: ${group.beyond.length} not within ${general(group.listing_bound)} ${group.unit} of any reference`,
        table(undefined, null, row([text_head("table"), text_head("figure"), head("published"), head("computed"),
          text_head("explanation")]), make("tbody", null, group.beyond.map(beyond)))))];
  }

  // What the errors of a recommended design are.
  const expected = (a) => `Expected errors: up to ${number(a.small.worst_error_percent, 1)} % under the small loads, ` +
    `${number(a.large.worst_error_percent, 1)} % under the large ones, ${number(Math.max(a.small.worst_volume_error_percent || 0,
      a.large.worst_volume_error_percent || 0))} % in volume.`;

  // What power-log springs have besides stiffnesses.
  const exponents = (a) => (a.exponents ? `, power-log springs of exponents ${a.exponents.map((p) => number(p, 3)).join(", ")}` : "");

  // Stiffnesses for the reader's own E, nu and edge.
  function calculator(recommended) {
    const field = (name, value) => make("input", { name, value, type: "number", min: 0, step: "any" });
    const ratios = make("select", { name: "nu" }, recommended.map((a) => new Option(general(a.poissons_ratio))));
    const output = make("output");
    const form = make("form", { id: "calculator" }, make("label", null, "E ", field("young", 50), " kPa, "),
      make("label", null, "ν ", ratios, ", "), make("label", null, "cells of ", field("edge", 1), " mm: "), output);
    const answer = () => {
      const best = recommended.find((a) => general(a.poissons_ratio) === ratios.value);
      const young = Number(form.young.value) / 1000, edge = Number(form.edge.value); // MPa, mm
      if (!(young > 0) || !(edge > 0)) {
        output.textContent = "give E > 0 and an edge > 0";
        return;
      }
      const [e, f, d] = best.stiffness_per_E_L0.map((over) => (1000 * young * edge * over).toPrecision(4));
      output.textContent = `${best.design}: k_e = ${e}, k_f = ${f}, k_d = ${d} N/m, ` +
        `k_v = ${(young * best.volume_stiffness_per_E).toPrecision(4)} MPa${exponents(best)}. ${expected(best)}`;
    };
    if (recommended.some((a) => a.poissons_ratio === 0.45)) ratios.value = "0.45";
    form.addEventListener("input", answer);
    form.addEventListener("submit", (event) => event.preventDefault());
    answer();
    return form;
  }

  function advice() {
    const recommended = report.advice.filter((a) => a.recommended && a.stiffness_per_E_L0);
    const sentence = (a) => { // for soft tissue: E = 50 kPa, hence 50 N/m per unit
      const [e, f, d] = a.stiffness_per_E_L0.map((over) => number(50 * over));
      return make("li", null, `ν = ${general(a.poissons_ratio)}: `, make("b", null, a.design), "; for E = 50 kPa and cells of 1 mm ",
        k("e"), ` = ${e}, `, k("f"), ` = ${f}, `, k("d"), ` = ${d} N/m and `, k("v"),
        ` = ${number(0.05 * a.volume_stiffness_per_E, 5)} MPa${exponents(a)}. ${expected(a)}`);
    };
    const errors = (a, e) => (missing(e.worst_error_percent)
      ? [cell("–"), cell("–"), text_cell(a.designed ? "a test failed" : "refused")]
      : [cell(traced(number(e.worst_error_percent, 1), { command: e.command_of_worst })), cell(number(e.mean_error_percent, 1)),
        text_cell(e.stable ? "stable" : "unstable")]);
    const line = (a, i) => {
      const is_first = i === 0 || report.advice[i - 1].poissons_ratio !== a.poissons_ratio;
      const stiffness = a.stiffness_per_E_L0 ? [...a.stiffness_per_E_L0, a.volume_stiffness_per_E] : [null, null, null, null];
      return row([cell(is_first ? general(a.poissons_ratio) : ""), text_cell([traced(a.design + (a.recommended ? " ← use" : ""), a),
        a.reason && make("span", { class: "reason" }, a.reason)]), stiffness.map((over) => cell(number(over, 4))),
      errors(a, a.small), errors(a, a.large)], (is_first ? "group " : "") + (a.recommended ? "recommended" : ""));
    };
    const loads = [head("worst"), head("mean"), head("")];
    return report.advice.length && [
      make("p", null, "For a linear elastic material the best stiffnesses grow with E and with the cell's edge ", sub("L", "0"),
        ", and depend on Poisson's ratio alone otherwise. So one line serves every material of that ratio: a spring's stiffness is " +
        "the figure times E ", sub("L", "0"), ", the volume term's the figure times E. Recommended is the smallest worst error over " +
        "both load sets among the designs that stay stable in every test. The errors are those of the thesis's cube, at equal " +
        "strains (loads in proportion to E)."),
      recommended.length > 0 && [calculator(recommended), make("ul", { id: "recommended" }, recommended.map(sentence))],
      table("advice", "Every design on the cube: |error| against the declared reference, %; a click on a design or a worst error " +
        "shows its command",
      [row([head("ν", { rowspan: 2 }), text_head("design", { rowspan: 2 }), head(["k/(E ", sub("L", "0"), ")"], { colspan: 3 }),
        head([k("v"), "/E"]), head("small loads", { colspan: 3 }), head("large loads", { colspan: 3 })]),
      row([..."efdv"].map((index) => head(k(index))).concat(loads, loads.map((one) => one.cloneNode(true))))],
      make("tbody", null, report.advice.map(line))),
      make("p", null, "The same figures are under ", code("advice"), " of ", code("build/springproof tables --json"), ".")];
  }

  // The cells of one figure, below each other or beside each other: one a reference, the published one, the difference.
  function computed_cell(p, c, anchor) {
    const is_nearest = p.computed_by.length > 1 && c === nearest(p);
    return cell(make("a", { href: "#" + anchor, title: provenance(c) }, number(c.value, decimals(p)) + (is_nearest ? "*" : "")),
      is_nearest ? "nearest" : undefined);
  }
  const published_cell = (p) => (p.finding
    ? make("td", { title: p.finding }, number(p.published, decimals(p)), " ", make("abbr", { title: p.finding }, "!"))
    : cell(number(p.published, decimals(p))));
  // The mark is a circle, the emptier the larger the difference.
  function difference_cell(p) {
    if (!nearest(p)) return cell("no value", "beyond");
    const difference = nearest(p).value - p.published, size = Math.abs(difference), text = signed(difference, decimals(p));
    if (p.test === "cell") return cell(text);
    const mark = size <= 0.1 ? "●" : size <= 0.5 ? "◕" : size <= 1 ? "◑" : size <= 2 ? "◔" : "○";
    return cell(`${mark} ${text}`, size <= 1 ? "within" : size <= 2 ? undefined : "beyond");
  }

  function sheet({ table: id, name, subject }) {
    const entries = report.entries.filter((p) => p.table === id);
    const anchor = (p, c) => `trace-${id}-${entries.indexOf(p)}-${p.computed_by.indexOf(c)}`;
    const unique = (key) => [...new Map(entries.map((p) => [key(p), p])).keys()];
    const columns = unique((p) => JSON.stringify(column_of(p))), measures = unique((p) => JSON.stringify([p.test, p.measure]));
    const find = (measure, column) => entries.find((p) => JSON.stringify([p.test, p.measure]) === measure &&
      (!column || JSON.stringify(column_of(p)) === column));
    const parts = columns.map((column) => JSON.parse(column));
    const telling = [0, 1, 2].filter((part) => parts.some((column) => column[part] !== parts[0][part]));
    const caption = [subject, ...parts[0].filter((text, part) => text && !telling.includes(part))].join("; ");
    const measure_head = (p, n_lines) => row_head(p.test === "cell" ? p.measure : `${p.test} ${p.measure}`, { rowspan: n_lines });
    const flat = () => [row([head(""), find(measures[0]).computed_by.map((c) => head(c.reference)), head("published"), head("difference")]),
      make("tbody", null, measures.map((measure) => {
        const p = find(measure);
        return row([measure_head(p), p.computed_by.map((c) => computed_cell(p, c, anchor(p, c))), published_cell(p), difference_cell(p)]);
      }))];
    const grid = () => [telling.map((part) => row([head(""), head(""), parts.map((column) => head(column[part]))])),
      measures.map((measure) => {
        const first = find(measure), cells = columns.map((column) => find(measure, column));
        const line = (label, to_cell) => [row_head(label), cells.map((p) => (p ? to_cell(p) : cell("")))];
        const rows = first.computed_by.map((c, i) => line(c.reference, (p) => computed_cell(p, p.computed_by[i],
          anchor(p, p.computed_by[i])))).concat([line("published", published_cell), line("difference", difference_cell)]);
        return make("tbody", { class: "measure" }, rows.map((one, i) => row(i === 0 ? [measure_head(first, rows.length), one] : one)));
      })];
    const trace = (p) => p.computed_by.map((c, i) => make("tr", { id: anchor(p, c) }, text_cell(name_of(p)), text_cell(c.reference),
      cell(number(c.value, decimals(p))), cell(number(c.fem, 4)), cell(number(c.msm, 4)), cell([code(c.command),
        lines(["", c.reason && "no value: " + c.reason, i + 1 === p.computed_by.length && p.finding].filter(
          (text, n) => n === 0 || text))], "long")));
    return [make("h3", { id: "table-" + id }, name), table(id, caption, ...(columns.length === 1 ? flat() : grid())),
      folded("Case file, settings and command of each number", table(undefined, null, row([text_head("figure"), text_head("reference"),
        head("value"), head("FEM"), head("MSM"), text_head("command (in the source folder)")]),
      make("tbody", null, entries.map(trace))))];
  }

  const tables = () => [make("p", null, "Each computed number is a link to the line below its table that has its case file, settings " +
    "and command; resting the pointer on it shows them too. Where two finite-element references were computed, the declared one " +
    "stands first and * marks the one closer to the published value, from which the difference is taken. Differences, in points of " +
    "percent or mm³: ● within 0.1, ◕ 0.5, ◑ 1, ◔ 2, ○ more. An exclamation mark after a published figure: something is known about " +
    "it (rest the pointer on it)."), report.sheets.map(sheet)];

  const designs = () => report.designs.length && [make("p", null, "The same tests with springs of other designs: |error| against the " +
    "table's declared reference. A method designs from the table's own material. Click an error for its command."),
  table("designs", null, row([text_head("table"), text_head("design"), head("figures"), head("missing"), head("mean, %"),
    head("worst, %"), text_head("where"), text_head("why some are missing")]), make("tbody", null, report.designs.map((d, i) => {
    const is_first = i === 0 || report.designs[i - 1].table !== d.table;
    return row([text_cell(is_first ? d.table : ""), text_cell(d.design), cell(d.figures), cell(d.missing),
      cell(traced(number(d.mean_error_percent), { command: "build/springproof tables " + d.table })),
      cell(traced(number(d.worst_error_percent), { command: d.command_of_worst })), text_cell(d.worst_at),
      cell(lines(d.reasons), "long")], is_first ? "group" : undefined);
  })))];

  const volumes = () => report.volumes.length && [table("volumes", "Deformed volumes, mm³: of the body, and of its cells as a box plot " +
    "(whiskers at the outermost values within 1.5 times the interquartile range of the box)", row([text_head("case"), text_head("model"),
    ...["body", "change, %", "whisker", "quartile", "median", "quartile", "whisker", "outliers"].map((name) => head(name))]),
  make("tbody", null, report.volumes.flatMap((v) => [["FEM", v.fem], ["MSM", v.msm]].map(([model, of], i) => row([
    text_cell(i === 0 ? traced(v.case, v) : ""), text_cell(model), ...(of ? [cell(number(of.total_mm3)),
      cell(signed(100 * (of.total_mm3 / v.rest_mm3 - 1))), ...[of.whiskers[0], ...of.quartiles, of.whiskers[1]].map((figure) =>
        cell(number(figure, 4))), cell(of.outliers.length)] : [make("td", { class: "text", colspan: 8 }, "no equilibrium")])]))))),
  make("p", null, "The whole table again, box plots and all: ", code("build/springproof tables 5.2")),
  report.cell_volume_changes.map((change) => make("p", null, `Figure 5.10, ${change.load_set} loads: the springs' cells between the ` +
    `whiskers change their volume by up to ${number(change.computed_percent)} %; the thesis says ${general(change.published_percent)} %. ` +
    "Again: ", code("build/springproof tables 5.2")))];

  const picture = (name) => document.getElementById("picture-" + name).querySelector("img"); // drawn, as it stands without scripts

  const figures = () => report.figures.map((f) => make("figure", { id: f.name }, picture(f.name), make("figcaption", null,
    make("b", null, `Figure ${f.number}.`), ` ${f.caption} `, make("span", { class: "quiet" },
      `Files: figures/${f.name}.svg, .png, .gp. Again: `, code(f.command)))));

  function view(one) {
    const measures = one.measures.map((m) => `${m.name}: FEM ${number(m.fem)}, MSM ${number(m.msm)} ${m.unit}` +
      (missing(m.error_percent) ? "" : `, error ${signed(m.error_percent)} %`));
    const failures = [one.fem, one.msm].filter((side) => side.status === "failed").map((side) => "failed: " + side.message);
    const box = (name, label) => make("label", null, make("input", { type: "checkbox", name, checked: true }), label);
    return make("figure", { class: "view", id: "view-" + one.name }, picture(one.name),
      make("canvas", { role: "img", "aria-label": `${one.name}: springs over finite elements` }), make("div", { class: "controls" },
        make("label", null, "displacements ", make("input", { type: "range", min: 0, max: 2, step: 0.05, value: 1 })), make("output"),
        box("fem", " finite elements"), box("springs", " springs")), make("figcaption", null,
        lines([make("b", null, one.name), one.description + ".", ...measures, ...failures, code(one.command)])));
  }
  const views = () => report.cases.length && [make("p", null, "Drag to turn. ", make("span", { class: "fem-key" },
    "Finite elements: blue translucent surface with its edges."), " ", make("span", { class: "springs-key" },
    "Springs: orange lines (the surface's edges, and fainter its diagonals)."), " The slider multiplies the displacements; × 1 is " +
    "true. Both models on one mesh for ParaView: CASE.vtu."), make("div", { class: "views" }, report.cases.map(view))];

  function settings() {
    const { program, machine } = report.provenance;
    const fact = (name, value) => row([row_head(name), cell(value, "long")]);
    const outcome = (side) => (side.status !== "converged" ? make("td", { class: "long", colspan: 3 }, side.message)
      : [cell(side.unknowns), cell(side.residual.toExponential(1)), cell(number(side.seconds.setup + side.seconds.solve))]);
    const solved = ["unknowns", "residual", "s"].map((name) => head(name));
    return [table("machine", null, null, make("tbody", null,
      fact("program", `springproof ${program.version}, commit ${program.commit}`),
      fact("machine", `${machine.processor}, ${machine.cores} cores; ${machine.system}`),
      fact("compiler, BLAS", `${machine.compiler}; ${machine.blas}`), fact("workers", report.workers),
      report.times.map((time) => fact("time: " + time.phase, `${number(time.seconds)} s`)))),
    report.cases.length > 0 && table("cases", ["The cases as drawn above: finite-element formulation and element, spring stiffnesses ",
      k("e"), ", ", k("f"), ", ", k("d"), " (N/m), unknowns, relative residual, seconds"].flat(),
    row([text_head("case file"), text_head("FEM"), solved, head("MSM"), solved.map((one) => one.cloneNode(true))]),
    make("tbody", null, report.cases.map((one) => row([text_cell(traced(one.case, one)), text_cell(one.reference), outcome(one.fem),
      cell(one.msm.stiffness_N_per_m ? one.msm.stiffness_N_per_m.map((s) => Number(s.toPrecision(4))).join(", ") : "–"),
      outcome(one.msm)]))))];
  }

  const main = document.querySelector("main"), nav = document.querySelector("nav");
  for (const [id, heading, section] of [["summary", "What is reproduced", summary], ["which-design", "Which design to use", advice],
    ["tables", "Tables", tables], ["designs", "Other designs", designs], ["volumes", "Volumes", volumes],
    ["figures", "Figures", figures], ["views", "Deformed bodies", views],
    ["settings", "Settings, versions, machine and times", settings]]) {
    const content = section();
    if (!content || content.length === 0) continue;
    nav.append(make("a", { href: "#" + id }, heading), " ");
    main.append(make("section", { id }, make("h2", null, heading), content.flat(Infinity).filter(Boolean)));
  }
  document.getElementById("pictures").remove();
  document.querySelector("header p").append(` Made by springproof ${report.provenance.program.version} ` +
    `(${report.provenance.program.commit}).`);
  document.querySelector("footer").append(folded("Licence of three.js, which draws the three-dimensional views",
    make("pre", null, report.licence)));

  // A number's link leads into a closed list: open it.
  function reveal() {
    const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    const list = target && target.closest("details");
    if (list) list.open = true;
    if (target) target.scrollIntoView();
  }
  window.addEventListener("hashchange", reveal);
  reveal();
})();
