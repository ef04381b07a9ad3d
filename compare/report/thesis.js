// What is reproduced of the thesis: counts, its tables with ours beside them, its figures.
"use strict";
const name_of = (p) => [`${p.test} ${p.measure}`, p.design, `nu = ${general(p.poissons_ratio)}`, p.load_set && p.load_set + " loads"]
  .filter(Boolean).join(", ");
// One cell of the springs is compared in absolute values, which need more digits than percents.
const decimals = (p) => (p.measure.includes("multiplicity") ? 0 : p.test === "cell" ? 4 : 2);
const nearest = (p) => p.computed_by.find((c) => c.reference === p.nearest);

function reproduced() {
  const groups = report.summary ? report.summary.groups : [];
  if (groups.length === 0) return null;
  const commands = new Commands("summary");
  const counts = (group) => body(group.within.map((w, i) => row([
    i === 0 && row_head(commands.traced([words(group.name), `: ${group.entries} values`], words(group.name), group.command),
      { rowspan: group.within.length }), cell([general(w.bound), " ", typeset(group.unit)]), cell(w.declared), cell(w.other_only),
    cell(w.neither)])), "measure");
  const beyond = ({ entry, explanation }) => {
    const p = report.entries[entry];
    return row([row_head(make("a", { href: "#table-" + p.table }, p.table)), text_cell(words(name_of(p))), cell(general(p.published)),
      cell(p.computed_by.map((c) => make("div", null, missing(c.value) ? "no value" : number(c.value, decimals(p)),
        reason_of(words(c.reference))))), cell(words(explanation), "long")]);
  };
  return [table("summary", "Published values that are reproduced, by how closely",
    row([text_head("values"), head("within"), head("by the declared reference"), head("only by the other"), head("by neither")]),
    groups.map(counts)), commands.list(),
  groups.filter((group) => group.beyond.length).map((group) => folded(
    [`${group.beyond.length} of them are not within ${general(group.listing_bound)} ${group.unit} of any reference: `,
      words(group.name)], table(undefined, [words(group.name), ": not reproduced, and why"], row([text_head("table"),
      text_head("value"), head("published"), head("computed"), text_head("explanation")]), body(group.beyond.map(beyond)))))];
}

const published_cell = (p) => (p.finding
  ? cell([number(p.published, decimals(p)), " ", make("abbr", { title: p.finding }, "!")]) : cell(number(p.published, decimals(p))));
// The mark is a circle, the emptier the larger the difference.
function difference_cell(p) {
  if (!nearest(p)) return cell("no value", "beyond");
  const difference = nearest(p).value - p.published, size = Math.abs(difference), text = signed(difference, decimals(p));
  if (p.test === "cell") return cell(text);
  const mark = size <= 0.1 ? "●" : size <= 0.5 ? "◕" : size <= 1 ? "◑" : size <= 2 ? "◔" : "○";
  return cell(`${mark} ${text}`, size <= 1 ? "within" : size <= 2 ? undefined : "beyond");
}

// A table's columns are told apart by design, Poisson's ratio and load set; what all columns share stands in the title.
const kinds = [{ of: (p) => p.design, text: in_words, by: "design" },
  { of: (p) => p.poissons_ratio, text: (nu) => ["ν = ", general(nu)], by: "Poisson’s ratio" },
  { of: (p) => p.load_set, text: (set) => set && `${set} loads`, by: "load set" }];

