"use strict";

const canvas = document.getElementById("view"), state_line = document.getElementById("state");
const socket = new WebSocket(socket_address);
socket.binaryType = "arraybuffer";
const send = (message) => {
  if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
};

let description = null, surface = null, frame = null, view = null;
const seen = {
  frames: 0,
  since: performance.now(),
  rate: 0,
  asked_at: 0,
  answer_ms: 0,   // from a question to its frame
  latency_ms: [], // from the pointer's move to the picture of a step that has it, of the last ones
  bytes: 0,
  resolution: 1,  // of the picture, as a part of the screen's
  n_late: 0,      // frames that came before the last one was drawn, since the last count
  n_coarsened: 0  // how often it was made coarser
};                // for the panel and for tests
const least_between_ms = 10; // of questions, and of moves: the server cuts off who says more than 300 a second

function is_drawn_by_processor() {
  const gl = document.createElement("canvas").getContext("webgl");
  const names = gl?.getExtension("WEBGL_debug_renderer_info");
  return !names || /swiftshader|llvmpipe|software/i.test(gl.getParameter(names.UNMASKED_RENDERER_WEBGL));
}

class View {
  constructor() {
    const antialias = (window.devicePixelRatio || 1) < 2 && !is_drawn_by_processor();
    this.renderer = new THREE.WebGLRenderer({canvas, antialias, alpha: true});
    this.renderer.setClearColor(0x000000, 0);
    this.scene = new THREE.Scene();
    this.geometry = new THREE.BufferGeometry();
    this.positions = new THREE.BufferAttribute(surface.positions, 3);
    this.positions.setUsage(THREE.DynamicDrawUsage);
    this.geometry.setAttribute("position", this.positions);
    this.geometry.setIndex(new THREE.BufferAttribute(surface.triangles, 1));
    this.normals = new THREE.BufferAttribute(surface.normals, 3);
    this.normals.setUsage(THREE.DynamicDrawUsage);
    this.geometry.setAttribute("normal", this.normals);
    this.mesh = new THREE.Mesh(
        this.geometry,
        new THREE.MeshPhongMaterial({color: 0xd89a8c, shininess: 25, side: THREE.DoubleSide}));
    this.mesh.frustumCulled = false; // its vertices move under the sphere that would be asked
    this.spring = new THREE.Line(new THREE.BufferGeometry().setAttribute(
                                     "position", new THREE.BufferAttribute(new Float32Array(6), 3)),
                                 new THREE.LineBasicMaterial({color: 0x00639c}));
    this.spring.frustumCulled = this.spring.visible = false;
    this.handle = new THREE.Mesh(new THREE.SphereBufferGeometry(1, 16, 12),
                                 new THREE.MeshBasicMaterial({color: 0x00639c}));
    this.handle.visible = false;
    this.camera = new THREE.PerspectiveCamera(35, 1, 1, 1000);
    this.camera.up.set(0, 0, 1);
    const light = new THREE.DirectionalLight(0xffffff, 0.75);
    light.position.set(0.5, 1, 0.8);
    this.camera.add(light);
    this.scene.add(this.mesh, this.spring, this.handle, this.camera,
                   new THREE.HemisphereLight(0xffffff, 0x777788, 0.55));
    const ball =
        new THREE.Box3().setFromBufferAttribute(this.positions).getBoundingSphere(new THREE.Sphere());
    this.size = ball.radius || 1;
    this.handle.scale.setScalar(0.015 * this.size);
    this.camera.position.copy(ball.center)
        .addScaledVector(new THREE.Vector3(0.5, -0.9, 0.45).normalize(), 4.2 * this.size);
    Object.assign(this.camera, {near: 0.01 * this.size, far: 100 * this.size});
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.target.copy(ball.center);
    this.controls.update();
  }
  moved() {
    this.positions.needsUpdate = this.normals.needsUpdate = true;
    this.geometry.boundingSphere = null;
  }
  draw_less() { // fewer pixels, light at the vertices alone, coarser triangles: where a processor draws
    const cubes = [56, 40, 28][seen.n_coarsened];
    if (cubes === undefined) return;
    ++seen.n_coarsened;
    seen.resolution *= 0.8;
    this.mesh.material = new THREE.MeshLambertMaterial({color: 0xd89a8c, side: THREE.DoubleSide});
    surface.coarsen(cubes);
    this.geometry.setIndex(new THREE.BufferAttribute(surface.drawn, 1));
  }
  wait_for_picture() { // a pixel is read when all are drawn
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }
  draw() {
    const width = canvas.clientWidth, height = canvas.clientHeight;
    const size = `${width} ${height} ${seen.resolution}`;
    if (size !== this.drawn_size) { // it clears the picture
      this.renderer.setPixelRatio((window.devicePixelRatio || 1) * seen.resolution);
      this.renderer.setSize(width, height, false);
      this.drawn_size = size;
    }
    this.camera.aspect = width / Math.max(1, height);
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
  }
  ray(event) {
    const box = canvas.getBoundingClientRect(), caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2(2 * (event.clientX - box.left) / box.width - 1,
                                           1 - 2 * (event.clientY - box.top) / box.height),
                         this.camera);
    return caster;
  }
}

// A pull goes in the plane of the screen through the place where it began.
const pull = {
  plane: null,
  from: null,
  by: null,
  held_from: null,
  is_new: false, // the last move is not sent yet
  sent_at: 0,
  n_sent: 0,  // drags, after those that the simulation had when the page was loaded
  moved_at: [] // when the pointer moved, of the drags that no picture shows yet
};

