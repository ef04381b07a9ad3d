// Small conveniences; the page says everything without them.
"use strict";
(function () {
  // A number's link leads into a closed list: open it.
  function reveal() {
    const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    const list = target && target.closest("details");
    if (!list || list.open) return;
    list.open = true;
    target.scrollIntoView();
  }
  window.addEventListener("hashchange", reveal);
  reveal();

  // Stiffnesses for the reader's own E, nu and edge, from the recommended lines.
  const form = document.getElementById("calculator");
  if (!form) return;
  const lines = [...document.querySelectorAll("#recommended li")];
  for (const line of lines) form.nu.add(new Option(line.dataset.nu));
  form.nu.value = lines.some((line) => line.dataset.nu === "0.45") ? "0.45" : lines[0] && lines[0].dataset.nu;
  function answer() {
    const line = lines.find((one) => one.dataset.nu === form.nu.value);
    const young = Number(form.young.value) / 1000, edge = Number(form.edge.value); // MPa, mm
    const output = form.querySelector("output");
    if (!line || !(young > 0) || !(edge > 0)) {
      output.textContent = "give E > 0 and an edge > 0";
      return;
    }
    const k = (name) => (1000 * young * edge * Number(line.dataset[name])).toPrecision(4);
    output.textContent = `${line.dataset.design}: k_e = ${k("edge")}, k_f = ${k("face")}, k_d = ${k("internal")} N/m, ` +
      `k_v = ${(young * Number(line.dataset.volume)).toPrecision(4)} MPa. ${line.querySelector(".expected").textContent}`;
  }
  form.addEventListener("input", answer);
  form.addEventListener("submit", (event) => event.preventDefault());
  form.hidden = lines.length === 0;
  answer();
})();
