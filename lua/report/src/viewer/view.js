// SPDX-FileCopyrightText: the aib authors
// SPDX-License-Identifier: MIT

/// One canvas with one camera over one or two panes: what is turned in one is turned in the other.
import { PerspectiveCamera, Raycaster, Scene, Spherical, Vector2, Vector3, WebGLRenderer } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { themed } from "../dom.js";

const pickRadius = 9;

export class View {
  /// `canvas` is drawn anew when something changes, not before.
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.autoClear = false;
    this.camera = new PerspectiveCamera(45, 1, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.redraw());
    this.panes = [];
    new ResizeObserver(() => this.redraw()).observe(canvas);
    canvas.addEventListener("keydown", (event) => this.key(event));
  }

  /// Each pane is { layers }.
  setPanes(panes) {
    this.panes = panes.map(({ layers }) => {
      const scene = new Scene();
      for (const layer of layers) scene.add(layer.object);
      return { scene, layers };
    });
    this.redraw();
  }

  /// Looks at a box from a direction.
  look(low, high, direction = [-0.7, -1, 0.55]) {
    const centre = low.clone().add(high).multiplyScalar(0.5);
    const radius = Math.max(high.distanceTo(low) / 2, 1e-6);
    const { width, height } = this.paneSize();
    const half = Math.atan(Math.tan((this.camera.fov * Math.PI) / 360) * Math.min(1, width / height));
    this.camera.position.copy(centre).addScaledVector(new Vector3(...direction).normalize(), (0.8 * radius) / Math.sin(half));
    this.camera.near = radius / 500;
    this.camera.far = radius * 50;
    this.controls.target.copy(centre);
    this.controls.update();
    this.redraw();
  }

  key(event) {
    const turns = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const zooms = { "+": 0.85, "=": 0.85, "-": 1 / 0.85 };
    const turn = turns[event.key];
    const zoom = zooms[event.key];
    if (!turn && !zoom) return;
    event.preventDefault();
    const offset = this.camera.position.clone().sub(this.controls.target);
    // Spherical counts from the y axis, the camera from z.
    const place = new Spherical().setFromCartesianCoords(offset.x, offset.z, -offset.y);
    place.theta += 0.12 * (turn?.[0] ?? 0);
    place.phi = Math.min(3.1, Math.max(0.05, place.phi + 0.12 * (turn?.[1] ?? 0)));
    place.radius *= zoom ?? 1;
    const moved = new Vector3().setFromSpherical(place);
    this.camera.position.copy(this.controls.target).add(new Vector3(moved.x, -moved.z, moved.y));
    this.controls.update();
    this.redraw();
  }

  paneSize() {
    const n = Math.max(1, this.panes.length);
    return { width: this.canvas.clientWidth / n, height: this.canvas.clientHeight };
  }

  redraw() {
    if (this.isDue) return;
    this.isDue = true;
    requestAnimationFrame(() => {
      this.isDue = false;
      this.draw();
    });
  }

  draw() {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || this.panes.length === 0) return;
    const size = this.renderer.getSize(new Vector2());
    if (size.x !== clientWidth || size.y !== clientHeight) this.renderer.setSize(clientWidth, clientHeight, false);
    const { width, height } = this.paneSize();
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setClearColor(themed("--canvas"));
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    this.renderer.setScissorTest(true);
    this.panes.forEach(({ scene, layers }, i) => {
      for (const layer of layers) layer.object.visible = layer.isOn;
      this.renderer.setViewport(i * width, 0, width, height);
      this.renderer.setScissor(i * width, 0, width - (i < this.panes.length - 1 ? 2 : 0), height);
      this.renderer.render(scene, this.camera);
    });
  }

  /// What lies under a pixel of the canvas: { layer, index, pane }; nothing where nothing does. Cameras come before
  /// points, points before faces.
  pick(x, y) {
    const { width, height } = this.paneSize();
    const pane = Math.min(this.panes.length - 1, Math.floor(x / width));
    const at = { x: x - pane * width, y, width, height };
    const layers = this.panes[pane].layers.filter((layer) => layer.isOn);
    for (const kind of ["cameras", "points", "faces"]) {
      const hits = layers.filter((layer) => layer.picks === kind).map((layer) => this.hit(layer, at)).filter(Boolean);
      const nearest = hits.sort((a, b) => a.depth - b.depth)[0];
      if (nearest) return { ...nearest, pane };
    }
    return null;
  }

  hit(layer, at) {
    if (layer.picks === "faces") return this.hitFace(layer, at);
    const n = layer.cameras?.length ?? layer.object.geometry.getAttribute("position").count;
    const attribute = layer.cameras ? null : layer.object.geometry.getAttribute("position");
    const matrix = this.camera.projectionMatrix.clone().multiply(this.camera.matrixWorldInverse);
    if (attribute) matrix.multiply(layer.object.matrixWorld);
    const p = new Vector3();
    let best = null;
    for (let i = 0; i < n; ++i) {
      if (attribute) p.fromBufferAttribute(attribute, i);
      else p.set(...layer.cameras[i].at);
      p.applyMatrix4(matrix);
      if (p.z < -1 || p.z > 1) continue;
      const distance = Math.hypot((p.x * 0.5 + 0.5) * at.width - at.x, (0.5 - p.y * 0.5) * at.height - at.y);
      if (distance < pickRadius && (!best || p.z < best.depth)) best = { layer, index: i, depth: p.z };
    }
    return best;
  }

  hitFace(layer, at) {
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2((at.x / at.width) * 2 - 1, 1 - (at.y / at.height) * 2), this.camera);
    const [found] = ray.intersectObject(layer.object);
    return found ? { layer, index: found.faceIndex, depth: found.distance } : null;
  }
}
