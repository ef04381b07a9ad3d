// Appended to a copy of a dossier's page by dossier_test.py: leaves what the page shows as JSON for --dump-dom.
"use strict";
(function () {
  const rows = {}, text = document.querySelector("main").innerText;
  for (const table of document.querySelectorAll("table[data-table]")) rows[table.dataset.table] = table.rows.length;
  const found = { errors: window.errors, title: document.title, rows, text,
    sections: [...document.querySelectorAll("main > section")].map((section) => section.id),
    images: document.querySelectorAll("main img").length,
    no_gate: [...document.querySelectorAll("td .quiet")].filter((span) => span.textContent === "no gate").length,
    dead_links: [...document.querySelectorAll("main a[href^='#']")].map((link) => link.getAttribute("href").slice(1))
      .filter((id) => !document.getElementById(id)) };
  const result = document.createElement("script");
  result.type = "application/json";
  result.id = "found";
  result.textContent = JSON.stringify(found).replace(/</g, "\\u003c");
  document.body.append(result);
})();
