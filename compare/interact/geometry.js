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
  }
  place(vertex) { return new THREE.Vector3().fromArray(this.positions, 3 * vertex); }
}

const frame_numbers = [
  "time", "steps", "median_ms", "p99_ms", "steps_per_second", "inverted", "held", "force", "failures", "nodes"
];

function read_frame(buffer) {
  const numbers = new Float64Array(buffer, 0, frame_numbers.length), frame = {};
  frame_numbers.forEach((name, i) => { frame[name] = numbers[i]; });
  frame.displacement = new Float32Array(buffer, 8 * frame_numbers.length, 3 * frame.nodes);
  return frame;
}
