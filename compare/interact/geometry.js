// The surfaces of a body as the server describes them (see DrawnSurface and Simulation::frame()), with what is drawn of them. Light is
// computed at the vertices: a pixel costs a processor little then.
"use strict";

class Surface {
  constructor(buffer, begin) {
    const [n_vertices, n_triangles, n_nodes, n_spheres] = new Uint32Array(buffer, begin, 4);
    let at = begin + 16;
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
    this.end = at;
    this.positions = Float32Array.from(this.rest);
    this.normals = new Float32Array(3 * n_vertices);
    this.turn();
    this.geometry = new THREE.BufferGeometry();
    for (const [name, values] of [["position", this.positions], ["normal", this.normals]])
      this.geometry.setAttribute(name, new THREE.BufferAttribute(values, 3).setUsage(THREE.DynamicDrawUsage));
    const is_small = n_vertices < 65536;
    this.geometry.setIndex(new THREE.BufferAttribute(is_small ? Uint16Array.from(this.triangles) : this.triangles, 1));
    const is_closed = this.is_closed();
    this.mesh = new THREE.Mesh(this.geometry, new THREE.RawShaderMaterial({
                                 vertexShader: `const bool both_sides = ${!is_closed};\n` + vertex_shader,
                                 fragmentShader: fragment_shader,
                                 side: is_closed ? THREE.FrontSide : THREE.DoubleSide
                               }));
    this.mesh.frustumCulled = false; // its vertices move under the sphere that would be asked
  }
  // Positions of the vertices for the nodes' displacement.
  move(displacement) {
    for (let v = 0; v < this.positions.length / 3; ++v) this.move_vertex(v, displacement);
    this.turn();
    for (const name of ["position", "normal"]) this.geometry.attributes[name].needsUpdate = true;
    this.geometry.boundingSphere = null;
  }
  move_vertex(vertex, displacement) {
    const {rest, weights, nodes, positions} = this, v = 3 * vertex;
    let x = rest[v], y = rest[v + 1], z = rest[v + 2];
    for (let w = 8 * vertex, end = w + 8; w < end; ++w) {
      const weight = weights[w], node = 3 * nodes[w];
      x += weight * displacement[node];
      y += weight * displacement[node + 1];
      z += weight * displacement[node + 2];
    }
    positions[v] = x;
    positions[v + 1] = y;
    positions[v + 2] = z;
  }
  // Normals of the vertices, weighted by areas; of any length, which the shader makes 1.
  turn() {
    const {positions, normals, triangles} = this;
    normals.fill(0);
    for (let t = 0; t < triangles.length; t += 3) {
      const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
      const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1],
            uz = positions[b + 2] - positions[a + 2];
      const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1],
            vz = positions[c + 2] - positions[a + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      normals[a] += x;
      normals[a + 1] += y;
      normals[a + 2] += z;
      normals[b] += x;
      normals[b + 1] += y;
      normals[b + 2] += z;
      normals[c] += x;
      normals[c + 1] += y;
      normals[c + 2] += z;
    }
  }
  // Whether every edge has two triangles, which go along it in opposite directions: then it hides its inner side. A set of
  // a larger surface's edges would be too large.
  is_closed() {
    if (this.triangles.length > 3e6) return false;
    const n = this.rest.length / 3, open = new Set();
    for (let i = 0; i < this.triangles.length; ++i) {
      const from = this.triangles[i], to = this.triangles[i % 3 === 2 ? i - 2 : i + 1];
      if (!open.delete(to * n + from)) open.add(from * n + to);
    }
    return open.size === 0;
  }
  place(vertex, displacement) {
    this.move_vertex(vertex, displacement);
    return new THREE.Vector3().fromArray(this.positions, 3 * vertex);
  }
}

// A tool of the server's description, as long as it needs to be beside a body of a size.
function tool_mesh(tool, size) {
  const long = 6 * size, axis = new THREE.Vector3(...(tool.axis || [0, 0, 1]));
  const material = new THREE.MeshLambertMaterial({color: 0x8899aa, transparent: true, opacity: 0.6, side: THREE.DoubleSide});
  let geometry = null;
  if (tool.shape === "sphere") geometry = new THREE.SphereBufferGeometry(tool.radius, 48, 32);
  if (tool.shape === "plane") geometry = new THREE.PlaneBufferGeometry(long, long); // across z
  if (tool.shape === "cylinder" || tool.shape === "punch") { // along y
    geometry = new THREE.CylinderBufferGeometry(tool.radius, tool.radius, long, 48);
    geometry.rotateX(Math.PI / 2);
    if (tool.shape === "punch") geometry.translate(0, 0, -long / 2); // it ends in its flat end
  }
  if (tool.shape === "surface") {
    geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(tool.vertices, 3));
    geometry.setIndex(tool.triangles);
    geometry = geometry.toNonIndexed(); // facets have normals of their own
    geometry.computeVertexNormals();
  }
  const mesh = new THREE.Mesh(geometry, material);
  mesh.quaternion.setFromUnitVectors(new THREE.Vector3(0, 0, 1), axis);
  return mesh;
}

const frame_numbers = [
  "time", "steps", "median_ms", "p99_ms", "steps_per_second", "inverted", "held", "force", "failures", "drags",
  "residual", "nodes"
];

function read_frame(buffer) {
  const numbers = new Float64Array(buffer, 0, frame_numbers.length), frame = {};
  frame_numbers.forEach((name, i) => { frame[name] = numbers[i]; });
  frame.displacement = new Float32Array(buffer, 8 * frame_numbers.length, 3 * frame.nodes);
  frame.tools = new Float32Array(buffer, 8 * frame_numbers.length + 12 * frame.nodes); // each one's place and force
  return frame;
}
