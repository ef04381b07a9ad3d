// The surface that a case names, as a skin to turn: at rest, as each model has moved it, and the distance between the two.
"use strict";
const skin_record = report.skin;
const skin_colour = 0xd9b9a0;

// The surface at displacements (mm; null: at rest), shaded by its own normals.
function skin_geometry(rest, displacement, triangles) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(rest.map((x, i) => x + (displacement ? displacement[i] : 0))), 3));
  geometry.setIndex(triangles);
  geometry.computeVertexNormals();
  return geometry;
}

// mm, one per vertex; null without both models.
function skin_distances({ fem, springs }) {
  if (!fem || !springs) return null;
  const distances = new Array(fem.length / 3);
  for (let i = 0; i < distances.length; ++i)
    distances[i] = Math.hypot(springs[3 * i] - fem[3 * i], springs[3 * i + 1] - fem[3 * i + 1], springs[3 * i + 2] - fem[3 * i + 2]);
  return distances;
}

// Place that the landmarks are seen from, a little above and aside; without landmarks that of the bodies.
function skin_eye(centre) {
  const eye = new THREE.Vector3();
  for (const { point } of skin_record.marks) eye.add(new THREE.Vector3(...point).sub(centre).normalize());
  if (eye.length() < 1e-3) return new THREE.Vector3(...seen_from);
  eye.normalize();
  eye.z = Math.max(eye.z, 0) + 0.1;
  return eye.applyAxisAngle(new THREE.Vector3(0, 0, 1), 0.45).normalize();
}

class SkinPicture extends TurnedPicture {
  constructor(canvas, geometry, material, marks, all) {
    super(canvas, all);
    const mesh = new THREE.Mesh(geometry, material);
    mesh.frustumCulled = false;
    this.light = new THREE.DirectionalLight(0xffffff, 0.75);
    this.scene.add(mesh, this.light, this.light.target, new THREE.AmbientLight(0xffffff, 0.45));
    for (const { point } of marks) {
      const mark = new THREE.Mesh(all.mark, all.mark_material);
      mark.position.set(...point);
      this.scene.add(mark);
    }
    this.frame(all.sphere);
  }
  // Light comes from the viewer's upper left, whichever way the skin is turned.
  light_up() {
    const { eye, sphere } = this.group, side = new THREE.Vector3(0, 0, 1).cross(eye).normalize();
    this.light.target.position.copy(sphere.center);
    this.light.target.updateMatrixWorld();
    this.light.position.copy(sphere.center).add(eye).addScaledVector(side, -0.6).add(new THREE.Vector3(0, 0, 0.6));
  }
}

function skin() {
  if (!skin_record) return null;
  const lengths = (side) => side && side.displacement.map((u) => u * side.unit_mm);
  const sides = { fem: lengths(skin_record.fem), springs: lengths(skin_record.springs) };
  const distances = skin_distances(sides), largest = distances ? largest_of(distances) : 0;
  const figure = (name, title, ...more) => make("figure", { class: "view", id: "skin-" + name }, make("canvas", { role: "img", tabindex: 0,
    "aria-label": `The skin, ${title}. The arrow keys turn it.` }), make("figcaption", null, make("b", null, title)), more);
  const shown_figures = [["rest", figure("rest", "before")], sides.fem && ["fem", figure("fem", "after, finite elements")],
    sides.springs && ["springs", figure("springs", "after, springs")],
    distances && ["distance", figure("distance", "distance of both models", error_legend(`${general(largest, 2)} mm`))]]
    .filter((one) => one);
  const section = make("div", null, make("p", null, "Drag a skin, or use the arrow keys: all turn with it.",
    skin_record.marks.length > 0 && " Balls are the landmarks."),
  make("div", { class: "views" }, shown_figures.map(([, one]) => one)));
  section.draw = () => {
    if (!can_draw(section, "the skin to turn.")) return;
    const rest = skin_record.rest.map((x) => x * skin_record.unit_mm), triangles = skin_record.triangles;
    const sphere = new THREE.Box3().setFromArray(rest).getBoundingSphere(new THREE.Sphere());
    const all = { sphere, pictures: [], eye: skin_eye(sphere.center),
      mark: new THREE.SphereGeometry(0.012 * sphere.radius, 16, 12), mark_material: new THREE.MeshBasicMaterial({ color: body_colours.fem }) };
    const plain = new THREE.MeshLambertMaterial({ color: skin_colour, side: THREE.DoubleSide });
    for (const [name, one] of shown_figures) {
      const geometry = skin_geometry(rest, name === "rest" ? null : sides[name === "distance" ? "springs" : name], triangles);
      if (name === "distance") geometry.setAttribute("color", colours_of(distances));
      all.pictures.push(new SkinPicture(one.querySelector("canvas"), geometry, name === "distance"
        ? new THREE.MeshLambertMaterial({ vertexColors: THREE.VertexColors, side: THREE.DoubleSide, emissive: 0x111111 }) : plain,
      name === "rest" ? skin_record.marks : [], all));
    }
    all.pictures.forEach((picture) => picture.draw());
    draw_with_page(all.pictures);
  };
  return section;
}

function landmarks() {
  const found = one_case && one_case.landmarks;
  if (!found) return null;
  const length = (value) => cell(general(value, 3));
  const both = found.some((one) => one.to_equilibrium); // springs that stopped after a number of iterations
  const own = (one) => both ? [length(one.to_equilibrium?.mean), length(one.to_equilibrium?.deviation)] : [];
  return [table("landmark-table", "Springs' surface to the finite elements', mm", row([text_head("landmark"), head("mean"), head("deviation"),
    head("rays"), head("moved by (finite elements)"), ...(both ? [head("to the springs' equilibrium"), head("deviation")] : [])]),
  body(found.map((one) => row([row_head([in_words(one.name), reason_of(one.reason)]),
    length(one.mean), length(one.deviation), cell(String(one.n_rays)), length(one.moved), ...own(one)])))),
  quiet("Along the normals of the five triangles nearest to each landmark, from their barycentres.")];
}
