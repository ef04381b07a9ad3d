// What every section of a page is made of: elements, numbers, symbols, tables and the commands behind them. The page's data stands in
// `report`. Every text of the data becomes a text node, never markup.
"use strict";
const report = JSON.parse(document.getElementById("report-data").textContent);

// An element; children are nodes or texts, nested lists are laid flat, null is left out.
function make(tag, attributes, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {}))
    if (value !== undefined && value !== null && value !== false) element.setAttribute(name, value === true ? "" : value);
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

const missing = (value) => value === null || value === undefined;
// A rounded number with a true minus that is never a negative zero, or a dash.
const number = (value, decimals = 2) => (missing(value) ? "–"
  : value.toFixed(decimals).replace(/^-(?=[0.]*$)/, "").replace("-", "−"));
const signed = (value, decimals = 2) => (/^[−–]/.test(number(value, decimals)) ? "" : "+") + number(value, decimals);
const general = (value, digits = 6) => (missing(value) ? "–" : String(Number(value.toPrecision(digits))).replace("-", "−"));
// "70 ms", "1.4 s"
const duration = (seconds) => (seconds < 1 ? `${general(1000 * seconds, 2)} ms` : `${general(seconds, 3)} s`);

// A letter with an index, as mathematics has them.
const symbol = (letter, index) => make("span", { class: "symbol" }, make("i", null, letter),
  index && make("sub", null, index));
const greek = { alpha: "α", beta: "β", nu: "ν" };
const single_symbols = { nu: () => symbol("ν"), mm3: () => "mm³", L0: () => symbol("L", "0"), "k'": () => symbol("k′") };
// Text with its symbols typeset: "alpha_1", "nu = 0.35", "mm3".
function typeset(text) {
  const parts = [];
  let from = 0;
  for (const found of text.matchAll(/\b(alpha|beta|L|k|C)_([a-z]|\d+)\b|\bnu\b|\bmm3\b|\bL0\b|\bk'/g)) {
    parts.push(text.slice(from, found.index));
    from = found.index + found[0].length;
    parts.push(found[1] ? symbol(greek[found[1]] || found[1], found[2]) : single_symbols[found[0]]());
  }
  return parts.concat(text.slice(from)).filter((part) => part !== "");
}
const formulations = { log_strain: "logarithmic strain", small_strain: "small strain", q1_bbar: "Q1 B-bar", q1_p0: "Q1/P0",
  q1_wilson: "Q1 Wilson", q2_p1: "Q2/P1", q1: "Q1", q2: "Q2", p1: "P1", p2: "P2", p2_p0: "P2/P0", p2_p1: "P2/P1", saint_venant_kirchhoff: "St. Venant–Kirchhoff" };
// What solvers say, in fewer words.
const solver_words = (text) => text.replace(/(springs: )?mass-spring equilibrium: /g, "springs: ")
  .replace(/no equilibrium was found beyond this load \(reached: ([.\d]+) of the load\)/g,
    (_, reached) => `no equilibrium beyond ${Math.round(100 * reached)} % of the load`);
// The program's own names in words; names of files stay.
const in_words = (text) => solver_words(text).replace(/\b(log_strain|small_strain|saint_venant_kirchhoff|[pq][12](_\w+)?)\b/g,
  (name) => formulations[name] || name)
  .replace(/\b(fem|msm)_/g, (_, side) => side.toUpperCase() + " ")
  .replace(/\b(?!(?:alpha|beta|L|k|C)_(?:[a-z]|\d+)\b)([A-Za-z]\w*)\b(?!\.\w)/g, (name) => name.replace(/_/g, " "));
const words = (text) => typeset(in_words(text));

const cell = (content, kind) => make("td", { class: kind }, content);
const text_cell = (content) => cell(content, "text");
const head = (content, more) => make("th", { scope: "col", ...more }, content);
const text_head = (content, more) => head(content, { class: "text", ...more });
const row_head = (content, more) => make("th", { class: "text", scope: "row", ...more }, content);
const row = (cells, kind) => make("tr", { class: kind }, cells);
const body = (rows, kind) => make("tbody", { class: kind }, rows);
const code = (text) => make("code", null, text);
const quiet = (...content) => make("p", { class: "quiet" }, content);
const reason_of = (text) => text && make("small", { class: "reason" }, text);
const folded = (summary, ...content) => make("details", null, make("summary", null, summary), content);
const tile = (title, value, more) => make("div", { class: "tile" }, make("b", null, value), make("span", null, title), more &&
  make("small", null, more));
let n_tables = 0;
// A table under its title. What is too wide scrolls in its own frame, by keys too.
function table(name, title, heads, bodies) {
  const id = `title-${++n_tables}`;
  return make("div", null, make("div", { id, class: "title" }, title), make("div", { class: "scroll", tabindex: 0, role: "region",
    "aria-labelledby": id }, make("table", { "data-table": name, "aria-labelledby": id }, heads && make("thead", null, heads), bodies)));
}

// The commands behind a table's numbers, below it: a number links to its line.
class Commands {
  constructor(prefix) {
    this.prefix = prefix;
    this.lines = [];
  }
  // A number with a link to what it is and the command that gives it again; a text where there is none.
  traced(text, what, command) {
    if (!command) return text;
    const id = `${this.prefix}-${this.lines.length}`;
    this.lines.push(make("li", { id }, what, make("br"), code(command)));
    return make("a", { href: "#" + id, title: command }, text);
  }
  list() {
    return this.lines.length > 0 && folded("The command behind each number (typed in the source folder)",
      make("ol", { class: "commands" }, this.lines));
  }
  // What the numbers are in, with the list below it.
  below(...content) { return make("div", { class: "beside" }, content, this.list()); }
}

// A row of buttons of which one is down. @param options  [value, text] each
function choice(name, label, options, chosen, changed) {
  const button = ([value, text]) => {
    const input = make("input", { type: "radio", name, value, checked: value === chosen });
    input.addEventListener("change", () => changed(value));
    return make("label", null, input, make("span", null, text));
  };
  return make("fieldset", { class: "choice" }, make("legend", null, label), options.map(button));
}
