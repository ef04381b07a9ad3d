// Appended to a copy of a page by browser_test.py: draws every body, counts the pixels that it painted, uses the controls, and leaves
// what was found as JSON for --dump-dom.
"use strict";
(function () {
  const found = { errors: window.errors, tables: [], views: [], commands_in_cells: document.querySelectorAll("td code").length };
  for (const of_page of document.querySelectorAll("table[data-table]"))
    found.tables.push({ name: of_page.dataset.table, rows: of_page.rows.length });

  const near = (pixels, i, [r, g, b]) => Math.abs(pixels[i] - r) + Math.abs(pixels[i + 1] - g) + Math.abs(pixels[i + 2] - b) < 60;
  const painted = (canvas) => {
    const copy = document.createElement("canvas"); // reading the view's own canvas often would slow it down, says the browser
    copy.width = canvas.width;
    copy.height = canvas.height;
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    const pixels = context.getImageData(0, 0, copy.width, copy.height).data;
    const count = { all: pixels.length / 4, bluish: 0, orange: 0, lowest: 0, highest: 0 };
    for (let i = 0; i < pixels.length; i += 4) {
      if (pixels[i + 3] === 0) continue;
      if (pixels[i + 2] > pixels[i] + 40) ++count.bluish;
      if (pixels[i] > pixels[i + 2] + 40) ++count.orange;
      if (near(pixels, i, [68, 1, 84])) ++count.lowest;
      if (near(pixels, i, [253, 231, 37])) ++count.highest;
    }
    return count;
  };
  const controls = document.getElementById("body-controls");
  const views = [...view_records.keys()].map((id) => show_body(id));
  const shots = () => views.map((view) => view.canvas.toDataURL());
  const record = (name, values) => values.forEach((value, i) => { found.views[i][name] = value; });
  const changed = (name, before, wanted = true) => record(name, shots().map((shot, i) => (shot !== before[i]) === wanted));

  found.views = views.map((view) => ({ id: view.record.id, has_errors: view.errors !== null }));
  if (views.length > 0) {
    record("coloured", views.map((view) => painted(view.canvas)));
    controls.querySelector("input[value=plain]").click();
    record("painted", views.map((view) => painted(view.canvas)));
    const before = shots(), slider = controls.querySelector("input[type=range]");
    const slide = (value) => {
      slider.value = value;
      slider.dispatchEvent(new Event("input"));
    };
    slide(slider.max);
    changed("slider_moves", before);
    slide(1);
    changed("slider_returns", before, false);
    const box = controls.querySelector("input[name=fem]");
    box.click();
    record("springs_alone", views.map((view) => painted(view.canvas)));
    box.click();
    const mouse = (type, x, target) => target.dispatchEvent(
      new MouseEvent(type, { clientX: x, clientY: 50, button: 0, bubbles: true }));
    mouse("mousedown", 50, views[0].canvas);
    mouse("mousemove", 90, document);
    mouse("mouseup", 90, document);
    changed("mouse_turns_all", before);
    controls.querySelector("button[type=reset]").click();
    controls.querySelector("input[value=plain]").click();
    changed("reset_returns", before, false);
    views[0].canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true }));
    changed("keys_turn_all", before);
    controls.querySelector("button[type=reset]").click();
    views[0].canvas.dispatchEvent(new PointerEvent("pointerdown", { bubbles: true }));
    views[0].canvas.focus();
    found.outline_when_held = getComputedStyle(views[0].canvas).outlineStyle;
    views[0].canvas.blur();
  }

  const form = document.getElementById("calculator");
  const ask = (values) => {
    Object.entries(values).forEach(([name, value]) => { form[name].value = value; });
    form.young.dispatchEvent(new Event("input", { bubbles: true }));
    const output = form.querySelector("output"), of = (name) => output.querySelector(`[data-symbol="${name}"]`);
    const text = (element) => (element ? element.textContent.replace(/−/g, "-") : null);
    return { design: output.querySelector("[data-design]") && output.querySelector("[data-design]").dataset.design,
      stiffness: ["k_e", "k_f", "k_d", "k_v"].map((name) => parseFloat(text(of(name)))), exponents: text(of("exponents")),
      tiles: [...output.querySelectorAll(".tile b")].map(text), text: output.textContent };
  };
  if (form) {
    found.between = ["", "linear_method", "hybrid"].map((design) => ask({ young: "50", nu: "0.475", edge: "1", design }));
    form.design.value = "";
    found.outside = ask({ young: "50", nu: "0.5", edge: "1" });
    found.tabulated = ask({ young: "50", nu: "0.45", edge: "1" });
    const drawn = Chart.getChart(document.querySelector(".error-chart canvas"));
    found.chart = drawn.data.datasets.map((set) => ({ label: set.label, values: set.data }));
    drawn.canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowRight", bubbles: true }));
    found.tooltip = { opacity: drawn.tooltip.opacity, title: drawn.tooltip.title, lines: drawn.tooltip.body.map((part) => part.lines[0]) };
  }
  // Positions last: the page has its final layout now.
  for (const one of found.views) {
    const box = document.getElementById("view-" + one.id).querySelector("canvas").getBoundingClientRect();
    one.box = [box.left + scrollX, box.top + scrollY, box.width, box.height].map(Math.round);
  }
  const errors = document.querySelector(".measures canvas");
  if (errors) found.measures = Chart.getChart(errors).data.datasets.map((set) => ({ label: set.label, values: set.data }));
  found.motion = Array.from(document.querySelectorAll(".motion canvas"), (canvas) => Chart.getChart(canvas).data.datasets
    .map((set) => ({ label: set.label, values: set.data })));
  Object.assign(found, { title: document.title, heading: document.querySelector("h1").textContent,
    subheading: document.querySelector("header p").textContent, images: document.querySelectorAll("main img").length });
  found.height = document.documentElement.scrollHeight;
  found.overflow = document.documentElement.scrollWidth - window.innerWidth;
  const result = document.createElement("script");
  result.type = "application/json";
  result.id = "found";
  result.textContent = JSON.stringify(found).replace(/</g, "\\u003c");
  document.body.append(result);
})();
