// Deformed bodies to turn, drawn by three.js: finite elements as lines on a translucent surface, springs as lines or as a surface
// that shows their error. One WebGL renderer draws them all, each into a canvas of its own (browsers allow few WebGL contexts), and
// one row of controls, as one turn, moves them all.
"use strict";
const body_colours = { fem: 0x0072b2, springs: 0xd55e00 };
const viridis = ["#440154", "#3b528b", "#21918c", "#5ec962", "#fde725"];

// Each pair of nodes once, in either direction.
function unique_lines(pairs) {
  const seen = new Set();
  return pairs.filter(([a, b]) => {
    const key = Math.min(a, b) + "," + Math.max(a, b);
    return !seen.has(key) && seen.add(key);
  }).flat();
}

function surface_of(of_body) {
  const triangles = [], edges = [], diagonals = [];
  const n = of_body.corners; // 3 or 4 a face, 2 a line
  for (let f = 0; f < of_body.faces.length; f += n) {
    const face = of_body.faces.slice(f, f + n), [a, b, c, d] = face;
    face.forEach((from, i) => edges.push([from, face[(i + 1) % n]]));
    if (n > 2) triangles.push(a, b, c);
    if (n < 4) continue;
    triangles.push(a, c, d);
    diagonals.push([a, c], [b, d]);
  }
  return { triangles, edges: unique_lines(edges), diagonals: unique_lines(diagonals) };
}

const known_surfaces = new Map(); // index of a body -> its surface_of()

// Nodes of one side at displacements times a scale, mm.
class Side {
  constructor(side) {
    const of_body = report.views.bodies[side.body];
    this.body = side.body;
    this.rest = of_body.rest.map((x) => x * of_body.unit_mm);
    this.displacement = side.displacement.map((u) => u * side.unit_mm);
    this.positions = new THREE.BufferAttribute(new Float32Array(this.rest.length), 3);
    this.group = new THREE.Group();
  }
  get surface() {
    if (!known_surfaces.has(this.body)) known_surfaces.set(this.body, surface_of(report.views.bodies[this.body]));
    return known_surfaces.get(this.body);
  }
  add(index, kind, material) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", this.positions);
    if (this.colours) geometry.setAttribute("color", this.colours);
    geometry.setIndex(index);
    const object = new kind(geometry, material);
    object.frustumCulled = false; // the positions move under the geometry's bounding sphere
    this.group.add(object);
    return object;
  }
  add_lines(index, colour, opacity) {
    return this.add(index, THREE.LineSegments, new THREE.LineBasicMaterial({ color: colour, transparent: opacity < 1, opacity }));
  }
  node(i) { return [0, 1, 2].map((axis) => this.displacement[3 * i + axis]); }
  move(scale) {
    const to = this.positions.array;
    for (let i = 0; i < to.length; ++i) to[i] = this.rest[i] + scale * this.displacement[i];
    this.positions.needsUpdate = true;
  }
}

const length_of = ([x, y, z]) => Math.hypot(x, y, z);
const largest_of = (values) => values.reduce((largest, value) => Math.max(largest, value), 0);
const nodes_of = (side) => Array.from({ length: side.rest.length / 3 }, (_, i) => i);

// |u_springs - u_fem| at the springs' nodes over the largest |u_fem|; null unless each stands at rest where a node of the finite
// elements does.
function errors_of(springs, fem) {
  let twin = (i) => i;
  if (springs.body !== fem.body) {
    const size = largest_of(fem.rest.map(Math.abs)) || 1;
    const place = (side, i) => [0, 1, 2].map((axis) => Math.round(1e4 * side.rest[3 * i + axis] / size)).join();
    const known = new Map(nodes_of(fem).map((i) => [place(fem, i), i]));
    twin = (i) => known.get(place(springs, i));
  }
  const nodes = nodes_of(springs), largest = largest_of(nodes_of(fem).map((i) => length_of(fem.node(i))));
  if (!(largest > 0) || nodes.some((i) => twin(i) === undefined)) return null;
  return nodes.map((i) => length_of(fem.node(twin(i)).map((u, axis) => springs.node(i)[axis] - u)) / largest);
}

