// Pictures of the body. A processor may have to draw them: then what moves is drawn with fewer triangles, and what rests with all.
"use strict";

const vertex_shader = `
precision highp float;
attribute vec3 position, normal;
uniform mat4 projectionMatrix, modelViewMatrix;
varying vec3 colour;
const vec3 paint = vec3(0.85, 0.61, 0.55), light = vec3(0.28, 0.466, 0.839), half_way = vec3(0.146, 0.243, 0.959);
void main() {
  vec4 place = modelViewMatrix * vec4(position, 1.0);
  vec3 n = normalize((modelViewMatrix * vec4(normal, 0.0)).xyz);
  if (both_sides && dot(n, place.xyz) > 0.0) n = -n;
  float above = 0.5 + 0.5 * n.y;
  vec3 sky = mix(vec3(0.24, 0.24, 0.27), vec3(0.5), above);
  float shine = pow(max(dot(n, half_way), 0.0), 25.0);
  colour = paint * (sky + 0.66 * max(dot(n, light), 0.0)) + 0.1 * shine;
  gl_Position = projectionMatrix * place;
}`;
const fragment_shader = `
precision mediump float;
varying vec3 colour;
void main() { gl_FragColor = vec4(colour, 1.0); }`;

function is_drawn_by_processor() {
  const gl = document.createElement("canvas").getContext("webgl");
  const names = gl?.getExtension("WEBGL_debug_renderer_info");
  return !names || /swiftshader|llvmpipe|software/i.test(gl.getParameter(names.UNMASKED_RENDERER_WEBGL));
}

