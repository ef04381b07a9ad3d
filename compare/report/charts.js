// Charts, drawn by Chart.js in the page's colours, light and dark.
"use strict";
// Okabe and Ito (2008): the colour-blind tell them apart; dashes and markers do so again.
const palette = ["#d55e00", "#0072b2", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];
const dashes = [[], [7, 3], [2, 3]];
const markers = ["circle", "triangle", "rect", "rectRot", "cross", "star"];
const look_of = (index) => ({ colour: palette[index % palette.length], dash: dashes[Math.floor(index / palette.length) % dashes.length],
  marker: markers[(index + Math.floor(index / palette.length)) % markers.length] });

const live_charts = [];
const page_colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
function colour_charts() {
  Chart.defaults.color = page_colour("--quiet");
  Chart.defaults.borderColor = page_colour("--line");
  Chart.defaults.font.family = getComputedStyle(document.body).fontFamily;
  Object.assign(Chart.defaults.plugins.tooltip, { backgroundColor: page_colour("--paper"), titleColor: page_colour("--ink"),
    bodyColor: page_colour("--ink"), borderColor: page_colour("--quiet"), borderWidth: 1, usePointStyle: true });
}
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  colour_charts();
  for (const chart of live_charts) {
    for (const axis of Object.values(chart.options.scales)) {
      axis.ticks.color = axis.title.color = Chart.defaults.color;
      axis.grid.color = Chart.defaults.borderColor;
    }
    Object.assign(chart.options.plugins.tooltip, Chart.defaults.plugins.tooltip);
    chart.update();
  }
});

const axis = (title, more) => ({ title: { display: true, text: title }, grid: {}, ...more, ticks: { ...(more && more.ticks) } });

// A chart in a frame of its own; the pointer finds all values at its place. The arrow keys go through its values as the pointer does.
// @param label  what a screen reader says of it
function chart(label, kind, config) {
  const canvas = make("canvas", { role: "img", tabindex: 0, "aria-label": label });
  const frame = make("div", { class: "chart " + kind }, canvas);
  // Chart.js measures the frame, which has no size before it is on the page.
  frame.draw = () => {
    colour_charts();
    const interaction = { mode: "index", intersect: false, ...config.options.interaction };
    const options = { animation: false, maintainAspectRatio: false, ...config.options, interaction };
    const drawn = new Chart(canvas, { ...config, options });
    live_charts.push(drawn);
    let at = -1;
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      const n = Math.max(...drawn.data.datasets.map((set) => set.data.length));
      at = at < 0 && step < 0 ? n - 1 : (at + step + n) % n;
      const active = drawn.data.datasets.map((set, datasetIndex) => ({ datasetIndex, index: at })).filter(({ datasetIndex }) =>
        drawn.isDatasetVisible(datasetIndex) && drawn.data.datasets[datasetIndex].data.length === n &&
        drawn.getDatasetMeta(datasetIndex).data[at] && !drawn.getDatasetMeta(datasetIndex).data[at].skip);
      drawn.setActiveElements(active);
      const point = ({ datasetIndex }) => drawn.getDatasetMeta(datasetIndex).data[at].getCenterPoint();
      if (active.length > 0) drawn.tooltip.setActiveElements(active, point(active[0]));
      drawn.update();
    });
    return drawn;
  };
  return frame;
}

// Marks in front of a line's name: its colour, and its dashes.
const swatch = (look) => make("span", { class: "swatch", style: `border-top: 3px ${["solid", "dashed", "dotted"][
  dashes.indexOf(look.dash)]} ${look.colour}` });