const colour_scale = viridis.map((colour) => new THREE.Color(colour));
function colour_at(share) {
  const at = Math.min(share, 1) * (colour_scale.length - 1), low = Math.min(Math.floor(at), colour_scale.length - 2);
  return colour_scale[low].clone().lerp(colour_scale[low + 1], at - low);
}
// Colours of vertices, from 0 to the largest value.
function colours_of(values) {
  const largest = largest_of(values) || 1;
  return new THREE.BufferAttribute(new Float32Array(values.flatMap((value) => colour_at(value / largest).toArray())), 3);
}

let shared_renderer = null; // made when the first view needs it
function renderer() {
  if (!shared_renderer) {
    shared_renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
    shared_renderer.setClearColor(0x000000, 0);
  }
  return shared_renderer;
}

// A picture to turn: the pointer and the arrow keys turn all pictures of its group, { eye, pictures }. The eye is a direction: rays
// are parallel.
class TurnedPicture {
  constructor(canvas, group) {
    Object.assign(this, { canvas, group, radius: 1, scene: new THREE.Scene() });
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    Object.assign(this.controls, { enableZoom: false, enablePan: false, enableKeys: false });
    this.controls.addEventListener("change", () => this.turned());
    canvas.addEventListener("keydown", (event) => this.key(event));
    // No frame around what the pointer holds; the controls focus the canvas then.
    canvas.addEventListener("pointerdown", () => canvas.classList.add("held"));
    canvas.addEventListener("blur", () => canvas.classList.remove("held"));
  }
  // Keeps what lies in a sphere inside the picture, whichever way it is turned.
  frame(sphere) {
    this.radius = sphere.radius || 1;
    this.controls.target.copy(sphere.center);
    this.look();
  }
  look() {
    const { eye } = this.group;
    this.camera.position.copy(this.controls.target).addScaledVector(eye, this.radius / eye.length());
    Object.assign(this.camera, { near: -10 * this.radius, far: 10 * this.radius });
    this.is_looking = true; // its change is not a turn by the pointer
    this.controls.update();
    this.is_looking = false;
  }
  turned() {
    if (this.is_looking) return;
    this.group.eye.copy(this.camera.position).sub(this.controls.target).normalize();
    this.group.pictures.forEach((picture) => {
      if (picture !== this) picture.look();
      picture.draw();
    });
  }
  key(event) {
    const [around, up] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key] || [];
    if (around === undefined) return;
    event.preventDefault();
    this.canvas.classList.remove("held");
    const { eye, pictures } = this.group, step = Math.PI / 18, turn = new THREE.Spherical().setFromCartesianCoords(eye.y, eye.z, eye.x);
    turn.theta += around * step;
    turn.phi = Math.min(Math.max(turn.phi - up * step, 0.05), Math.PI - 0.05);
    const { x, y, z } = new THREE.Vector3().setFromSpherical(turn);
    eye.set(z, x, y);
    pictures.forEach((picture) => { picture.look(); picture.draw(); });
  }
  draw() {
    const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
    if (width === 0 || height === 0) return;
    const density = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(width * density);
    this.canvas.height = Math.round(height * density);
    const half = this.radius / Math.min(width, height);
    Object.assign(this.camera, { left: -half * width, right: half * width, top: half * height, bottom: -half * height });
    this.camera.updateProjectionMatrix();
    this.light_up();
    renderer().setSize(this.canvas.width, this.canvas.height, false);
    renderer().render(this.scene, this.camera);
    this.canvas.getContext("2d").drawImage(renderer().domElement, 0, 0);
  }
}

// Whether this browser has WebGL; if it has none, the section says so.
function can_draw(section, what) {
  try {
    return renderer() !== null;
  } catch (error) {
    section.replaceChildren(make("p", { class: "problem" }, "This browser has no WebGL, which draws " + what));
    return false;
  }
}

// Draws anew when the page has another size or other colours.
function draw_with_page(pictures) {
  const draw = () => pictures.forEach((picture) => picture.draw());
  window.addEventListener("resize", draw);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
}

// The colours of errors from 0 to the largest.
const error_legend = (largest, note) => make("div", { class: "error-legend" }, make("span", null, "0"), make("span", {
  class: "scale-bar", style: `background: linear-gradient(to right, ${viridis.join(", ")})` }), make("span", null, largest), note);

