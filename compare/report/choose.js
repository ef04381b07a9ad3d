// The first screen: which springs for a material, how wrong and how fast, and every design's worst error against Poisson's ratio.
"use strict";
const advice = report.advice || [];
const ratios = [...new Set(advice.map((a) => a.poissons_ratio))].sort((a, b) => a - b);
const design_names = [...new Set(advice.map((a) => a.design))];
const worse_of = (small, large) => (missing(small) || missing(large) ? null : Math.max(small, large));
const loads_of = { both: (a) => worse_of(a.small.worst_error_percent, a.large.worst_error_percent),
  small: (a) => a.small.worst_error_percent, large: (a) => a.large.worst_error_percent,
  volume: (a) => worse_of(a.small.worst_volume_error_percent, a.large.worst_volume_error_percent) };
const quantities = [["small", "small loads"], ["large", "large loads"], ["volume", "volume"]];
const is_stable = (a) => a.small.stable && a.large.stable;
const advice_at = (ratio, design) => advice.find((a) => a.poissons_ratio === ratio && a.design === design);

// A method's stiffnesses at a ratio, from those of the hundredths around it: [k_e, k_f, k_d, k_v, k_m, exponents if any], over E L0 and E.
// The linear method's stiffnesses and the others' volume terms grow as 1/(1 - 2 nu): linear is their product with 1 - 2 nu.
function stiffness_at(design, ratio) {
  const rows = report.designed[design], exact = rows.find((row) => Math.abs(row[0] - ratio) < 1e-9);
  if (exact) return exact.slice(1);
  const low = rows.filter((row) => row[0] < ratio).pop(), high = rows.find((row) => row[0] > ratio);
  if (!low || !high || high[0] - low[0] > 0.015) return null;
  const share = (ratio - low[0]) / (high[0] - low[0]);
  const scaled = (row, i) => row[i] * (i < 6 ? 1 - 2 * row[0] : 1);
  return low.slice(1).map((_, at) => {
    const i = at + 1, value = (1 - share) * scaled(low, i) + share * scaled(high, i);
    return i < 6 ? value / (1 - 2 * ratio) : value;
  });
}

// A design between two ratios at which errors are tabulated: errors are the larger of both ends', times lie between theirs.
function between(low, high, ratio) {
  const share = high === low ? 0 : (ratio - low.poissons_ratio) / (high.poissons_ratio - low.poissons_ratio);
  const errors = Object.fromEntries(Object.entries(loads_of).map(([name, of]) => [name, worse_of(of(low), of(high))]));
  const time = (model) => low.seconds[model] + share * (high.seconds[model] - low.seconds[model]);
  return { design: low.design, stable: is_stable(low) && is_stable(high), errors, fem_seconds: time("fem"), msm_seconds: time("msm"),
    stiffness: stiffness_at(low.design, ratio) };
}

// What each design would be at a ratio; the best first: stable ones, by their worst error under either load set.
function candidates(ratio) {
  const lower = Math.max(...ratios.filter((nu) => nu <= ratio)), upper = Math.min(...ratios.filter((nu) => nu >= ratio));
  const found = [];
  for (const name of design_names) {
    const low = advice_at(lower, name), high = advice_at(upper, name);
    const one = report.designed[name] && between(low, high, ratio);
    if (one && one.stiffness) found.push(one);
  }
  const rank = (c) => (c.stable && !missing(c.errors.both) ? c.errors.both : Infinity);
  return { lower, upper, found: found.sort((a, b) => rank(a) - rank(b)), has_best: found.some((c) => rank(c) < Infinity) };
}

const up_to = (percent) => (missing(percent) ? "a test failed" : `≤ ${number(percent, 1)} %`);

