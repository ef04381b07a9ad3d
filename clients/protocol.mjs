// springproof's client protocol for Node: docs/reference/client-protocol.md explains every key.
import { readSync, writeSync } from "node:fs";

/// Standard output is the protocol's alone: what libraries print goes to standard error.
console.log = console.info = console.warn = console.error;

function readAll() {
  const pieces = [];
  for (;;) {
    const piece = Buffer.alloc(1 << 16);
    let n = 0;
    try {
      n = readSync(0, piece);
    } catch (error) {
      if (error.code === "EAGAIN") continue;
      throw error;
    }
    if (n === 0) throw new Error("the scene ends early");
    pieces.push(piece.subarray(0, n));
    const all = Buffer.concat(pieces);
    const end = all.indexOf(10);
    if (end < 0) continue;
    const header = JSON.parse(all.subarray(0, end).toString());
    const size = header.arrays.reduce((sum, { shape }) => sum + 8 * shape[0] * shape[1], 0);
    if (all.length >= end + 1 + size) return { header, bytes: all.subarray(end + 1, end + 1 + size) };
  }
}

/// The header of the scene, and its arrays: `rows`, `columns` and `at(row, column)`.
export function readScene() {
  const { header, bytes } = readAll();
  const arrays = {};
  let at = 0;
  for (const { name, shape } of header.arrays) {
    const [rows, columns] = shape;
    const values = new Float64Array(rows * columns);
    for (let i = 0; i < values.length; ++i) values[i] = bytes.readDoubleLE(at + 8 * i);
    arrays[name] = { rows, columns, values, at: (row, column) => values[row * columns + column] };
    at += 8 * values.length;
  }
  return { header, arrays };
}

function write(bytes) {
  for (let at = 0; at < bytes.length;) {
    try {
      at += writeSync(1, bytes, at);
    } catch (error) {
      if (error.code !== "EAGAIN") throw error;
    }
  }
}

export function say(line, values) {
  write(Buffer.from(JSON.stringify(line) + "\n"));
  if (values) write(Buffer.from(new Float64Array(values).buffer));
}

/// A load's factor at a time: a sine, or linear between points; at a jump what comes after it.
export function factor({ points, frequency }, t) {
  if (frequency !== 0) return Math.sin(2 * Math.PI * frequency * t);
  if (points.length === 0) return 1;
  const next = points.findIndex(([time]) => time > t);
  if (next === 0) return points[0][1];
  if (next < 0) return points.at(-1)[1];
  const [t0, f0] = points[next - 1], [t1, f1] = points[next];
  return f0 + ((f1 - f0) * (t - t0)) / (t1 - t0);
}

/// The nodes that are held in all three components, and the number of those held in fewer.
export function heldNodes({ supports }) {
  const count = new Map();
  for (let i = 0; i < supports.rows; ++i) {
    const node = supports.at(i, 0);
    count.set(node, (count.get(node) ?? 0) + 1);
  }
  const whole = [...count].filter(([, n]) => n === 3).map(([node]) => node);
  return { whole: new Set(whole), partly: count.size - whole.length };
}

/// What engines ignore that take E and nu on tetrahedra, and hold whole nodes alone.
/// @param held  heldNodes()
export function ignoredOnTetrahedra({ header, arrays }, held) {
  const ignored = ["springs and their terms: it takes E and nu on tetrahedra"];
  if (arrays.hexahedra) ignored.push("hexahedra: each is cut into 6 tetrahedra");
  if (held.partly > 0) ignored.push(`supports of single components (${held.partly} nodes)`);
  if (header.stiffness_damping > 0) ignored.push("stiffness_damping");
  if (header.question === "motion") ignored.push(`scheme ${header.scheme?.name}`);
  return ignored;
}

/// Ends a client that does not move supports, where a scene does.
export function refuseMovingSupports({ arrays }) {
  if (arrays.support_motion.values.every((x) => x === 0)) return;
  say({ error: "this client does not move supports" });
  process.exit(0);
}

/// A hexahedron, vertex i + 2j + 4k, cut into six tetrahedra around its diagonal from vertex 0 to 7.
export const sixTetrahedra = [
  [0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7],
];

/// Steps a body until it rests, or through the times of a motion, and says its frames. At rest is a body whose
/// nodes have stayed within 1e-4 of its largest displacement for half a second. One that never rests is given
/// by its mean over the second half of the time.
/// @param step  function(dt, t): one step from t - dt to t    @param positions  returns all nodes' places, m
export function answer({ header, arrays }, step, positions) {
  const rest = arrays.nodes.values, dt = header.step, n = arrays.nodes.rows;
  const spent = { seconds: 0, steps: 0 };
  const advance = (t) => {
    const start = performance.now();
    step(dt, t);
    spent.seconds += (performance.now() - start) / 1000;
    ++spent.steps;
    if (!positions().every(Number.isFinite)) {
      say({ error: `a node is at no finite place after ${t} s` });
      process.exit();
    }
  };
  const frame = (number, time, more, values = positions()) =>
    say({ frame: number, time, ...spent, has: "positions", nodes: n, ...more }, values);
  if (header.question === "motion") {
    header.times.forEach((time, number) => {
      if (number > 0) advance(time);
      frame(number, time, {});
    });
  } else {
    const every = Math.max(1, Math.round(0.5 / dt)), last = Math.round(header.end / dt);
    const sum = new Float64Array(3 * n), half = Math.floor(last / 2);
    let before = positions(), k = 0, atRest = false;
    while (k < last && !atRest) {
      advance(++k * dt);
      if (k > half) positions().forEach((x, i) => (sum[i] += x / (last - half)));
      if (k % every !== 0) continue;
      const now = positions();
      let moved = 0, largest = 0;
      for (let i = 0; i < now.length; ++i) {
        moved = Math.max(moved, Math.abs(now[i] - before[i]));
        largest = Math.max(largest, Math.abs(now[i] - rest[i]));
      }
      atRest = moved <= 1e-4 * largest;
      before = now;
    }
    if (atRest) frame(0, k * dt, { at_rest: true });
    else frame(0, k * dt, { at_rest: false, mean_from: half * dt }, sum);
  }
  say({ end: true });
}
