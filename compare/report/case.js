// The page of one's own case: the verdict, measures with their uncertainty and over time, designs ranked by their worst error, commands.
"use strict";
const one_case = report.case;
const seconds_of = (side) => (missing(side.seconds.solve) ? null : side.seconds.setup + side.seconds.solve);

function verdict() {
  if (!one_case) return null;
  const side = (name, of, what) => {
    const is_cut_off = of.status === "not_in_equilibrium"; // after the iterations that were asked for: an answer
    if (of.status !== "converged" && !is_cut_off) return tile(name, in_words(of.status), solver_words(of.message));
    const unknowns = missing(of.unknowns) ? "" : `; ${of.unknowns.toLocaleString("en")} unknowns`;
    return tile(name, missing(seconds_of(of)) ? "given" : duration(seconds_of(of)),
      [what, unknowns, of.message ? `; ${solver_words(of.message)}` : ""]);
  };
  const met = one_case.expectations.filter((one) => one.met).length;
  return [make("p", { class: report.is_sound ? "answer" : "answer problem" }, typeset(solver_words(report.verdict).replaceAll("+-", "±"))),
    make("div", { class: "tiles" }, side("finite elements", one_case.fem, words(one_case.formulation)),
      side("springs", one_case.msm, one_case.msm.source ? `displacements of ${one_case.msm.source}` : in_words(one_case.design)),
      one_case.expectations.length > 0 &&
      tile("expectations met", `${met} of ${one_case.expectations.length}`)),
    report.time && make("p", null, report.time),
    [...one_case.doubts, ...one_case.warnings.map((text) => "Warning: " + text)].map((text) => make("p", { class: "problem" }, text)),
    (one_case.fem.choices || []).map((text) => quiet(text))];
}

const with_bar = (value, bar, shown = general) => (missing(value) ? "–" : [shown(value), missing(bar) ? "" : ` ± ${general(bar, 2)}`]);

// Errors as dots with bars of the reference's uncertainty, the finite elements' own beside them.
function measure_chart(measures) {
  const names = measures.map((m) => m.name), [springs, fem] = [palette[0], palette[1]];
  const bars = { type: "bar", label: "uncertainty of the reference", backgroundColor: springs + "66", barPercentage: 0.35, grouped: false,
    data: measures.map((m) => (missing(m.error_uncertainty_percent) ? null : [m.error_percent - m.error_uncertainty_percent,
      m.error_percent + m.error_uncertainty_percent])) };
  const dots = (label, colour, pointStyle, of) => ({ type: "line", showLine: false, label, borderColor: colour, backgroundColor: colour,
    pointStyle, pointRadius: 6, data: measures.map((m) => ({ x: of(m), y: m.name })) });
  const sets = [dots("springs", springs, "circle", (m) => m.error_percent)];
  if (measures.some((m) => !missing(m.fem_error_percent)))
    sets.push(dots("finite elements on this mesh", fem, "rectRot", (m) => m.fem_error_percent));
  if (bars.data.some((bar) => bar !== null)) sets.push(bars);
  const label = "Error of every measure; the table below has the same values. The arrow keys go from measure to measure.";
  const frame = chart(label, "measures", {
    type: "bar", data: { labels: names, datasets: sets }, options: { indexAxis: "y", interaction: { axis: "y" },
      scales: { y: axis("", { type: "category", labels: names, offset: true }), x: axis("error, %", { type: "linear", grace: "10%" }) },
      plugins: { legend: { position: "bottom", labels: { usePointStyle: true } }, tooltip: { callbacks: {
        label: (item) => (Array.isArray(item.raw) ? `± ${general(measures[item.dataIndex].error_uncertainty_percent, 2)} points`
          : `${item.dataset.label}: ${signed(item.parsed.x, 2)} %`) } } } } });
  frame.style.height = `${8 + 2.6 * names.length}rem`;
  return frame;
}

function measures() {
  if (!one_case || one_case.measures.length === 0) return null;
  const found = one_case.measures.filter((m) => !missing(m.error_percent));
  const error = (m) => (m.error_is_norm ? (value) => `norm ${number(value)}` : signed);
  const expectation = (name) => one_case.expectations.filter((one) => one.measure === name).map((one) => make("div", null,
    `${in_words(one.quantity)} in [${one.interval.map((end) => general(end)).join(", ")}]: `, one.met ? "met" : !one.judged ? "not judged" : make("strong", null,
      one.undecided ? "undecided" : "missed"), !one.met && one.reason ? ` (${one.reason})` : ""));
  const expects = one_case.expectations.length > 0;
  const heads = ["finite elements", "their limit", "springs", "error, %", "error of finite elements, %"].map((text) => head(text));
  const line = (m) => row([row_head([typeset(m.name), ", ", typeset(m.unit)]), cell(general(m.fem)),
    cell(with_bar(m.fem_limit, m.fem_limit_uncertainty)), cell(general(m.msm)),
    cell(with_bar(m.error_percent, m.error_uncertainty_percent, error(m))), cell(with_bar(m.fem_error_percent, null, error(m))),
    expects && cell(expectation(m.name), "long")]);
  const reasons = new Set(one_case.measures.map((m) => m.fem_limit_note)), [reason] = reasons;
  const note = one_case.measures.some((m) => m.reference === "limit")
    ? "Errors are against the limit of the finite elements under refinement where it is known; ± is what its uncertainty leaves."
    : reasons.size === 1 && reason !== "no limit was asked for" ? `Errors are against the finite elements on the same mesh: ${reason}.`
    : "Errors are against the finite elements on the same mesh, whose own error is not known here: accuracy = \"auto\" in [fem] of " +
      "the case, or the option --converge, finds it.";
  return [found.length > 0 && measure_chart(found), table("measures", "Measures of both models", row([text_head("measure"), heads,
    expects && text_head("expected")]), body(one_case.measures.map(line))),
  found.length > 0 && quiet(note, one_case.measures.some((m) => m.error_is_norm)
    ? " A norm is that of the difference, over the body or over time, and has no sign." : "")];
}

