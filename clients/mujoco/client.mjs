// MuJoCo's flex as a client of springproof: see README.md beside this file.
import { parseArgs } from "node:util";
import load from "mujoco-js";
import {
  answer, factor, heldNodes, ignoredOnTetrahedra, readScene, refuseMovingSupports, say, sixTetrahedra,
} from "../protocol.mjs";

const { values: options } = parseArgs({
  options: {
    damping: { type: "string", default: "0" }, // the elasticity's, s
    drag: { type: "string", default: "0" }, // the nodes' slides', 1/s
    substeps: { type: "string", default: "1" },
  },
});
const mujoco = await load();
const scene = readScene();
const { header, arrays } = scene;
const { nodes, mass, materials } = arrays;
const held = heldNodes(arrays), n = nodes.rows, substeps = Number(options.substeps);

refuseMovingSupports(scene);
const unsupported = ignoredOnTetrahedra(scene, held);
const ignored = (is, what) => is && unsupported.push(what);
const isFirst = (x, i) => i % 4 > 1 || x === materials.at(0, i % 4);
ignored(!materials.values.every(isFirst), "all materials but the first");
ignored(!mass.values.some((m) => m > 0), "no masses: every node has 1 g");

const cells = [];
if (arrays.tetrahedra) cells.push(...arrays.tetrahedra.values);
for (let c = 0; c < (arrays.hexahedra?.rows ?? 0); ++c)
  for (const cut of sixTetrahedra) cells.push(...cut.map((v) => arrays.hexahedra.at(c, v)));

// Each node that is not pinned is a body of three slides, whose mass is set below.
const description = `<mujoco>
  <option timestep="${header.step / substeps}" gravity="0 0 0" integrator="implicitfast" solver="CG"
    tolerance="1e-8" ${header.iterations ? `iterations="${header.iterations}"` : ""}>
    <flag autoreset="disable"/></option>
  <size memory="500M"/>
  <worldbody><flexcomp name="body" type="direct" dim="3" mass="1" radius="1e-6"
    point="${[...nodes.values].join(" ")}"
    element="${cells.join(" ")}"><edge equality="false"/>
    <elasticity young="${materials.at(0, 0)}" poisson="${materials.at(0, 1)}"
      damping="${Number(options.damping)}"/>
    <contact contype="0" conaffinity="0" selfcollide="none" internal="false"/>
    <pin id="${[...held.whole].join(" ")}"/></flexcomp></worldbody></mujoco>`;
mujoco.FS.writeFile("/body.xml", description); // in its own memory
const model = mujoco.MjModel.loadFromXML("/body.xml");
const data = new mujoco.MjData(model);
const bodyOf = Array.from(model.flex_vertbodyid);
const massOf = (node) => mass.at(node, 0) || 1e-3;
for (let i = 0; i < n; ++i) {
  if (held.whole.has(i)) continue;
  model.body_mass[bodyOf[i]] = massOf(i);
  const slide = model.body_dofadr[bodyOf[i]];
  model.dof_damping.fill(arrays.mass_damping.at(i, 0) + Number(options.drag) * massOf(i), slide, slide + 3);
}
mujoco.mj_setConst(model, data);
mujoco.mj_forward(model, data);

say({ protocol: 1, name: "MuJoCo", version: mujoco.mj_versionString(), method: "flex, St. Venant-Kirchhoff",
      settings: { iterations: model.opt.iterations, damping: Number(options.damping),
                  drag: Number(options.drag), step: header.step, substeps }, unsupported });

/// Loads and gravity as forces on the nodes' bodies.
function push(t) {
  const share = (history) => (header.question === "motion" ? factor(history, t) : 1);
  data.xfrc_applied.fill(0);
  const add = (node, force) => {
    if (!held.whole.has(node)) force.forEach((f, c) => (data.xfrc_applied[6 * bodyOf[node] + c] += f));
  };
  for (const { acceleration, history } of header.gravity)
    for (let i = 0; i < n; ++i) add(i, acceleration.map((g) => share(history) * g * massOf(i)));
  for (const { forces, history } of header.loads)
    for (let row = 0; row < arrays[forces].rows; ++row)
      add(arrays[forces].at(row, 0), [1, 2, 3].map((c) => share(history) * arrays[forces].at(row, c)));
}

answer(scene, (dt, t) => {
  for (let k = 1; k <= substeps; ++k) {
    push(t - dt + (k * dt) / substeps);
    mujoco.mj_step(model, data);
  }
}, () => {
  mujoco.mj_kinematics(model, data);
  mujoco.mj_flex(model, data);
  return Float64Array.from(data.flexvert_xpos);
});
