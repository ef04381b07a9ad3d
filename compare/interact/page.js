"use strict";

const stage = document.getElementById("view"), canvas = stage.firstChild, state_line = document.getElementById("state");
const socket = new WebSocket(socket_address);
socket.binaryType = "arraybuffer";
const send = (message) => {
  if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
};

let description = null, surface = null, frame = null, view = null;
const seen = {
  frames: 0,
  pictures: 0, // frames that were drawn: one that looks like the last is not
  since: performance.now(),
  rate: 0, // pictures a second
  asked_at: 0,
  answer_ms: 0,   // time from a question to its frame
  latency_ms: [], // times from the pointer's move to the picture of a step that has it, the last ones
  on_page_ms: [], // the same to the page's next refresh, which shows the picture
  bytes: 0
};                // for the panel and for tests
const least_between_ms = 10; // interval of questions, and of moves: the server cuts off above 300 a second

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
  const caster = view.ray(event), hit = caster.intersectObjects([view.drawn.mesh, ...view.tools])[0];
  if (!hit) return; // the controls turn the body
  view.controls.enabled = false;
  stage.setPointerCapture(event.pointerId);
  pull.plane = new THREE.Plane().setFromNormalAndCoplanarPoint(
      view.camera.getWorldDirection(new THREE.Vector3()), hit.point);
  pull.from = hit.point.clone();
  pull.by = new THREE.Vector3();
  pull.held_from = null;
  const tool = view.tools.indexOf(hit.object);
  if (tool >= 0)
    send({type: "grab_tool", tool});
  else
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
stage.addEventListener("pointerdown", begin_pull, true); // before the controls
// The raw moves do not wait for the next picture, where a browser has them.
stage.addEventListener("onpointerrawupdate" in stage ? "pointerrawupdate" : "pointermove", go_on);
stage.addEventListener("pointerup", end_pull);
stage.addEventListener("pointercancel", end_pull);
document.getElementById("restart").addEventListener("click", () => send({type: "restart"}));

function ask() {
  seen.asked_at = performance.now();
  send_drag();
  send({type: "frame"});
}

function draw_newest() {
  view.is_due = false;
  if (view.asks_later) ask();
  view.asks_later = false;
  if (view.show(frame)) ++seen.pictures;
  ++seen.frames;
  const n_shown = pull.moved_at.length - (pull.n_sent - (frame.drags - seen.drags_before)), now = performance.now();
  const answered = pull.moved_at.splice(0, Math.max(0, n_shown));
  const note = (times, at) => {
    for (const moved_at of answered) times.push(at - moved_at);
    if (times.length > 500) times.splice(0, times.length - 500);
  };
  note(seen.latency_ms, now);
  if (answered.length > 0) requestAnimationFrame(() => note(seen.on_page_ms, performance.now()));
  if (now - seen.since < 500) return;
  seen.rate = 1000 * (seen.pictures - (seen.counted || 0)) / (now - seen.since);
  seen.counted = seen.pictures;
  seen.since = now;
  show_numbers();
}

const numbers = new Map(); // the panel's texts by their names
function show_number(name, value) {
  if (!numbers.has(name)) {
    const term = document.createElement("dt"), text = document.createElement("dd");
    term.textContent = name;
    numbers.set(name, text.appendChild(document.createTextNode("")));
    document.querySelector("dl").append(term, text);
  }
  if (numbers.get(name).data !== String(value)) numbers.get(name).data = value;
}

function show_numbers() {
  const milliseconds = (number) => `${number < 100 ? number.toPrecision(3) : number.toFixed(0)} ms`;
  const percent = 100 * frame.residual;
  const rows = [
    [ "a step takes (median)", milliseconds(frame.median_ms) ], [ "99 % of steps below", milliseconds(frame.p99_ms) ],
    [ "60 Hz", frame.p99_ms <= 1000 / 60 ? "kept" : "not kept" ],
    [ "residual of the step", `${percent < 10 ? percent.toPrecision(2) : percent.toFixed(0)} %` ],
    [ "pull", `${frame.force.toPrecision(3)} N` ], [ "time", `${frame.time.toFixed(2)} s` ],
    [ "time step", `${+ (1000 * description.step_s).toPrecision(4)} ms` ],
    [ "steps a second", frame.steps_per_second.toFixed(1) ],
    [ "pictures a second", seen.rate > 0 ? seen.rate.toFixed(1) : "nothing moves" ],
    [ "masses", description.masses ], [ "unknowns", description.unknowns ],
    [ "triangles", description.triangles ], [ "drawn", view.drawn.triangles.length / 3 ]
  ];
  description.tools.forEach((tool, i) => {
    const force = Math.hypot(...frame.tools.subarray(6 * i + 3, 6 * i + 6));
    rows.push([ `${tool.name} presses with`, `${force.toPrecision(3)} N` ]);
  });
  for (const [name, value] of rows) show_number(name, value);
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
    document.getElementById("method").textContent = description.method;
    state_line.textContent = "in control";
  } else if (!surface) {
    surface = new Surface(event.data, 0);
    view = new View(surface, surface.end < event.data.byteLength ? new Surface(event.data, surface.end) : null,
                    description.tools);
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
    // Not at the next refresh: what is drawn by then is on the page with it, what begins then a refresh later. A page
    // in the background draws nothing.
    if (!view.is_due) document.hidden ? requestAnimationFrame(draw_newest) : setTimeout(draw_newest);
    view.is_due = true;
  }
});
socket.addEventListener("close", () => {
  state_line.textContent = "The simulation has ended, or another page is in control.";
  state_line.classList.add("problem");
});
