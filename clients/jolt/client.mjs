// Jolt's soft bodies as a client of springproof: see README.md beside this file.
import { parseArgs } from "node:util";
import init from "jolt-physics/wasm-compat";
import { answer, factor, heldNodes, readScene, say } from "../protocol.mjs";

const { values: options } = parseArgs({
  options: { damping: { type: "string", default: "0.1" }, order: { type: "string", default: "jolt" } },
});
if (!["jolt", "colours"].includes(options.order)) throw new Error('--order is "jolt" or "colours"');
const J = await init();
const scene = readScene();
const { header, arrays } = scene;
const iterations = header.iterations ?? 5;
const held = heldNodes(arrays);

const unsupported = [];
const ignored = (is, what) => is && unsupported.push(what);
ignored(held.partly > 0, `supports of single components (${held.partly} nodes)`);
ignored(arrays.midlines.rows > 0, "midlines");
ignored(arrays.biquadratic_tetrahedra.rows > 0, "biquadratic tetrahedra");
const hasSpring = (column, is) => arrays.springs.values.some((x, i) => i % 6 === column && is(x));
ignored(hasSpring(4, (law) => law !== 0), "the power-log law: springs are Hooke's");
ignored(hasSpring(2, (k) => k <= 0), "springs of stiffness 0 or less");
ignored(arrays.volume_hexahedra.rows > 0,
        "volume of whole hexahedra: the two inscribed tetrahedra of each keep theirs");
ignored(arrays.volume_hexahedra.values.some((x, i) => i % 11 === 10 && x === 1),
        "logarithmic volume terms: a constraint is linear in its volume");
ignored(arrays.volume_patches.rows > 0, "volume of the tetrahedra around nodes");
ignored(header.stiffness_damping > 0, "stiffness_damping");
const isDamped = (c, i) => Math.abs(c - Number(options.damping) * arrays.mass.at(i, 0)) <= 1e-9 * c;
ignored(header.question === "motion" && !arrays.mass_damping.values.every(isDamped),
        "mass_damping: it has its linear damping in place");
ignored(header.question === "motion" && arrays.support_motion.rows > 0, "motion of supports");
ignored(header.loads.length > 0, "loads on nodes within a step: they act at its beginning alone");
ignored(header.question === "motion", `scheme ${header.scheme?.name}`);

// A world without collisions.
const settings = new J.JoltSettings();
const pairs = new J.ObjectLayerPairFilterTable(2);
const layers = new J.BroadPhaseLayerInterfaceTable(2, 1);
layers.MapObjectToBroadPhaseLayer(0, new J.BroadPhaseLayer(0));
layers.MapObjectToBroadPhaseLayer(1, new J.BroadPhaseLayer(0));
settings.mObjectLayerPairFilter = pairs;
settings.mBroadPhaseLayerInterface = layers;
settings.mObjectVsBroadPhaseLayerFilter = new J.ObjectVsBroadPhaseLayerFilterTable(layers, 1, pairs, 2);
const jolt = new J.JoltInterface(settings), system = jolt.GetPhysicsSystem();

const shared = new J.SoftBodySharedSettings();
const vertex = new J.SoftBodySharedSettingsVertex();
const n = arrays.nodes.rows;
for (let i = 0; i < n; ++i) {
  const mass = arrays.mass.at(i, 0);
  vertex.mPosition = new J.Float3(arrays.nodes.at(i, 0), arrays.nodes.at(i, 1), arrays.nodes.at(i, 2));
  vertex.mInvMass = held.whole.has(i) ? 0 : 1 / (mass > 0 ? mass : 1e-3);
  shared.mVertices.push_back(vertex);
}
ignored(!arrays.mass.values.some((m) => m > 0), "no masses: every node has 1 g");
const springs = arrays.springs;
/// The springs' numbers in the order of springproof's "xpbd": each gets the first colour, in which no other one
/// has its nodes.
function inColours() {
  const colours = [], taken = Array.from({ length: n }, () => new Set());
  for (let s = 0; s < springs.rows; ++s) {
    const [at, other] = [0, 1].map((end) => taken[springs.at(s, end)]);
    let first = 0;
    while (at.has(first) || other.has(first)) ++first;
    at.add(first);
    other.add(first);
    (colours[first] ??= []).push(s);
  }
  return colours.flat();
}
const order = options.order === "colours" ? inColours() : [...Array(springs.rows).keys()];
const edges = [];
for (const s of order) {
  const a = springs.at(s, 0), b = springs.at(s, 1), k = springs.at(s, 2);
  if (k <= 0 || (held.whole.has(a) && held.whole.has(b))) continue;
  const edge = new J.SoftBodySharedSettingsEdge(a, b, 1 / k);
  edge.mRestLength = springs.at(s, 3);
  shared.mEdgeConstraints.push_back(edge);
  edges.push(edge);
}
// Energy k_v/2 V0 (V/V0 - 1)^2. A parallelepiped's relative change of volume is to first order the mean of
// its two inscribed tetrahedra's, so that each has half of the energy at its own change.
const inscribed = [[0, 5, 3, 6], [1, 2, 4, 7]];
const sixVolumes = (nodes) => {
  const at = nodes.map((i) => [0, 1, 2].map((c) => arrays.nodes.at(i, c)));
  const [u, v, w] = [1, 2, 3].map((i) => at[i].map((x, c) => x - at[0][c]));
  const cross = [v[1] * w[2] - v[2] * w[1], v[2] * w[0] - v[0] * w[2], v[0] * w[1] - v[1] * w[0]];
  return Math.abs(u[0] * cross[0] + u[1] * cross[1] + u[2] * cross[2]);
};
const hexahedra = arrays.volume_hexahedra;
for (let c = 0; c < hexahedra.rows; ++c)
  for (const corners of inscribed) {
    const nodes = corners.map((v) => hexahedra.at(c, v)), stiffness = hexahedra.at(c, 8) / 2;
    if (stiffness <= 0 || nodes.every((node) => held.whole.has(node))) continue;
    const six = sixVolumes(nodes), share = six / (6 * hexahedra.at(c, 9)); // a third of a parallelepiped
    const compliance = (36 * share ** 2 * hexahedra.at(c, 9)) / stiffness; // for a constraint of 6 V
    const volume = new J.SoftBodySharedSettingsVolume(...nodes, compliance);
    volume.mSixRestVolume = six;
    shared.mVolumeConstraints.push_back(volume);
  }
