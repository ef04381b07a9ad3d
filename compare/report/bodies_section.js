// The section of bodies: one row of controls for all of them, and a figure each.
"use strict";
function body_controls() {
  const largest = largest_of([...view_records.values()].map((record) => record.largest_scale));
  const slider = make("input", { type: "range", min: 0, max: largest, step: 0.1, value: 1 });
  const factor = make("output", null, "× 1.0");
  slider.addEventListener("input", () => {
    shown.scale = Number(slider.value);
    factor.textContent = "× " + shown.scale.toFixed(1);
    update_bodies();
  });
  const box = (name, ...label) => {
    const input = make("input", { type: "checkbox", name, checked: true });
    input.addEventListener("change", () => {
      shown[name] = input.checked;
      update_bodies();
    });
    return make("label", null, input, label);
  };
  const colours = choice("colour", "springs", [["error", "error coloured"], ["plain", "lines"]], shown.colour, (value) => {
    shown.colour = value;
    update_bodies();
  });
  const reset = make("button", { type: "reset" }, "Reset");
  const form = make("form", { id: "body-controls", "aria-label": "Controls of all bodies" }, make("label", null, "displacements ", slider,
    factor), colours, box("fem", make("span", { class: "key fem-key" }), "finite elements"),
  box("springs", make("span", { class: "key springs-key" }), "springs"), reset);
  form.addEventListener("submit", (event) => event.preventDefault());
  form.addEventListener("reset", () => {
    Object.assign(shown, { scale: 1, colour: "error", fem: true, springs: true });
    shown.eye.set(...seen_from);
    factor.textContent = "× 1.0";
    update_bodies();
  });
  return form;
}

// The largest error of a record without drawing it.
function legend_of(record) {
  if (!record.fem || !record.springs) return null;
  const errors = errors_of(new Side(record.springs), new Side(record.fem));
  if (!errors) return null;
  const largest = 100 * largest_of(errors);
  return error_legend(`${general(largest, 2)} %`, make("small", null, "distance of both models, of the largest displacement"));
}

const measure_rows = (measures) => body(measures.map((m) => row([row_head([typeset(m.name), ", ", typeset(m.unit)]),
  cell(missing(m.fem) ? "–" : general(m.fem, 4)), cell(missing(m.msm) ? "–" : general(m.msm, 4)),
  cell(missing(m.error_percent) ? "–" : `${signed(m.error_percent, 1)} %`)])));

function body_figure(record) {
  const title = make("b", null, record.title);
  return make("figure", { class: "view", id: "view-" + record.id }, make("canvas", { role: "img", tabindex: 0,
    "aria-label": `${record.title}: springs over finite elements, deformed. The arrow keys turn it.` }),
  make("div", { class: "scale quiet" }), legend_of(record), make("figcaption", null, title, make("p", null, record.description),
    record.failures.map((text) => make("p", { class: "problem" }, solver_words(text))), record.measures.length > 0 &&
    make("table", null, make("thead", null, row([text_head("measure"), head("FEM"), head("springs"), head("error")])),
      measure_rows(record.measures)), record.command && folded("Command", code(record.command))));
}

function bodies() {
  if (view_records.size === 0) return null;
  const groups = [...new Set([...view_records.values()].map((record) => record.group))];
  const section = make("div", null, make("p", null, "Drag a body, or use the arrow keys: all turn with it. Both models are drawn over " +
    "each other; colours are the distance between them."), body_controls(), groups.map((group) => [
    group && make("h3", null, typeset(group)),
    make("div", { class: "views" }, [...view_records.values()].filter((record) => record.group === group).map(body_figure))]));
  section.draw = () => {
    const watcher = new IntersectionObserver((entries) => {
      const seen = entries.filter((entry) => entry.isIntersecting);
      if (seen.length === 0) return;
      if (!can_draw(section, "the bodies to turn. Drawn pictures of them are beside this page (.png, .svg).")) watcher.disconnect();
      else for (const entry of seen) show_body(entry.target.id.replace(/^view-/, ""));
    }, { rootMargin: "200px" });
    for (const id of view_records.keys()) watcher.observe(document.getElementById("view-" + id));
    draw_with_page(live_views);
  };
  return section;
}
