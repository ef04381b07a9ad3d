// Rapier's soft bodies as a client of springproof: see README.md beside this file.
import { parseArgs } from "node:util";
import R from "@dimforge/rapier3d-compat";
import {
  answer, factor, heldNodes, ignoredOnTetrahedra, readScene, refuseMovingSupports, say, sixTetrahedra,
} from "../protocol.mjs";

const { values: options } = parseArgs({
  options: {
    solver: { type: "string", default: "constraints" }, // or fem
    model: { type: "string", default: "neohooke" }, // volume, corotational or neohooke
    damping: { type: "string", default: "" },
  },
});
const solver = ["constraints", "fem"].indexOf(options.solver);
const model = ["volume", "corotational", "neohooke"].indexOf(options.model);
if (solver < 0 || model < 0)
  throw new Error("--solver constraints|fem, --model volume|corotational|neohooke");
await R.init();
const scene = readScene();
const { header, arrays } = scene;
const held = heldNodes(arrays), n = arrays.nodes.rows, materials = arrays.materials;

refuseMovingSupports(scene);
const unsupported = ignoredOnTetrahedra(scene, held);
const ignored = (is, what) => is && unsupported.push(what);
ignored(header.question === "motion" && arrays.mass_damping.values.some((c) => c > 0), "mass_damping");
const changes = ({ history }) => history.points.length > 0 || history.frequency !== 0;
ignored(header.question === "motion" && header.gravity.some(changes), "histories of gravity");
const isFirst = (x, i) => i % 4 === 3 || x === materials.at(0, i % 4);
const isSame = materials.values.every(isFirst);
ignored(!isSame, "all materials but the first");

const cells = [];
if (arrays.tetrahedra) cells.push(...arrays.tetrahedra.values);
for (let c = 0; c < (arrays.hexahedra?.rows ?? 0); ++c)
  for (const cut of sixTetrahedra) cells.push(...cut.map((v) => arrays.hexahedra.at(c, v)));

const acceleration = [0, 0, 0];
for (const { acceleration: g } of header.gravity) g.forEach((x, c) => (acceleration[c] += x));
const world = new R.World({ x: acceleration[0], y: acceleration[1], z: acceleration[2] });
world.timestep = header.step;
if (header.iterations) world.integrationParameters.numSolverIterations = header.iterations;
const material = new R.SoftBodyMaterial();
material.youngModulus = materials.at(0, 0);
material.poissonRatio = materials.at(0, 1);
if (options.damping) material.elasticDampingRatio = Number(options.damping);
const mass = arrays.mass.values.reduce((sum, m) => sum + m, 0);
const description = new R.SoftBodyDesc(new Float32Array(arrays.nodes.values)).setCells(new Uint32Array(cells))
  .setPinnedParticles(new Uint32Array([...held.whole])).setMaterial(material)
  .setCellModel(model).setSolver(solver)
  .setMass(mass > 0 ? mass : 1).setSelfContacts(false).setCanSleep(false);
try {
  description.setNoSurfaceCollider();
} catch {
  // a version that has no colliders by default
}
const body = world.createSoftBody(description);

say({ protocol: 1, name: "Rapier", version: R.version(), method: `${options.solver}, ${options.model}`,
      settings: { iterations: world.integrationParameters.numSolverIterations,
                  damping: material.elasticDampingRatio, step: header.step }, unsupported });

/// Forces on nodes, which last until they are reset.
function push(t) {
  body.resetForces(false);
  for (const { forces, history } of header.loads) {
    const share = header.question === "motion" ? factor(history, t) : 1, rows = arrays[forces];
    for (let row = 0; row < rows.rows; ++row) {
      const [x, y, z] = [1, 2, 3].map((c) => share * rows.at(row, c));
      body.addParticleForce(rows.at(row, 0), { x, y, z }, true);
    }
  }
}

answer(scene, (dt, t) => {
  if (header.loads.length > 0) push(t);
  world.step();
}, () => Float64Array.from(body.particlePositions()).subarray(0, 3 * n));
