// What a page's skin shows: how much each picture is painted, and whether a key and the mouse turn all of them.
"use strict";
(function () {
  const canvases = [...document.querySelectorAll("#skin canvas")];
  const pixels = new Map(canvases.map((canvas) => { // each is read once: browsers warn of more
    const copy = make("canvas", { width: canvas.width, height: canvas.height }), context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(canvas, 0, 0);
    return [canvas, context.getImageData(0, 0, canvas.width, canvas.height).data];
  }));
  const painted = (canvas) => pixels.get(canvas).reduce((sum, value, i) => sum + (i % 4 === 3 && value > 0), 0) / (canvas.width * canvas.height);
  const colours = (canvas) => {
    const data = pixels.get(canvas), seen = new Set();
    for (let i = 0; i < data.length; i += 4) if (data[i + 3] > 0) seen.add((data[i] >> 5) * 64 + (data[i + 1] >> 5) * 8 + (data[i + 2] >> 5));
    return seen.size;
  };
  const pictures = () => canvases.map((canvas) => canvas.toDataURL());
  const all_differ = (before) => pictures().every((picture, i) => picture !== before[i]);
  const first = pictures();
  canvases[0].dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowLeft", bubbles: true, cancelable: true }));
  const keys_turn_all = all_differ(first), second = pictures();
  const mouse = (type, x, target) => target.dispatchEvent(new MouseEvent(type, { clientX: x, clientY: 50, button: 0, bubbles: true }));
  mouse("mousedown", 50, canvases[0]);
  mouse("mousemove", 90, document);
  mouse("mouseup", 90, document);
  const found = make("script", { type: "application/json", id: "found" }, JSON.stringify({ errors: window.errors,
    names: [...document.querySelectorAll("#skin figure")].map((figure) => figure.id), painted: canvases.map(painted),
    colours: canvases.map(colours), keys_turn_all, mouse_turns_all: all_differ(second),
    legend: document.querySelector("#skin .error-legend").textContent, bodies: document.querySelectorAll("#bodies").length,
    landmarks: [...document.querySelectorAll("[data-table=landmark-table] tbody tr")].map((line) => line.textContent) }));
  document.body.append(found);
})();
