// SPDX-License-Identifier: BSD-3-Clause
// The stage: renderer, light, and the floor with its grid. z is up.

import {
  BufferAttribute, BufferGeometry, Color, DirectionalLight, Group, HemisphereLight,
  LineBasicMaterial, LineSegments, Mesh, PCFShadowMap, PerspectiveCamera, PlaneGeometry, Scene,
  ShadowMaterial, Sphere, Vector3, WebGLRenderer,
} from "./vendor/three.min.js";
import { LEVELS, Quality } from "./quality.js";
import { shadeAtCorners } from "./shading.js";
import { colour, onTheme } from "./theme.js";

// Some browsers say so by refusing a canvas for which a slow one is not good enough, some only by the
// name of what draws.
const SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

function drawsInHardware() {
  const options = { failIfMajorPerformanceCaveat: true };
  const gl = document.createElement("canvas").getContext("webgl2", options);
  if (!gl) return false;
  const names = gl.getExtension("WEBGL_debug_renderer_info");
  const name = gl.getParameter(names ? names.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return !SOFTWARE.test(name);
}

export class Stage {
  rendered = 0;
  first = null;  // when the first picture was drawn, from the navigation on [ms]
  covered = () => 0;  // pixels of its height that lie below buttons
  onResize = () => {};  // hears of the width over the height that the picture had
  sphere = null;  // that holds the scene, and its lowest point [m]
  lowest = 0;
  #dirty = true;
  #eye = new Vector3();

  constructor(canvas) {
    this.canvas = canvas;
    const software = !drawsInHardware();
    if (software) shadeAtCorners();
    this.smooth = !software;
    // Smooth edges are four times the pixels.
    this.renderer = new WebGLRenderer({ canvas, antialias: !software, alpha: true });
    this.renderer.shadowMap.type = PCFShadowMap;
    this.renderer.xr.enabled = true;
    this.scene = new Scene();
    this.rig = new Group();  // the room of a headset; at rest in the scene without one
    this.scene.add(this.rig);
    this.quality = new Quality(() => this.#refine(), software);
    this.camera = new PerspectiveCamera(35, 1, 0.01, 50);
    this.camera.up.set(0, 0, 1);
    this.rig.add(this.camera);
    this.#light();
    this.#floor();
    onTheme(() => this.#paint());
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement);
    this.#resize();
  }

  invalidate() {
    this.#dirty = true;
  }

  get pending() {
    return this.#dirty;
  }

  // Somebody is in it, with a headset.
  get immersive() {
    return this.renderer.xr.isPresenting;
  }

  // From where it is looked at.
  get eye() {
    return this.camera.getWorldPosition(this.#eye);
  }

  // Whether there is something behind the scene: the page or the room of who looks, or else this.
  surround(on) {
    this.scene.background = on ? new Color(colour("sky")) : null;
  }

  // The picture has the page again.
  restore() {
    this.#resize();
    this.#refine();
  }

  // Draws if something changed, and says whether it did. A headset wants every picture.
  render() {
    if (!this.#dirty && !this.immersive) return false;
    this.#dirty = false;
    this.renderer.render(this.scene, this.camera);
    this.rendered += 1;
    this.first ??= performance.now();
    return true;
  }

  setShadows(on) {
    this.shadows = on;
    this.#refine();
  }

  // Lays the floor and its grid under what there is: a sphere that holds it, and its lowest point.
  fit(center, radius, lowest) {
    const around = Math.max(radius, 0.05);
    this.sphere = new Sphere(center.clone(), around);
    this.lowest = lowest;
    this.spacing = 10 ** Math.floor(Math.log10(around / 2.5));
    this.ground.position.set(center.x, center.y, lowest - 0.002);
    this.ground.scale.setScalar(8 * around);
    this.grid.geometry.dispose();
    this.grid.geometry = gridGeometry(center, 1.9 * around, this.spacing);
    this.grid.position.z = lowest - 0.001;
    this.sun.position.set(center.x + around, center.y - 0.9 * around, center.z + 2.6 * around);
    this.sun.target.position.copy(center);
    const box = this.sun.shadow.camera;
    box.left = box.bottom = -1.3 * around;
    box.right = box.top = 1.3 * around;
    box.far = 6 * around;
    box.updateProjectionMatrix();
    this.camera.near = around / 100;
    this.camera.far = around * 60;
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  #light() {
    this.sky = new HemisphereLight(0xffffff, 0x8a8f96, 1.75);
    this.sky.position.set(0, 0, 1);
    this.sun = new DirectionalLight(0xffffff, 1.55);
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.bias = -0.0005;
    this.sun.shadow.normalBias = 0.004;
    this.scene.add(this.sky, this.sun, this.sun.target);
  }

  #floor() {
    this.ground = new Mesh(new PlaneGeometry(1, 1), new ShadowMaterial({ transparent: true }));
    this.ground.receiveShadow = true;
    const lines = new LineBasicMaterial({
      vertexColors: true, transparent: true, depthWrite: false,
    });
    this.grid = new LineSegments(new BufferGeometry(), lines);
    this.scene.add(this.ground, this.grid);
  }

  #paint() {
    this.grid.material.color.set(colour("grid"));
    this.ground.material.opacity = Number(colour("shade"));
    this.sky.groundColor = new Color(colour("ground"));
    this.surround(this.scene.background !== null);
    this.invalidate();
  }

  // Pixels drawn along a pixel of the page. Where edges are not smooth by themselves, and the time
  // does not matter, twice as many make them so.
  #ratio(level) {
    const density = Math.min(devicePixelRatio, 2) * level.pixels;
    return this.smooth || this.quality.adapts ? density : 2 * density;
  }

  // As finely as the quality says, at any density of the screen.
  #refine(level = LEVELS[this.quality.level]) {
    const { shadowMap } = this.renderer;
    if (!this.immersive) this.renderer.setPixelRatio(this.#ratio(level));
    const cast = this.shadows && level.shadow;
    shadowMap.enabled = cast;
    this.sun.castShadow = cast;
    this.ground.visible = cast;
    this.invalidate();
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0 || this.immersive) return;
    this.renderer.setPixelRatio(this.#ratio(LEVELS[this.quality.level]));
    this.renderer.setSize(width, height, false);
    const before = this.camera.aspect;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (before !== this.camera.aspect) this.onResize(before);
    this.invalidate();
  }

  // The finest drawing there is, as a file of an image, to `done(blob)`.
  picture(done) {
    this.#refine(LEVELS[0]);
    this.renderer.render(this.scene, this.camera);
    this.canvas.toBlob(done);
    this.#refine();
  }

  // Of the finest drawing, whatever the machine manages.
  #bytes() {
    this.#refine(LEVELS[0]);
    this.renderer.render(this.scene, this.camera);
    const gl = this.renderer.getContext();
    const { drawingBufferWidth: width, drawingBufferHeight: height } = gl;
    const bytes = new Uint8Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
    this.#refine();
    return { width, height, bytes };
  }

  // How many pixels have a colour up to `within`, for tests as pixels().
  tinted(colour, within) {
    const { bytes } = this.#bytes();
    let count = 0;
    for (let k = 0; k < bytes.length; k += 4) {
      count += colour.every((value, c) => Math.abs(bytes[k + c] - value) <= within) ? 1 : 0;
    }
    return count;
  }

  // Mean colour and its variance over the drawing, for tests: read right after it was drawn.
  pixels() {
    const { width, height, bytes } = this.#bytes();
    const sum = [0, 0, 0, 0];
    const squares = [0, 0, 0, 0];
    bytes.forEach((value, k) => {
      sum[k % 4] += value;
      squares[k % 4] += value * value;
    });
    const count = width * height;
    const mean = sum.map((s) => s / count);
    return { width, height, mean, variance: squares.map((s, k) => s / count - mean[k] ** 2) };
  }
}

// Lines that fade towards the rim; each tenth is stronger.
function gridGeometry(center, radius, spacing) {
  const positions = [];
  const colours = [];
  const pieces = 16;
  const shade = (x, y, strong) =>
    Math.max(0, 1 - Math.hypot(x - center.x, y - center.y) / radius) * (strong ? 0.75 : 0.3);
  const line = (value, axis, from) => {
    const strong = Math.round(value / spacing) % 10 === 0;
    for (let k = 0; k < pieces; ++k) {
      for (const end of [k, k + 1]) {
        const other = from + (2 * radius * end) / pieces;
        const [x, y] = axis === 0 ? [value, other] : [other, value];
        positions.push(x, y, 0);
        colours.push(1, 1, 1, shade(x, y, strong));
      }
    }
  };
  for (const [axis, middle, across] of [[0, center.x, center.y], [1, center.y, center.x]]) {
    const first = Math.ceil((middle - radius) / spacing);
    const last = Math.floor((middle + radius) / spacing);
    for (let k = first; k <= last; ++k) line(k * spacing, axis, across - radius);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(positions), 3));
  geometry.setAttribute("color", new BufferAttribute(new Float32Array(colours), 4));
  return geometry;
}
