// The league: engines, our springs and finite elements on the same cases.
"use strict";
const model_of = (r) => (r.chosen ? `${r.model}, ${r.chosen.replace(/:.*/, "")}` : r.model);

// Sizes of errors, from the best to the worst by powers of ten.
function league_chart(one) {
  const found = one.rows.filter((r) => !missing(r.error_percent) && r.error_percent !== 0);
  const names = found.map(model_of), colour_of = (r) => (r.command ? palette[0] : palette[1]);
  const frame = chart(`Worst error of every model in ${one.case}; the table below has the same values.`, "measures", {
    type: "bar", data: { labels: names, datasets: [{ label: "worst error", data: found.map((r) => Math.abs(r.error_percent)),
      backgroundColor: found.map(colour_of) }] }, options: { indexAxis: "y", scales: { y: axis(""),
      x: axis("size of the worst error, %", { type: "logarithmic" }) }, plugins: { legend: { display: false }, tooltip: { callbacks: {
      label: (item) => `${signed(found[item.dataIndex].error_percent)} % at ${found[item.dataIndex].at}` } } } } });
  frame.style.height = `${7 + 1.7 * names.length}rem`;
  return frame;
}

function league_table(one, index) {
  const rows = one.rows.map((r) => row([row_head([r.model, r.chosen && reason_of(r.chosen), r.reason && reason_of(r.reason)]),
    cell(r.status === "failed" ? "failed" : [number(r.error_percent), missing(r.error_uncertainty) ? "" :
      ` ± ${number(r.error_uncertainty)}`]), text_cell(r.at || "–"), cell(number(r.volume_percent)),
    cell(r.status === "moving" ? "moves" : number(r.rests_after)), cell(general(r.milliseconds_a_step, 3)),
    text_cell(missing(r.in_real_time) ? "–" : r.in_real_time ? "yes" : "no"),
    cell(r.client && r.client.unsupported.length > 0 ? r.client.unsupported.length : "–"),
    ...["law", "mesh", "step", "iterations"].map((part) => part_cell((r.parts || {})[part] || {}))]));
  return table("league-" + index, `${one.case}: errors from ${one.reference === "limit" ? "the finite elements’ limit" :
    "the finite elements on the same mesh"}`, row([text_head("model"), head("worst error, %"), text_head("at"), head("volume, %"),
    head("rests after, s"), head("ms a step"), text_head("real time"), head("ignores"), head("law, %"), head("mesh, %"),
    head("step, %"), head("iterations, %")]), body(rows));
}

// What a client is, what it ignores and what is to be known of its answer.
function league_notes(one) {
  const notes = one.rows.filter((r) => r.client || r.warnings.length > 0).map((r) => [make("dt", null, model_of(r)), make("dd", null,
    r.client && `${r.client.name} ${r.client.version}, ${r.client.method}; ${JSON.stringify(r.client.settings)}. `,
    r.client && r.client.unsupported.length > 0 && `Ignores ${r.client.unsupported.join("; ")}. `,
    r.warnings.map((text) => `${text}. `), r.command && make("div", null, code(r.command)))]);
  return folded("Settings, what is ignored, warnings and commands", make("dl", { class: "methods" }, notes));
}

function league() {
  if (!report.league) return null;
  return [make("p", null, report.league.method), report.league.skipped.map((one) => quiet(`${one.client} was skipped: ${one.reason}.`)),
    report.league.cases.map((one, index) => [make("h3", null, one.case), league_chart(one), league_table(one, index),
      league_notes(one)])];
}