class View {
  constructor(fine, coarse, tools) {
    const antialias = (window.devicePixelRatio || 1) < 2 && !is_drawn_by_processor();
    this.renderer = new THREE.WebGLRenderer({canvas, antialias, alpha: false});
    this.drawn = this.fine = fine;
    this.coarse = coarse || fine;
    this.resolution = 1;  // pixels of the picture, as a part of the screen's
    this.drawn_ms = 0;    // time that a picture takes, a running mean
    this.is_full = true;  // the picture is of all triangles and pixels
    this.is_turned = true;
    this.part = {x: 0, y: 0, width: 0, height: 0}; // area of the stage that the picture covers, CSS pixels
    this.changed_at = performance.now();
    this.shown = new Float32Array(3 * fine.n_nodes);
    this.pixel = new Uint8Array(4);
    this.scene = new THREE.Scene();
    this.spring = new THREE.Line(new THREE.BufferGeometry().setAttribute(
                                     "position", new THREE.BufferAttribute(new Float32Array(6), 3)),
                                 new THREE.LineBasicMaterial());
    this.spring.frustumCulled = this.spring.visible = false;
    this.handle = new THREE.Mesh(new THREE.SphereBufferGeometry(1, 16, 12),
                                 new THREE.MeshBasicMaterial());
    this.handle.visible = false;
    this.camera = new THREE.PerspectiveCamera(35, 1, 1, 1000);
    this.camera.up.set(0, 0, 1);
    this.scene.add(this.fine.mesh, this.spring, this.handle, this.camera);
    if (coarse) this.scene.add(this.coarse.mesh);
    const ball = new THREE.Box3().setFromArray(fine.positions).getBoundingSphere(new THREE.Sphere());
    this.size = ball.radius || 1;
    this.handle.scale.setScalar(0.015 * this.size);
    this.tools = tools.map((tool) => tool_mesh(tool, this.size));
    if (tools.length > 0) {
      this.scene.add(...this.tools, new THREE.AmbientLight(0xffffff, 0.6));
      this.camera.add(new THREE.DirectionalLight(0xffffff, 0.6));
    }
    this.camera.position.copy(ball.center)
        .addScaledVector(new THREE.Vector3(0.5, -0.9, 0.45).normalize(), 4.2 * this.size);
    Object.assign(this.camera, {near: 0.01 * this.size, far: 100 * this.size});
    this.controls = new THREE.OrbitControls(this.camera, stage);
    this.controls.target.copy(ball.center);
    this.controls.update();
    this.controls.addEventListener("change", () => { this.is_turned = true; });
    const take_paper = () => {
      this.renderer.setClearColor(new THREE.Color(getComputedStyle(document.body).backgroundColor));
      const accent = getComputedStyle(document.documentElement).getPropertyValue("--accent").trim();
      for (const drawn of [this.spring, this.handle]) drawn.material.color.set(accent);
      this.is_turned = true;
    };
    take_paper();
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", take_paper);
    this.draw(this.fine); // and the shaders are compiled
    this.fine_ms = this.draw(this.fine);
  }
  // Draws a frame if it does not look as the picture does.
  // @return whether it was drawn
  show(frame) {
    const now = performance.now(), displacement = frame.displacement;
    const are_placed = [this.place_pull(frame), this.place_tools(frame)];
    const is_changed = are_placed.includes(true) || this.is_turned || this.has_moved(displacement) ||
        this.drawn_size !== this.size_of_picture();
    if (is_changed) this.changed_at = now;
    const rests = now - this.changed_at > 400;
    if (!is_changed && (this.is_full || !rests)) return false;
    this.is_turned = false;
    this.shown = displacement;
    const is_fast = this.fine_ms < 12;
    if (rests) this.resolution = 1;
    const surface = rests || is_fast ? this.fine : this.coarse;
    const taken = this.draw(surface, displacement);
    this.is_full = surface === this.fine && this.resolution === 1;
    if (surface === this.fine)
      this.fine_ms = rests ? taken : 0.8 * this.fine_ms + 0.2 * taken;
    if (!rests) this.choose_resolution(taken);
    return true;
  }
  has_moved(displacement) { // whether by more than half a pixel
    const far = 2 * this.camera.position.distanceTo(this.controls.target) *
        Math.tan(0.5 * THREE.Math.DEG2RAD * this.camera.fov);
    const least = 0.5 * far / Math.max(1, stage.clientHeight), shown = this.shown;
    for (let i = 0; i < displacement.length; ++i)
      if (Math.abs(displacement[i] - shown[i]) > least) return true;
    return false;
  }
  place_tools(frame) {
    let is_changed = false;
    this.tools.forEach((mesh, i) => {
      const place = new THREE.Vector3().fromArray(frame.tools, 6 * i);
      is_changed = is_changed || !place.equals(mesh.position);
      mesh.position.copy(place);
    });
    return is_changed;
  }
  place_pull(frame) {
    const is_held = frame.held >= 0 && pull.plane !== null;
    let is_changed = this.handle.visible !== is_held;
    this.spring.visible = this.handle.visible = is_held;
    if (!is_held) return is_changed;
    const place = this.fine.place(frame.held, frame.displacement);
    if (!pull.held_from) pull.held_from = place.clone();
    const end = pull.held_from.clone().add(pull.by), ends = this.spring.geometry.attributes.position;
    is_changed = is_changed || !end.equals(this.handle.position);
    ends.setXYZ(0, place.x, place.y, place.z);
    ends.setXYZ(1, end.x, end.y, end.z);
    ends.needsUpdate = true;
    this.handle.position.copy(end);
    return is_changed;
  }
  choose_resolution(taken) {
    this.drawn_ms = this.drawn_ms ? 0.9 * this.drawn_ms + 0.1 * taken : taken;
    if (performance.now() - (this.chosen_at || 0) < 500) return;
    const before = this.resolution;
    if (this.drawn_ms > 20) this.resolution = Math.max(0.5, 0.8 * before);
    if (this.drawn_ms < 12) this.resolution = Math.min(1, before / 0.8);
    if (this.resolution === before) return;
    this.chosen_at = performance.now();
    this.drawn_ms = 0;
  }
  size_of_picture() {
    const {x, y, width, height} = this.part;
    return [stage.clientWidth, stage.clientHeight, x, y, width, height, this.resolution].join();
  }
  // The part of the stage that the picture must cover. A processor also lays the picture onto the page, all of it for
  // every change: so it is no larger than the body, with some room.
  choose_part(surface) {
    const width = stage.clientWidth, height = stage.clientHeight, whole = {x: 0, y: 0, width, height};
    this.camera.aspect = width / Math.max(1, height);
    this.camera.clearViewOffset(); // and the projection is that of the whole stage
    this.camera.updateMatrixWorld();
    const to_clip = new THREE.Matrix4().multiplyMatrices(this.camera.projectionMatrix, this.camera.matrixWorldInverse);
    const m = to_clip.elements, lower = [Infinity, Infinity], upper = [-Infinity, -Infinity];
    let is_behind = false;
    const hold = (points) => {
      for (let i = 0; i < points.length; i += 3) {
        const x = points[i], y = points[i + 1], z = points[i + 2], w = m[3] * x + m[7] * y + m[11] * z + m[15];
        if (w < this.camera.near) is_behind = true;
        const right = 0.5 * width * (1 + (m[0] * x + m[4] * y + m[8] * z + m[12]) / w);
        const down = 0.5 * height * (1 - (m[1] * x + m[5] * y + m[9] * z + m[13]) / w);
        if (right < lower[0]) lower[0] = right;
        if (right > upper[0]) upper[0] = right;
        if (down < lower[1]) lower[1] = down;
        if (down > upper[1]) upper[1] = down;
      }
    };
    hold(surface.positions);
    if (this.tools.length > 0) is_behind = true; // they may be anywhere: the whole stage
    if (this.spring.visible) hold(this.spring.geometry.attributes.position.array);
    const with_room = (part) => { // widens by 8 pixels and a part of the body's size
      const room = 8 + part * Math.max(upper[0] - lower[0], upper[1] - lower[1]);
      const x = Math.max(0, Math.floor(lower[0] - room)), y = Math.max(0, Math.floor(lower[1] - room));
      return {x, y, width: Math.min(width, Math.ceil(upper[0] + room)) - x, height: Math.min(height, Math.ceil(upper[1] + room)) - y};
    };
    const least = with_room(0.03), best = is_behind ? whole : with_room(0.15), now = this.part;
    const is_enough = !is_behind && now.x <= least.x && now.y <= least.y && now.x + now.width >= least.x + least.width &&
        now.y + now.height >= least.y + least.height && now.width <= width && now.height <= height;
    if (is_enough && now.width * now.height < 2 * best.width * best.height) return;
    this.part = best.width > 0 && best.height > 0 ? best : {x: 0, y: 0, width: 1, height: 1}; // out of sight
  }
  // @return what it took, in milliseconds, until all was drawn: a pixel is read
  draw(surface, displacement) {
    const begin = performance.now(), gl = this.renderer.getContext();
    if (displacement) surface.move(displacement);
    this.fine.mesh.visible = this.coarse.mesh.visible = false;
    surface.mesh.visible = true;
    this.drawn = surface;
    this.choose_part(surface);
    const {x, y, width, height} = this.part, size = this.size_of_picture();
    if (size !== this.drawn_size) { // it clears the picture
      this.renderer.setPixelRatio((window.devicePixelRatio || 1) * this.resolution);
      this.renderer.setSize(width, height, false);
      Object.assign(canvas.style, {left: `${x}px`, top: `${y}px`, width: `${width}px`, height: `${height}px`});
      this.drawn_size = size;
    }
    this.camera.setViewOffset(stage.clientWidth, stage.clientHeight, x, y, width, height);
    this.renderer.render(this.scene, this.camera);
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, this.pixel);
    return performance.now() - begin;
  }
  ray(event) {
    const box = canvas.getBoundingClientRect(), caster = new THREE.Raycaster();
    caster.setFromCamera(new THREE.Vector2(2 * (event.clientX - box.left) / box.width - 1,
                                           1 - 2 * (event.clientY - box.top) / box.height),
                         this.camera);
    return caster;
  }
}