function calculator() {
  const field = (name, label, value, unit, more) => make("label", null, make("span", null, label), make("span", { class: "with-unit" },
    make("input", { name, value, type: "number", step: "any", required: true, ...more }), make("span", { class: "unit" }, unit)));
  const designs = make("select", { name: "design" }, new Option("the best for this ratio", ""),
    design_names.filter((name) => report.designed[name] && report.designed[name].length > 0).map((name) =>
      new Option(in_words(name), name)));
  const form = make("form", { id: "calculator", "aria-label": "Springs for a material" }, make("div", { class: "fields" },
    field("young", ["Young’s modulus ", symbol("E")], 50, "kPa", { min: 0 }),
    field("nu", ["Poisson’s ratio ", symbol("ν")], 0.45, `${ratios[0]} to ${ratios[ratios.length - 1]}`,
      { min: ratios[0], max: ratios[ratios.length - 1], step: 0.01 }),
    field("edge", ["cell edge ", symbol("L", "0")], 1, "mm", { min: 0 }),
    make("label", null, make("span", null, "design"), designs)));
  const output = make("output", { "aria-live": "polite" });
  form.append(output);
  const answer = () => {
    const young = Number(form.young.value) / 1000, ratio = Number(form.nu.value), edge = Number(form.edge.value); // MPa, -, mm
    if (!(young > 0) || !(edge > 0) || !(ratio >= ratios[0] && ratio <= ratios[ratios.length - 1]) || form.nu.value === "") {
      output.replaceChildren(make("p", { class: "problem" }, `Give E > 0, an edge > 0 and a Poisson’s ratio between ${ratios[0]} and ${
        ratios[ratios.length - 1]}: the errors are tabulated there.`));
      return;
    }
    const { lower, upper, found, has_best } = candidates(ratio);
    const best = form.design.value === "" ? has_best && found[0] : found.find((c) => c.design === form.design.value);
    if (!best) {
      output.replaceChildren(make("p", { class: "problem" }, form.design.value === "" ? "No design is stable in every test here."
        : `${in_words(form.design.value)} has no stiffnesses here.`));
      return;
    }
    const stiffness = (index, what, value, unit) => make("div", null, make("dt", null, symbol("k", index), " ", what),
      make("dd", { "data-symbol": "k_" + index }, `${Number(value.toPrecision(4))} ${unit}`));
    const [e, f, d] = best.stiffness.slice(0, 3).map((over) => 1000 * young * edge * over);
    const [volume, midline, ...exponents] = best.stiffness.slice(3);
    output.replaceChildren(
      make("p", { class: "answer" }, "Use ", make("b", { "data-design": best.design }, in_words(best.design)), " springs",
        best.stable ? "" : ", which are unstable in a test", ". Errors to expect:"),
      make("div", { class: "tiles" }, quantities.map(([name, title]) => tile(title, up_to(best.errors[name]))),
        tile("springs’ time", duration(best.msm_seconds), `finite elements: ${duration(best.fem_seconds)}`)),
      make("dl", null, stiffness("e", "edges", e, "N/m"), stiffness("f", "faces", f, "N/m"),
        stiffness("d", "diagonals", d, "N/m"), stiffness("v", "volume", young * volume, "MPa"),
        midline > 0 && stiffness("m", "midlines, many cells across", 1000 * young * edge * midline, "N/m"),
        exponents.length > 0 && make("div", null, make("dt", null, "exponents of their power law"), make("dd", {
          "data-symbol": "exponents" }, exponents.map((p) => number(p, 3)).join(", ")))),
      quiet(lower === upper ? "" : make("strong", null, `Interpolated: errors are tabulated at ν = ${lower} ` +
        `and ${upper}, and the larger of both is given; stiffnesses are designed for every hundredth of ν. `), "These are the errors of " +
        "the thesis’s cube: 10 × 10 × 10 cells in tension, shear and torsion, at equal strains whatever E is. Another " +
        "body has its own: ", code("run CASE --designs all"), " tells them."));
  };
  form.addEventListener("input", answer);
  form.addEventListener("submit", (event) => event.preventDefault());
  answer();
  return form;
}

// Every design's worst error against Poisson's ratio; a cross where some test is unstable.
function error_chart() {
  let quantity = "both", drawn = null;
  const looks = new Map(design_names.map((name, i) => [name, look_of(i)]));
  const values = (name) => ratios.map((nu) => ({ x: nu, y: loads_of[quantity](advice_at(nu, name)) }));
  const datasets = design_names.map((name) => {
    const { colour, dash, marker } = looks.get(name), best = advice.some((a) => a.design === name && a.recommended);
    return { label: in_words(name), data: values(name), borderColor: colour, backgroundColor: colour, borderDash: dash, pointStyle: marker,
      borderWidth: best ? 4 : 2, pointRadius: 4, pointHoverRadius: 6 };
  });
  const frame = chart("Worst error of every design on the thesis's cube against Poisson's ratio; the table of designs below has the " +
    "same values. The left and right arrow keys go from ratio to ratio.", "wide", {
    type: "line", data: { datasets }, options: { normalized: true,
      scales: { x: axis("Poisson’s ratio ν", { type: "linear", min: ratios[0] - 0.01, max: ratios[ratios.length - 1] + 0.01,
        afterBuildTicks: (scale) => { scale.ticks = ratios.map((value) => ({ value })); } }),
      y: axis("worst |error|, %", { type: "logarithmic", ticks: { callback: (value) => (/^[125]/.test(value.toExponential())
        ? general(value) : "") } }) },
      plugins: { legend: { display: false }, tooltip: { itemSort: (a, b) => a.parsed.y - b.parsed.y, callbacks: {
        title: (items) => `ν = ${items[0].parsed.x}`,
        label: (item) => `${item.dataset.label}: ${number(item.parsed.y, 1)} %` + (is_stable(advice_at(item.parsed.x,
          design_names[item.datasetIndex])) ? "" : ", unstable") } } } } });
  const show = (name) => {
    const box = make("input", { type: "checkbox", checked: true });
    box.addEventListener("change", () => drawn.setDatasetVisibility(design_names.indexOf(name), box.checked) || drawn.update());
    return make("label", null, box, swatch(looks.get(name)), in_words(name));
  };
  const legend = make("div", { class: "legend", role: "group", "aria-label": "Designs in the chart" }, design_names.map(show));
  const element = make("div", { class: "error-chart" }, make("h3", null, "Worst error of every design"),
    choice("quantity", "error under", [["both", "either load set"], ...quantities], quantity, (value) => {
      quantity = value;
      design_names.forEach((name, i) => { drawn.data.datasets[i].data = values(name); });
      drawn.update();
    }), frame, legend);
  const draw = frame.draw;
  frame.draw = () => { drawn = draw(); };
  return element;
}

function choose() {
  if (advice.length === 0) return null;
  return make("div", { class: "choose" }, calculator(), error_chart());
}
