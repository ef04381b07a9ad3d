// How the measures of a case in time went, in both models.
"use strict";
function motion() {
  const course = one_case && one_case.motion;
  if (!course || course.measures.length === 0) return null;
  // Measures that are numbers of one course, its peak and its frequency, say, share a picture.
  const courses = new Map();
  for (const measure of course.measures) {
    const key = JSON.stringify([measure.unit, measure.fem, measure.msm]);
    if (courses.has(key)) courses.get(key).names.push(measure.name);
    else courses.set(key, { ...measure, names: [measure.name] });
  }
  const line = (label, colour, borderDash, values) => ({ label, borderColor: colour, backgroundColor: colour, borderDash, borderWidth: 2,
    pointRadius: 0, pointHitRadius: 8, data: values.map((y, i) => ({ x: course.time[i], y })) });
  const picture = ({ names, unit, fem, msm }) => {
    const sets = [];
    if (fem.length > 0) sets.push(line("finite elements", palette[1], [], fem));
    if (msm.length > 0) sets.push(line("springs", palette[0], dashes[1], msm));
    const title = names.join(", ");
    const frame = chart(`${title} over time in both models. The arrow keys go from time to time.`, "motion", { type: "line",
      data: { datasets: sets }, options: { animation: false, maintainAspectRatio: false, interaction: { mode: "index", intersect: false },
        scales: { x: axis("time, s", { type: "linear", min: course.time[0], max: course.time[course.time.length - 1] }), y: axis(unit) },
        plugins: { legend: { position: "bottom", labels: { usePointStyle: true, pointStyle: "line" } }, tooltip: { callbacks: {
          title: (items) => `${general(items[0].parsed.x)} s`,
          label: (item) => `${item.dataset.label}: ${general(item.parsed.y)} ${unit}` } } } } });
    frame.style.height = "20rem";
    return make("figure", null, make("figcaption", null, make("b", null, typeset(title))), frame);
  };
  return [[...courses.values()].map(picture), course.notes.map((text) => make("p", { class: "quiet" }, typeset(text))),
    course.drawn_every > 1 && make("p", { class: "quiet" }, `One step of ${course.drawn_every} is drawn.`)];
}
