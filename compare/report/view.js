// The report's three-dimensional views: finite elements as a translucent surface with its edges, springs as lines.
// One WebGL renderer draws them all, each into a canvas of its own (browsers allow few WebGL contexts). A view replaces its
// static picture only when it has been drawn, so the picture stays where there is no WebGL.
"use strict";
(function () {
  const data = report.views;
  const colours = { fem: 0x0072b2, springs: 0xd55e00 };

  let shared = null; // the renderer, made when the first view needs it
  function renderer() {
    if (!shared) {
      shared = new THREE.WebGLRenderer({ antialias: true, alpha: true, preserveDrawingBuffer: true });
      shared.setClearColor(0x000000, 0);
    }
    return shared;
  }

  // Each pair of nodes once, in either direction.
  function unique_lines(pairs) {
    const seen = new Set();
    return pairs.filter(([a, b]) => {
      const key = Math.min(a, b) + "," + Math.max(a, b);
      return !seen.has(key) && seen.add(key);
    }).flat();
  }

  function surface_of(body) {
    const triangles = [], edges = [], diagonals = [];
    for (let f = 0; f < body.faces.length; f += 4) {
      const [a, b, c, d] = body.faces.slice(f, f + 4);
      triangles.push(a, b, c, a, c, d);
      edges.push([a, b], [b, c], [c, d], [d, a]);
      diagonals.push([a, c], [b, d]);
    }
    return { triangles, edges: unique_lines(edges), diagonals: unique_lines(diagonals) };
  }

  // Nodes of one side at displacements times a scale, mm.
  class Side {
    constructor(side) {
      const body = data.bodies[side.body];
      this.surface = surface_of(body);
      this.rest = body.rest;
      this.displacement = side.displacement;
      this.positions = new THREE.BufferAttribute(new Float32Array(body.rest.length), 3);
      this.group = new THREE.Group();
    }
    add(index, make, material) {
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", this.positions);
      geometry.setIndex(index);
      const object = new make(geometry, material);
      object.frustumCulled = false; // the positions move under the geometry's bounding sphere
      this.group.add(object);
    }
    move(scale) {
      const to = this.positions.array;
      for (let i = 0; i < to.length; ++i) to[i] = (this.rest[i] + scale * this.displacement[i]) * data.unit_mm;
      this.positions.needsUpdate = true;
    }
  }

  function fem_side(side) {
    const made = new Side(side);
    made.add(made.surface.triangles, THREE.Mesh, new THREE.MeshBasicMaterial({
      color: colours.fem, transparent: true, opacity: 0.16, side: THREE.DoubleSide, depthWrite: false }));
    made.add(made.surface.edges, THREE.LineSegments,
      new THREE.LineBasicMaterial({ color: colours.fem, transparent: true, opacity: 0.75 }));
    return made;
  }

  function springs_side(side) {
    const made = new Side(side);
    made.add(made.surface.edges, THREE.LineSegments, new THREE.LineBasicMaterial({ color: colours.springs }));
    made.add(made.surface.diagonals, THREE.LineSegments,
      new THREE.LineBasicMaterial({ color: colours.springs, transparent: true, opacity: 0.35 }));
    return made;
  }

  class View {
    constructor(record) {
      this.figure = document.getElementById("view-" + record.id);
      this.canvas = this.figure.querySelector("canvas");
      this.sides = {};
      if (record.fem) this.sides.fem = fem_side(record.fem);
      if (record.springs) this.sides.springs = springs_side(record.springs);
      this.scene = new THREE.Scene();
      for (const side of Object.values(this.sides)) this.scene.add(side.group);
      // What lies behind fades into the page: lines alone say nothing of depth.
      this.scene.fog = new THREE.Fog(new THREE.Color(getComputedStyle(document.body).backgroundColor));
      this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, -1000, 1000);
      this.camera.up.set(0, 0, 1);
      this.camera.position.set(0.5, -0.9, 0.4);
      this.controls = new THREE.OrbitControls(this.camera, this.canvas);
      Object.assign(this.controls, { enableZoom: false, enablePan: false, enableKeys: false });
      this.controls.addEventListener("change", () => this.draw());
      this.slider = this.figure.querySelector("input[type=range]");
      this.slider.max = record.largest_scale;
      this.slider.addEventListener("input", () => this.move());
      for (const box of this.figure.querySelectorAll("input[type=checkbox]"))
        box.addEventListener("change", () => this.draw());
      this.move();
      this.figure.classList.add("live");
      this.draw();
    }
    move() {
      const scale = Number(this.slider.value);
      this.figure.querySelector("output").textContent = "× " + scale.toFixed(1);
      for (const side of Object.values(this.sides)) side.move(scale);
      this.frame();
      this.draw();
    }
    // Keeps the deformed body and the body at rest inside the picture, whichever way it is turned.
    frame() {
      const box = new THREE.Box3();
      for (const side of Object.values(this.sides)) {
        box.union(new THREE.Box3().setFromBufferAttribute(side.positions));
        for (let i = 0; i < side.rest.length; i += 3)
          box.expandByPoint(new THREE.Vector3().fromArray(side.rest, i).multiplyScalar(data.unit_mm));
      }
      const sphere = box.getBoundingSphere(new THREE.Sphere());
      const turned = this.camera.position.clone().sub(this.controls.target).normalize();
      this.controls.target.copy(sphere.center);
      this.camera.position.copy(sphere.center).add(turned);
      this.radius = sphere.radius;
      this.scene.fog.near = 1 - 0.2 * sphere.radius; // the camera stands 1 mm before the centre: parallel rays
      this.scene.fog.far = 1 + 1.3 * sphere.radius;
      this.controls.update();
    }
    draw() {
      const width = this.canvas.clientWidth, height = this.canvas.clientHeight;
      if (width === 0 || height === 0) return;
      const density = window.devicePixelRatio || 1;
      this.canvas.width = Math.round(width * density);
      this.canvas.height = Math.round(height * density);
      for (const box of this.figure.querySelectorAll("input[type=checkbox]"))
        if (this.sides[box.name]) this.sides[box.name].group.visible = box.checked;
      const half = this.radius / Math.min(width, height);
      Object.assign(this.camera, { left: -half * width, right: half * width, top: half * height, bottom: -half * height });
      this.camera.updateProjectionMatrix();
      renderer().setSize(this.canvas.width, this.canvas.height, false);
      renderer().render(this.scene, this.camera);
      this.canvas.getContext("2d").drawImage(renderer().domElement, 0, 0);
    }
  }

  const records = new Map(data.views.map((record) => ["view-" + record.id, record]));
  const made = new Map(); // element id -> View
  function show(id) {
    if (!made.has(id)) made.set(id, new View(records.get(id)));
    return made.get(id);
  }
  if (records.size > 0) {
    try {
      renderer();
    } catch (error) {
      return; // no WebGL here: the static pictures stay
    }
    const watcher = new IntersectionObserver((entries) => {
      for (const entry of entries) if (entry.isIntersecting) show(entry.target.id);
    }, { rootMargin: "200px" });
    for (const id of records.keys()) watcher.observe(document.getElementById(id));
    window.addEventListener("resize", () => made.forEach((view) => view.draw()));
  }
  window.springproof_views = { ids: [...records.keys()], show };
})();