function begin_pull(event) {
  if (!view || event.button !== 0) return;
  const caster = view.ray(event), hit = caster.intersectObject(view.mesh)[0];
  if (!hit) return; // the controls turn the body
  view.controls.enabled = false;
  canvas.setPointerCapture(event.pointerId);
  pull.plane = new THREE.Plane().setFromNormalAndCoplanarPoint(
      view.camera.getWorldDirection(new THREE.Vector3()), hit.point);
  pull.from = hit.point.clone();
  pull.by = new THREE.Vector3();
  pull.held_from = null;
  send({type: "grab", origin: caster.ray.origin.toArray(), direction: caster.ray.direction.toArray()});
}
function go_on(event) {
  if (!pull.plane) return;
  const place = view.ray(event).ray.intersectPlane(pull.plane, new THREE.Vector3());
  if (!place) return;
  pull.by = place.sub(pull.from);
  if (!pull.is_new) pull.newest_at = event.timeStamp;
  pull.is_new = true;
  send_drag();
}
function send_drag() { // a mouse may move more often
  const now = performance.now();
  if (!pull.plane || !pull.is_new || now - pull.sent_at < least_between_ms) return;
  send({type: "drag", by: pull.by.toArray()});
  pull.is_new = false;
  pull.sent_at = now;
  ++pull.n_sent;
  pull.moved_at.push(pull.newest_at);
}
function end_pull() {
  if (!pull.plane) return;
  pull.plane = null;
  view.controls.enabled = true;
  send({type: "release"});
}
canvas.addEventListener("pointerdown", begin_pull, true); // before the controls
canvas.addEventListener("pointermove", go_on);
canvas.addEventListener("pointerup", end_pull);
canvas.addEventListener("pointercancel", end_pull);
document.getElementById("restart").addEventListener("click", () => send({type: "restart"}));

function ask() {
  seen.asked_at = performance.now();
  send_drag();
  send({type: "frame"});
}

function show_frame() {
  surface.move(frame.displacement);
  view.moved();
  const is_held = frame.held >= 0 && pull.plane !== null;
  view.spring.visible = view.handle.visible = is_held;
  if (is_held) {
    const place = surface.place(frame.held);
    if (!pull.held_from) pull.held_from = place.clone();
    const end = pull.held_from.clone().add(pull.by), ends = view.spring.geometry.attributes.position;
    ends.setXYZ(0, place.x, place.y, place.z);
    ends.setXYZ(1, end.x, end.y, end.z);
    ends.needsUpdate = true;
    view.handle.position.copy(end);
  }
  view.draw();
  ++seen.frames;
  const now = performance.now();
  if (now - seen.since > 500) {
    const n_drawn = seen.frames - (seen.counted || 0);
    seen.rate = 1000 * n_drawn / (now - seen.since);
    seen.counted = seen.frames;
    seen.since = now;
    // Slow steps bring few frames, and a page in the background draws none: neither is for want of a processor.
    if (seen.rate < 30 && seen.n_late > 0.25 * n_drawn && !document.hidden) view.draw_less();
    seen.n_late = 0;
    show_numbers();
  }
}

function draw_newest() {
  view.is_due = false;
  if (view.asks_later) ask();
  view.asks_later = false;
  show_frame();
  const n_shown = pull.moved_at.length - (pull.n_sent - (frame.drags - seen.drags_before));
  if (n_shown > 0) view.wait_for_picture();
  for (const moved_at of pull.moved_at.splice(0, Math.max(0, n_shown)))
    seen.latency_ms.push(performance.now() - moved_at);
  if (seen.latency_ms.length > 500) seen.latency_ms.splice(0, seen.latency_ms.length - 500);
}

function show_numbers() {
  const rows = [
    [ "masses", description.masses ], [ "unknowns", description.unknowns ],
    [ "triangles", description.triangles ], [ "drawn", surface.drawn.length / 3 ],
    [ "time step", `${+ (1000 * description.step_s).toPrecision(4)} ms` ],
    [ "a step takes (median)", `${frame.median_ms.toFixed(3)} ms` ],
    [ "99 % of steps below", `${frame.p99_ms.toFixed(3)} ms` ],
    [ "steps a second", frame.steps_per_second.toFixed(1) ], [ "pictures a second", seen.rate.toFixed(1) ],
    [ "time", `${frame.time.toFixed(2)} s` ], [ "pull", `${frame.force.toPrecision(3)} N` ]
  ];
  document.querySelector("dl").replaceChildren(...rows.flatMap(([ name, value ]) => {
    const term = document.createElement("dt"), text = document.createElement("dd");
    term.textContent = name;
    text.textContent = value;
    return [ term, text ];
  }));
  const problems = [];
  if (frame.inverted > 0) problems.push(`${frame.inverted} cells are inside out`);
  if (frame.failures > 0)
    problems.push(`${frame.failures} steps could not be solved; each began anew from rest`);
  state_line.textContent = problems.join("; ") || "in control";
  state_line.classList.toggle("problem", problems.length > 0);
}

socket.addEventListener("message", (event) => {
  if (typeof event.data === "string") {
    description = JSON.parse(event.data);
    document.querySelector("h1").textContent = description.name;
    state_line.textContent = "in control";
  } else if (!surface) {
    surface = new Surface(event.data);
    view = new View();
    view.draw();
    ask();
  } else {
    seen.bytes = event.data.byteLength;
    seen.answer_ms = performance.now() - seen.asked_at;
    frame = read_frame(event.data);
    seen.drags_before ??= frame.drags;
    if (performance.now() - seen.asked_at >= least_between_ms)
      ask(); // the next one is made while this one is drawn
    else
      view.asks_later = true;
    if (view.is_due)
      ++seen.n_late;
    else
      requestAnimationFrame(draw_newest);
    view.is_due = true;
  }
});
socket.addEventListener("close", () => {
  state_line.textContent = "The simulation has ended, or another page is in control.";
  state_line.classList.add("problem");
});
