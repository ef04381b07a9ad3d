// The surface of a body as the server describes it: see Simulation::geometry() and frame().
"use strict";

class Surface {
  constructor(buffer) {
    const [n_vertices, n_triangles, n_nodes, n_spheres] = new Uint32Array(buffer, 0, 4);
    let at = 16;
    const take = (Kind, length) => {
      const values = new Kind(buffer, at, length);
      at += values.byteLength;
      return values;
    };
    this.n_nodes = n_nodes;
    this.rest = take(Float32Array, 3 * n_vertices);
    this.weights = take(Float32Array, 8 * n_vertices);
    this.nodes = take(Uint32Array, 8 * n_vertices);
    this.triangles = take(Uint32Array, 3 * n_triangles);
    this.spheres = take(Uint32Array, n_spheres);
    this.positions = Float32Array.from(this.rest);
    this.normals = new Float32Array(3 * n_vertices);
    this.drawn = this.triangles;
    this.turn();
  }
  // Positions of the vertices for the nodes' displacement.
  move(displacement) {
    const {rest, weights, nodes, positions} = this;
    for (let v = 0, w = 0; v < positions.length; v += 3) {
      let x = rest[v], y = rest[v + 1], z = rest[v + 2];
      for (const end = w + 8; w < end; ++w) {
        const weight = weights[w], node = 3 * nodes[w];
        x += weight * displacement[node];
        y += weight * displacement[node + 1];
        z += weight * displacement[node + 2];
      }
      positions[v] = x;
      positions[v + 1] = y;
      positions[v + 2] = z;
    }
    this.turn();
  }
  // Normals of the drawn triangles' vertices, weighted by areas; of any length, which the shader makes 1.
  turn() {
    const {positions, normals, drawn: triangles} = this;
    normals.fill(0);
    for (let t = 0; t < triangles.length; t += 3) {
      const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
      const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1],
            uz = positions[b + 2] - positions[a + 2];
      const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1],
            vz = positions[c + 2] - positions[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      for (const at of [a, b, c]) {
        normals[at] += x;
        normals[at + 1] += y;
        normals[at + 2] += z;
      }
    }
  }
  // Draws triangles between some of the vertices, one for each cube of this many along the longest axis: what is
  // left of the surface where its vertices in a cube are one (Rossignac and Borrel 1993).
  coarsen(n_cubes) {
    const lower = [Infinity, Infinity, Infinity], upper = [-Infinity, -Infinity, -Infinity], rest = this.rest;
    for (let v = 0; v < rest.length; ++v) {
      lower[v % 3] = Math.min(lower[v % 3], rest[v]);
      upper[v % 3] = Math.max(upper[v % 3], rest[v]);
    }
    const edge = Math.max(...upper.map((at, axis) => at - lower[axis])) / n_cubes;
    const first = new Map(), stands_for = new Uint32Array(rest.length / 3);
    for (let v = 0; v < stands_for.length; ++v) {
      const cube = lower.map((from, axis) => Math.floor((rest[3 * v + axis] - from) / edge)).join();
      if (!first.has(cube)) first.set(cube, v);
      stands_for[v] = first.get(cube);
    }
    const left = [];
    for (let t = 0; t < this.triangles.length; t += 3) {
      const [a, b, c] = [0, 1, 2].map((corner) => stands_for[this.triangles[t + corner]]);
      if (a !== b && b !== c && c !== a) left.push(a, b, c);
    }
    // Few triangles cost little, and a surface thinner than a cube would vanish.
    if (left.length < this.drawn.length && left.length >= 3 * 1000) this.drawn = Uint32Array.from(left);
  }
  place(vertex) { return new THREE.Vector3().fromArray(this.positions, 3 * vertex); }
}

const frame_numbers = [
  "time", "steps", "median_ms", "p99_ms", "steps_per_second", "inverted", "held", "force", "failures", "drags",
  "nodes"
];

function read_frame(buffer) {
  const numbers = new Float64Array(buffer, 0, frame_numbers.length), frame = {};
  frame_numbers.forEach((name, i) => { frame[name] = numbers[i]; });
  frame.displacement = new Float32Array(buffer, 8 * frame_numbers.length, 3 * frame.nodes);
  return frame;
}