const live_views = new Map(); // id -> View
// What one control sets for all bodies.
const seen_from = [0.5, -0.9, 0.4];
const shown = { scale: 1, colour: "error", fem: true, springs: true, eye: new THREE.Vector3(...seen_from), pictures: live_views };

class View extends TurnedPicture {
  constructor(record) {
    const figure = document.getElementById("view-" + record.id);
    super(figure.querySelector("canvas"), shown);
    Object.assign(this, { record, figure });
    this.fem = record.fem && new Side(record.fem);
    this.springs = record.springs && new Side(record.springs);
    this.errors = this.fem && this.springs ? errors_of(this.springs, this.fem) : null;
    if (this.fem) this.add_fem();
    if (this.springs) this.add_springs();
    // What lies behind fades into the page: lines alone say nothing of depth.
    this.scene.fog = new THREE.Fog(0xffffff);
    this.update();
  }
  add_fem() {
    this.fem.veil = this.fem.add(this.fem.surface.triangles, THREE.Mesh, new THREE.MeshBasicMaterial({ color: body_colours.fem,
      transparent: true, opacity: 0.16, side: THREE.DoubleSide, depthWrite: false }));
    this.fem.add_lines(this.fem.surface.edges, body_colours.fem, 0.75);
    this.scene.add(this.fem.group);
  }
  add_springs() {
    if (this.errors) {
      this.springs.colours = colours_of(this.errors);
      this.springs.skin = this.springs.add(this.springs.surface.triangles, THREE.Mesh, new THREE.MeshBasicMaterial({
        vertexColors: THREE.VertexColors, side: THREE.DoubleSide, fog: false, polygonOffset: true, polygonOffsetFactor: 1,
        polygonOffsetUnits: 1 }));
      this.springs.seams = this.springs.add_lines(this.springs.surface.edges, 0x000000, 0.35);
    }
    this.springs.lines = [this.springs.add_lines(this.springs.surface.edges, body_colours.springs, 1),
      this.springs.add_lines(this.springs.surface.diagonals, body_colours.springs, 0.35)];
    this.scene.add(this.springs.group);
  }
  get has_skin() { return this.errors !== null && shown.colour === "error"; }
  get scale() { return Math.min(shown.scale, this.record.largest_scale); }
  // Everything anew from what is shown.
  update() {
    for (const side of [this.fem, this.springs]) if (side) side.move(this.scale);
    if (this.fem) {
      this.fem.group.visible = shown.fem;
      this.fem.veil.visible = !(this.has_skin && shown.springs);
    }
    if (this.springs) {
      this.springs.group.visible = shown.springs;
      for (const line of this.springs.lines) line.visible = !this.has_skin;
      if (this.springs.skin) this.springs.skin.visible = this.springs.seams.visible = this.has_skin;
    }
    this.figure.querySelector(".scale").textContent = `displacements × ${this.scale.toFixed(1)}`;
    const legend = this.figure.querySelector(".error-legend");
    if (legend) legend.hidden = !this.has_skin;
    const box = new THREE.Box3(); // the deformed body and the body at rest
    for (const side of [this.fem, this.springs]) if (side) {
      box.union(new THREE.Box3().setFromBufferAttribute(side.positions));
      box.union(new THREE.Box3().setFromArray(side.rest));
    }
    this.frame(box.getBoundingSphere(new THREE.Sphere()));
    this.draw();
  }
  light_up() {
    Object.assign(this.scene.fog, { near: 0.8 * this.radius, far: 2.3 * this.radius });
    this.scene.fog.color.set(page_colour("--paper"));
  }
}

const view_records = new Map((report.views ? report.views.views : []).map((record) => [record.id, record]));
const update_bodies = () => live_views.forEach((view) => view.update());
function show_body(id) {
  if (!live_views.has(id)) live_views.set(id, new View(view_records.get(id)));
  return live_views.get(id);
}

// The section of bodies: one row of controls for all of them, and a figure each.
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
  cell(general(m.fem, 4)), cell(general(m.msm, 4)), cell(missing(m.error_percent) ? "–" : `${signed(m.error_percent, 1)} %`)])));

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