function sheet({ table: id, name, subject }) {
  const entries = report.entries.filter((p) => p.table === id), commands = new Commands("table-" + id);
  const key_of = (p) => JSON.stringify(kinds.map((kind) => kind.of(p))), measure_of = (p) => JSON.stringify([p.test, p.measure]);
  const columns = [...new Map(entries.map((p) => [key_of(p), p])).entries()];
  const measures = [...new Map(entries.map((p) => [measure_of(p), p])).entries()];
  const telling = kinds.filter((kind) => columns.some(([, p]) => kind.of(p) !== kind.of(columns[0][1])));
  const shared = kinds.filter((kind) => !telling.includes(kind) && kind.of(columns[0][1]) !== "");
  const what = subject.startsWith("error r") ? "errors of the springs, %" : subject;
  const parts = [...shared.map((kind) => kind.text(kind.of(columns[0][1]))), telling.map((kind) => "by " + kind.by).join(" and ")];
  const title = [make("span", { id: "table-" + id }, name, ": "), words(what), "; ", parts.filter((part) => part.length > 0)
    .flatMap((part, i) => (i === 0 ? [part] : [", ", part]))];
  const computed = (p, c) => {
    const is_nearest = p.computed_by.length > 1 && c === nearest(p);
    const text = number(c.value, decimals(p)) + (is_nearest ? "*" : "");
    const both = missing(c.fem) ? "" : `; finite elements ${general(c.fem)}, springs ${general(c.msm)}`;
    return cell(commands.traced(text, [words(name_of(p)), ": ", words(c.reference), both, c.reason && [": no value: ", words(c.reason)],
      p.finding && [". ", words(p.finding)]], c.command), is_nearest ? "nearest" : undefined);
  };
  const label = (p) => (p.test === "cell" ? words(p.measure) : words(`${p.test.replace(/_(?=\d)/, " ")} ${p.measure}`));
  // One column gives a row per measure. Several stand side by side; what belongs to a measure is stacked.
  const flat = () => table(id, title, row([make("td"), columns[0][1].computed_by.map((c) => head(words(c.reference))), head("published"),
    head("difference")]), body(measures.map(([, p]) => row([row_head(label(p)), p.computed_by.map((c) => computed(p, c)),
    published_cell(p), difference_cell(p)]))));
  const heads = telling.map((kind) => row([make("td"), make("td"), columns.map(([, p]) => head(kind.text(kind.of(p))))]));
  const bodies = () => measures.map(([measure, first]) => {
    const found = columns.map(([column]) => entries.find((p) => measure_of(p) === measure && key_of(p) === column));
    const line = (text, to_cell) => [row_head(text), found.map((p) => (p ? to_cell(p) : cell("")))];
    const rows = first.computed_by.map((c, i) => line(words(c.reference), (p) => computed(p, p.computed_by[i])))
      .concat([line("published", published_cell), line("difference", difference_cell)]);
    return body(rows.map((one, i) => row(i === 0 ? [row_head(label(first), { rowspan: rows.length, scope: "rowgroup" }), one] : one)),
      "measure");
  });
  return commands.below(columns.length === 1 ? flat() : table(id, title, heads, bodies()));
}

const published_tables = () => report.sheets && report.sheets.length > 0 && [make("h3", null, "Its tables, computed again"),
  make("p", null, "An error is ", make("i", null, "r"), " = (springs − finite elements)/finite elements × 100 %. Where two " +
    "finite-element references were computed, the declared one stands first and * marks the one closer to the published value, from " +
    "which the difference is taken. Differences in points of percent or mm³: ● within 0.1, ◕ 0.5, ◑ 1, ◔ 2, ○ more. An " +
    "exclamation mark: something is known about the published value. A number links to its command."),
  make("div", { class: "side-by-side" }, report.sheets.map(sheet))];

// The drawn pictures stand in the page as long as scripts have not taken them to their place.
const drawing = (name) => {
  const found = document.getElementById("picture-" + name);
  return found && found.querySelector("img");
};
const figures = () => report.figures && report.figures.length > 0 && [make("h3", null, "Its figures, drawn again"),
  make("div", { class: "figures" },
  report.figures.map((f) => make("figure", { id: f.name }, drawing(f.name) || make("p", null, make("a", { href: "#bodies" },
    "These are bodies to turn, above.")), make("figcaption", null, make("b", null, `Figure ${f.number}. `), words(f.caption),
    folded("Files and command", make("p", null, `figures/${f.name}.svg, .png, .gp. `, code(f.command)))))))];

const thesis = () => {
  const parts = [reproduced(), published_tables(), figures()].flat().filter(Boolean);
  return parts.length > 0 ? [make("p", null, "G. San-Vicente, ", make("cite", null, "Designing deformable models of soft tissue for " +
    "virtual surgery planning and simulation using the Mass-Spring Model"), ", chapters 4 and 5."), parts] : null;
};
