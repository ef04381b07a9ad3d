// Appended to a copy of the report by browser_test.py: draws every view, counts the pixels that it painted, and leaves what was
// found on the page as JSON for --dump-dom.
"use strict";
(function () {
  const found = { errors: window.errors, tables: [], views: [] };
  for (const table of document.querySelectorAll("table[data-table]"))
    found.tables.push({ name: table.dataset.table, rows: table.rows.length });

  const painted = (canvas) => {
    const copy = document.createElement("canvas"); // reading the view's own canvas often would slow it down, says the browser
    copy.width = canvas.width;
    copy.height = canvas.height;
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    const pixels = context.getImageData(0, 0, copy.width, copy.height).data;
    const count = { all: pixels.length / 4, bluish: 0, orange: 0 };
    for (let i = 0; i < pixels.length; i += 4) {
      if (pixels[i + 3] === 0) continue;
      if (pixels[i + 2] > pixels[i] + 40) ++count.bluish;
      if (pixels[i] > pixels[i + 2] + 40) ++count.orange;
    }
    return count;
  };
  const shot = (canvas) => canvas.toDataURL();

  for (const id of window.springproof_views.ids) {
    const view = window.springproof_views.show(id);
    const record = { id, painted: painted(view.canvas) };
    const before = shot(view.canvas);
    const slide = (value) => {
      view.slider.value = value;
      view.slider.dispatchEvent(new Event("input"));
    };
    slide(view.slider.max);
    record.slider_moves = shot(view.canvas) !== before;
    slide(1);
    record.slider_returns = shot(view.canvas) === before;
    const box = view.figure.querySelector("input[name=fem]");
    box.click();
    record.springs_alone = painted(view.canvas);
    box.click();
    const mouse = (type, x, target) => target.dispatchEvent(
      new MouseEvent(type, { clientX: x, clientY: 50, button: 0, bubbles: true }));
    mouse("mousedown", 50, view.canvas);
    mouse("mousemove", 90, document);
    mouse("mouseup", 90, document);
    record.mouse_turns = shot(view.canvas) !== before;
    found.views.push(record);
  }
  // Positions last: the page has its final layout now.
  for (const record of found.views) {
    const box = document.getElementById(record.id).querySelector("canvas").getBoundingClientRect();
    record.box = [box.left + scrollX, box.top + scrollY, box.width, box.height].map(Math.round);
  }
  found.height = document.documentElement.scrollHeight;
  const form = document.getElementById("calculator");
  Object.entries({ young: "50", nu: "0.45", edge: "1" }).forEach(([name, value]) => { form[name].value = value; });
  form.young.dispatchEvent(new Event("input", { bubbles: true }));
  found.calculator = form.querySelector("output").textContent;
  const result = document.createElement("script");
  result.type = "application/json";
  result.id = "found";
  result.textContent = JSON.stringify(found);
  document.body.append(result);
})();
