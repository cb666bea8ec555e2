// SPDX-License-Identifier: BSD-3-Clause
// The stage: renderer, camera and light. z is up.

import {
  Color, DirectionalLight, Group, HemisphereLight, MeshLambertMaterial, MeshStandardMaterial,
  PCFShadowMap, PerspectiveCamera, Scene, Sphere, Vector3, WebGLRenderer,
} from "./vendor/three.min.js";
import { environment } from "./environment.js";
import { Floor } from "./floor.js";
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

// Where the sun is, seen from the middle of the scene, in radii: to the right of who looks from
// home, for each of the three sides of a box that are seen from there to have a light of its own.
const SUN = [0.7, -1.68, 2.23];
// What a white surface that faces up throws back of sky and sun is 1: so it has the colour that the
// legend shows. Where a graphics card draws, most of the sky is what is mirrored.
const SUNLIGHT = 2.04;
const SKY = 1.57;
const SKY_BESIDE_MIRRORED = 0.25;
const MIRRORED = 0.55;

export class Stage {
  rendered = 0;
  first = null;  // when the first picture was drawn, from the navigation on [ms]
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
    // Smooth edges are four times the pixels, and a picture that the page shows through is mixed
    // with it.
    this.renderer = new WebGLRenderer({ canvas, antialias: !software, alpha: !software });
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
    this.floor = new Floor();
    this.scene.add(this.floor);
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

  // A material of solids: it shines where a graphics card draws.
  surface(options, roughness = 0.5) {
    return this.smooth ? new MeshStandardMaterial({ roughness, ...options })
      : new MeshLambertMaterial(options);
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
    // The room of who looks has a floor of its own.
    this.floor.disc.visible = !this.immersive || this.scene.background !== null;
    const asked = !this.immersive && this.quality.asks();
    const begun = performance.now();
    this.renderer.render(this.scene, this.camera);
    if (asked) {
      this.#finish();
      this.quality.cost(performance.now() - begun);
    }
    this.rendered += 1;
    this.first ??= performance.now();
    return true;
  }

  // Waits until it is drawn.
  #finish() {
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
  }

  setShadows(on) {
    this.shadows = on;
    this.#refine();
  }

  // Lays the floor under a scene and lights it: a sphere that holds it, and its lowest point.
  fit(center, radius, lowest, scene) {
    const around = Math.max(radius, 0.05);
    this.sphere = new Sphere(center.clone(), around);
    this.lowest = lowest;
    this.spacing = this.floor.lay(scene, center.clone().setZ(lowest), around);
    this.sun.position.fromArray(SUN).multiplyScalar(around).add(center);
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
    this.sky = new HemisphereLight(0xffffff, 0xd6d9dd, this.smooth ? SKY_BESIDE_MIRRORED : SKY);
    this.sky.position.set(0, 0, 1);
    this.sun = new DirectionalLight(0xffffff, SUNLIGHT);
    this.sun.shadow.mapSize.setScalar(1024);
    this.sun.shadow.radius = this.smooth ? 6 : 1;
    this.sun.shadow.bias = -0.0005;
    this.sun.shadow.normalBias = 0.004;
    this.scene.add(this.sky, this.sun, this.sun.target);
    this.scene.environmentIntensity = MIRRORED;
    if (this.smooth) this.scene.environment = environment(this.renderer);
  }

  #paint() {
    this.floor.paint();
    if (!this.smooth) this.renderer.setClearColor(colour("sky"), 1);
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
    this.floor.shade.visible = cast;
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
    const picture = document.createElement("canvas");
    Object.assign(picture, { width: this.canvas.width, height: this.canvas.height });
    const context = picture.getContext("2d");
    context.fillStyle = colour("sky");  // which the page has behind what is drawn
    context.fillRect(0, 0, picture.width, picture.height);
    context.drawImage(this.canvas, 0, 0);
    picture.toBlob(done);
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