shared.AddFace(new J.SoftBodySharedSettingsFace(0, 1, 2, 0));
shared.Optimize();
// One thread goes through all edges in the order of the array, where the optimiser has put them into its own.
if (options.order === "colours")
  edges.forEach((edge, place) => {
    const to = shared.mEdgeConstraints.at(place);
    for (const end of [0, 1]) to.set_mVertex(end, edge.get_mVertex(end));
    to.mRestLength = edge.mRestLength;
    to.mCompliance = edge.mCompliance;
  });

const creation = new J.SoftBodyCreationSettings(shared, new J.RVec3(0, 0, 0), new J.Quat(0, 0, 0, 1), 1);
creation.mNumIterations = iterations;
creation.mLinearDamping = Number(options.damping);
creation.mAllowSleeping = false;
creation.mUpdatePosition = false;
creation.mMaxLinearVelocity = 500;
const bodies = system.GetBodyInterface(), body = bodies.CreateSoftBody(creation);
bodies.AddBody(body.GetID(), J.EActivation_Activate);
const motion = J.castObject(body.GetMotionProperties(), J.SoftBodyMotionProperties);
const vertices = motion.GetVertices();

if (header.question === "rest" && arrays.support_motion.rows > 0)
  for (let i = 0; i < arrays.supports.rows; ++i) {
    const node = arrays.supports.at(i, 0), c = arrays.supports.at(i, 1);
    if (!held.whole.has(node)) continue;
    const place = arrays.nodes.at(node, c) + arrays.support_motion.at(0, i);
    vertices.at(node).mPosition[["SetX", "SetY", "SetZ"][c]](place);
  }

say({ protocol: 1, name: "Jolt", version: "jolt-physics 1.1.0", method: "XPBD, edges of compliance 1/k",
      settings: { iterations, linear_damping: Number(options.damping), order: options.order,
                  step: header.step }, unsupported });

const ownGravity = new J.Vec3(0, 0, 0);
/// Gravity is Jolt's own, which acts in each substep of a step. It has no forces on single vertices: loads
/// change their velocities once, before a step.
function push(dt, t) {
  const at = header.question === "motion" ? t : Infinity;
  const share = (history) => (at === Infinity ? 1 : factor(history, at));
  const add = (node, x, y, z) => {
    const v = vertices.at(node).mVelocity;
    v.Set(v.GetX() + x, v.GetY() + y, v.GetZ() + z);
  };
  const gravity = [0, 0, 0];
  for (const { acceleration, history } of header.gravity) {
    acceleration.forEach((g, c) => (gravity[c] += share(history) * g));
  }
  ownGravity.Set(...gravity);
  system.SetGravity(ownGravity);
  for (const { forces, history } of header.loads)
    for (let row = 0; row < arrays[forces].rows; ++row) {
      const node = arrays[forces].at(row, 0), mass = arrays.mass.at(node, 0) || 1e-3;
      if (!held.whole.has(node))
        add(node, ...[1, 2, 3].map((c) => (share(history) * arrays[forces].at(row, c) * dt) / mass));
    }
}

answer(scene, (dt, t) => {
  push(dt, t);
  jolt.Step(dt, 1);
}, () => {
  const all = new Float64Array(3 * n);
  for (let i = 0; i < n; ++i) {
    const p = vertices.at(i).mPosition;
    all.set([p.GetX(), p.GetY(), p.GetZ()], 3 * i);
  }
  return all;
});
