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
  latency_ms: 0,
  bytes: 0
}; // for the panel and for tests

class View {
  constructor() {
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: true, alpha: true});
    this.renderer.setClearColor(0x000000, 0);
    this.scene = new THREE.Scene();
    this.geometry = new THREE.BufferGeometry();
    this.positions = new THREE.BufferAttribute(surface.positions, 3);
    this.positions.setUsage(THREE.DynamicDrawUsage);
    this.geometry.setAttribute("position", this.positions);
    this.geometry.setIndex(new THREE.BufferAttribute(surface.triangles, 1));
    this.geometry.computeVertexNormals();
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
    this.positions.needsUpdate = true;
    this.geometry.computeVertexNormals();
    this.geometry.boundingSphere = null;
  }
  draw() {
    const width = canvas.clientWidth, height = canvas.clientHeight;
    this.renderer.setPixelRatio(window.devicePixelRatio || 1);
    this.renderer.setSize(width, height, false);
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
  held_from: null
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
  pull.is_new = true; // sent once a picture: a mouse moves more often
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
  if (pull.plane && pull.is_new) {
    send({type: "drag", by: pull.by.toArray()});
    pull.is_new = false;
  }
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
    seen.rate = 1000 * (seen.frames - (seen.counted || 0)) / (now - seen.since);
    seen.counted = seen.frames;
    seen.since = now;
    show_numbers();
  }
}

function show_numbers() {
  const rows = [
    [ "masses", description.masses ], [ "unknowns", description.unknowns ],
    [ "triangles", description.triangles ],
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
    seen.latency_ms = performance.now() - seen.asked_at;
    frame = read_frame(event.data);
    requestAnimationFrame(() => {
      show_frame();
      ask();
    });
  }
});
socket.addEventListener("close", () => {
  state_line.textContent = "The simulation has ended, or another page is in control.";
  state_line.classList.add("problem");
});
