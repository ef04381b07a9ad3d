// Appended after axe-core to a copy of a page by accessibility_test.py: leaves axe's findings as JSON for --dump-dom.
"use strict";
axe.run(document, { resultTypes: ["violations"] }).then((results) => {
  const found = { errors: window.errors, passed: results.passes.length, violations: results.violations.map((rule) => ({ id: rule.id,
    impact: rule.impact, help: rule.help, elements: rule.nodes.slice(0, 5).map((node) => node.html.slice(0, 200)),
    why: rule.nodes[0].failureSummary })) };
  const result = document.createElement("script");
  result.type = "application/json";
  result.id = "found";
  result.textContent = JSON.stringify(found).replace(/</g, "\\u003c");
  document.body.append(result);
});