// A part of an error; 0 is what is zero by construction.
const part_cell = ({ percent, uncertainty, reason }) =>
  cell(missing(percent) ? "–" : reason ? "0" : with_bar(percent, uncertainty || null, signed));

// The parts of every error: of the law, the mesh, the step and the iterations.
function causes() {
  const budget = report.error_budget;
  if (!budget) return null;
  const parts = ["law", "mesh", "step", "iterations"];
  const line = (model) => (one) => row([row_head(typeset(one.measure)), text_cell(model), parts.map((name) => part_cell(one[name])),
    cell(missing(one.sum) ? "–" : signed(one.sum)), cell(missing(one.whole) ? "–" : signed(one.whole))]);
  const reasons = new Set([...budget.msm, ...budget.fem].flatMap((one) => [one.reason && `${one.measure}: ${one.reason}`,
    ...parts.map((name) => missing(one[name].percent) && one[name].reason && `${one.measure}: ${one[name].reason}`)]).filter(Boolean));
  return [budget.advice.map((text) => make("p", { class: "answer" }, typeset(text))),
    table("causes", "Error by its causes, % of the finite elements' limit", row([text_head("measure"), text_head("model"),
      [...parts, "sum", "whole"].map((text) => head(text))]),
    body([...budget.msm.map(line("springs")), ...budget.fem.map(line("finite elements"))])),
    [budget.note, ...reasons].filter(Boolean).map((text) => quiet(typeset(text)))];
}

// How the measures of a case in time went, in both models.
function motion() {
  const course = one_case && one_case.motion;
  if (!course || course.measures.length === 0) return null;
  // Measures that are numbers of one course, its peak and its frequency, say, share a picture.
  const courses = new Map();
  for (const measure of course.measures) {
    const key = JSON.stringify([measure.unit, measure.fem, measure.msm]);
    if (courses.has(key)) courses.get(key).names.push(measure.name);
    else courses.set(key, { ...measure, names: [measure.name] });
  }
  const line = (label, colour, borderDash, values) => ({ label, borderColor: colour, backgroundColor: colour, borderDash, borderWidth: 2,
    pointRadius: 0, pointHitRadius: 8, data: values.map((y, i) => ({ x: course.time[i], y })) });
  const picture = ({ names, unit, fem, msm }) => {
    const sets = [];
    if (fem.length > 0) sets.push(line("finite elements", palette[1], [], fem));
    if (msm.length > 0) sets.push(line("springs", palette[0], dashes[1], msm));
    const title = names.join(", ");
    const frame = chart(`${title} over time in both models. The arrow keys go from time to time.`, "motion", { type: "line",
      data: { datasets: sets }, options: {
        scales: { x: axis("time, s", { type: "linear", min: course.time[0], max: course.time[course.time.length - 1] }), y: axis(unit) },
        plugins: { legend: { position: "bottom", labels: { usePointStyle: true, pointStyle: "line" } }, tooltip: { callbacks: {
          title: (items) => `${general(items[0].parsed.x)} s`,
          label: (item) => `${item.dataset.label}: ${general(item.parsed.y)} ${unit}` } } } } });
    frame.style.height = "20rem";
    return make("figure", null, make("figcaption", null, make("b", null, typeset(title))), frame);
  };
  return [[...courses.values()].map(picture), course.notes.map((text) => quiet(typeset(text))),
    course.drawn_every > 1 && quiet(`One step of ${course.drawn_every} is drawn.`)];
}

function ranked() {
  if (!report.ranking) return null;
  const { designs: all, recommended, advice: sentence, reference } = report.ranking;
  const name = (d) => (d.design === recommended ? make("strong", null, in_words(d.design), " (recommended)") : in_words(d.design));
  const reason = (d) => (d.refused ? "refused: " + d.refused : d.failed ? "failed: " + solver_words(d.failed) : null);
  const line = (d) => row([row_head([name(d), reason_of(reason(d))]),
    cell(with_bar(d.worst_error_percent, d.worst_error_uncertainty_percent, number)), text_cell(d.worst_at ? typeset(d.worst_at) : "–"),
    cell(number(d.worst_volume_error_percent)), text_cell(missing(d.stable) || d.failed ? "–" : (d.stable ? "stable" : "unstable") + (d.has_moduli === false ? ", other moduli" : "")),
    cell(general(d.milliseconds, 3))], d.design === recommended ? "recommended" : undefined);
  return [make("p", { class: "answer" }, typeset(sentence.replaceAll("+-", "±"))),
    table("ranking", ["Designs by their worst error against ", words(reference)], row([text_head("design"), head("worst |error|, %"),
      text_head("of"), head("volume, %"), text_head("equilibrium"), head("time, ms")]), body(all.map(line)))];
}

const repeat = () => (report.commands ? report.commands.map((text) => make("pre", { class: "command" }, text)) : null);
