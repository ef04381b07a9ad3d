// Puts the page together: which sections it has and in which order. A section without content is left out.
"use strict";
function about() {
  const { program, machine } = report.provenance;
  const fact = (name, value) => [make("dt", null, name), make("dd", null, value)];
  return [make("dl", { class: "facts" }, fact("program", `springproof ${program.version}, commit ${program.commit}`),
    fact("machine", `${machine.processor}, ${machine.cores} cores; ${machine.system}`),
    fact("compiler, BLAS", `${machine.compiler}; ${machine.blas}`), report.workers && fact("solves side by side", report.workers),
    report.times.map((time) => fact(time.phase, `${number(time.seconds)} s`))),
  folded("Licence of three.js and Chart.js, which draw the bodies and the charts",
    report.licences.map((text) => make("pre", null, text)))];
}

const page_sections = [["context", "Context", dossier_context], ["code", "Code verification", dossier_code],
  ["calculation", "Calculation verification", dossier_calculation], ["validation", "Validation", dossier_validation],
  ["applicability", "Applicability", dossier_applicability], ["missing", "Missing", dossier_missing], ["league", "League", league], ["verdict", "Verdict", verdict], ["skin", "Skin", skin], ["landmarks", "Landmarks", landmarks],
  ["measures", "Measures", measures], ["causes", "Causes", causes], ["motion", "Motion", motion], ["springs", "Springs", case_springs],
  ["choose", "Which springs", choose], ["designs", "Designs", designs], ["bodies", "Bodies", bodies],
  ["ranking", "Designs compared", ranked], ["tables", "Tables", tables],
  ["thesis", "The thesis, reproduced", thesis], ["repeat", "Again", repeat], ["about", "About this page", about]];

(function () {
  const main = document.querySelector("main"), nav = document.querySelector("nav"), links = new Map();
  const pictures = document.getElementById("pictures");
  document.querySelector("header").append(make("h1", null, report.heading), make("p", null, report.subheading));
  for (const [id, heading, section] of page_sections) {
    const content = section();
    if (!content || content.length === 0) continue;
    links.set(id, nav.appendChild(make("a", { href: "#" + id }, heading)));
    main.append(make("section", { id, "aria-labelledby": id + "-heading" }, make("h2", { id: id + "-heading" }, heading), content));
  }
  pictures.remove();
  for (const waiting of main.querySelectorAll("*")) if (waiting.draw) waiting.draw();

  // The section that is read is marked in the navigation.
  const watcher = new IntersectionObserver((seen) => {
    for (const { target, isIntersecting } of seen) if (isIntersecting) for (const [id, link] of links)
      if (id === target.id) link.setAttribute("aria-current", "true"); else link.removeAttribute("aria-current");
  }, { rootMargin: "-10% 0px -85% 0px" });
  links.values().next().value.setAttribute("aria-current", "true");
  for (const id of links.keys()) watcher.observe(document.getElementById(id));

  // A number's link leads into a closed list: open it.
  function reveal() {
    const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    const list = target && target.closest("details");
    if (list) list.open = true;
    if (target) target.scrollIntoView();
  }
  window.addEventListener("hashchange", reveal);
  reveal();
})();
