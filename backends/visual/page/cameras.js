// SPDX-License-Identifier: BSD-3-Clause
// Where the scene is looked at from: orbit with the mouse, four fixed views, and keeping the tool
// in the middle.

import { OrbitControls, Vector3 } from "./vendor/three.min.js";
import { openings } from "./beside.js";
import { at } from "./words.js";

// From where each view looks, seen from the middle of the scene.
const VIEWS = {
  home: [0.62, -0.86, 0.5],
  front: [1, 0, 0.06],
  side: [0.0001, -1, 0.06],
  top: [-0.0001, 0, 1],
};

const MARGIN = 1.06;  // around what is seen
const UPRIGHT = 1e-4;  // how little a look along z is off it, for the picture to have an up
const FOLLOWED = 7.5;  // distance while following, in radii of the tool

export class Cameras {
  mode = "home";
  following = false;
  #tool = new Vector3();
  #known = false;
  #step = new Vector3();

  constructor(stage) {
    this.stage = stage;
    this.controls = new OrbitControls(stage.camera, stage.canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    let held = false;  // a click alone does not leave a view
    this.controls.addEventListener("start", () => (held = true));
    this.controls.addEventListener("end", () => (held = false));
    this.controls.addEventListener("change", () => {
      if (held) this.mode = "free";
      stage.invalidate();
    });
    stage.target = this.controls.target;
    stage.onResize = (before) => this.#resized(before);
    for (const name of Object.keys(VIEWS)) {
      at(`view-${name}`).addEventListener("click", () => this.view(name));
    }
    at("follow").addEventListener("click", () => this.follow(!this.following));
  }

  // What the views show: the points that `corners()` gives; and, while following, this much around
  // the tool.
  frame(corners, nearby) {
    this.cornersNow = corners;
    this.nearby = nearby;
    this.view("home");
  }

  view(name) {
    if (!this.cornersNow) return;
    this.mode = name;
    const { camera } = this.stage;
    const away = new Vector3(...VIEWS[name]).normalize();
    const middle = this.controls.target;
    const distance = this.following ? this.#center() : this.#fit(away, middle);
    camera.position.copy(away).multiplyScalar(distance).add(middle);
    this.controls.update();
    this.stage.invalidate();
  }

  // Looks from an end of an axis of the world at what is in the middle now, from as far.
  turn(axis) {
    this.mode = "free";
    const { position } = this.stage.camera;
    const away = this.#step.subVectors(position, this.controls.target);
    const distance = away.length();
    away.setZ(0).setLength(UPRIGHT);
    position.fromArray(axis).add(away).setLength(distance).add(this.controls.target);
    this.controls.update();
    this.stage.invalidate();
  }

  // The tool is to be in the middle of the picture. Returns from how far it is looked at.
  #center() {
    this.controls.target.copy(this.#tool);
    this.stage.camera.clearViewOffset();
    return this.#followed();
  }

  // Finds the point to look at, and the distance, for all corners to be seen from a direction
  // beside what lies on the picture, as large as they can be.
  #fit(away, middle) {
    const { camera, canvas } = this.stage;
    const { clientWidth: width, clientHeight: height } = canvas;
    const [wide, high] = this.#fill(away, middle, width, height).seen;
    const larger = (a, b) => (Math.min(b.width / wide, b.height / high) >
                              Math.min(a.width / wide, a.height / high) ? b : a);
    const room = openings(canvas.parentElement).reduce(larger);
    const { x, y } = room;
    camera.setViewOffset(width, height, (width - room.width) / 2 - x,
                         (height - room.height) / 2 - y, width, height);
    return this.#fill(away, middle, room.width, room.height).distance;
  }

  // The same for a room of so many pixels around the middle of the picture. `seen`: width and
  // height of what is seen.
  #fill(away, middle, width, height) {
    const { camera, canvas } = this.stage;
    const pixel = (2 * Math.tan((camera.fov * Math.PI) / 360)) / canvas.clientHeight;
    const [wide, high] = [width, height].map((side) => (side * pixel) / 2 / MARGIN);
    const corners = this.cornersNow();
    const right = new Vector3().crossVectors(camera.up, away).normalize();
    const up = new Vector3().crossVectors(away, right);
    const q = this.#step;
    middle.set(0, 0, 0);
    for (const corner of corners) middle.addScaledVector(corner, 1 / corners.length);
    let distance = 1;
    let seen = [1, 1];
    for (let round = 0; round < 4; ++round) {
      distance = Math.max(...corners.map((corner) => {
        q.subVectors(corner, middle);
        return Math.max(Math.abs(q.dot(right)) / wide, Math.abs(q.dot(up)) / high) + q.dot(away);
      }));
      seen = [right, up].map((side) => {
        const reach = corners.map((corner) => {
          q.subVectors(corner, middle);
          return q.dot(side) / (distance - q.dot(away));
        });
        const [most, least] = [Math.max(...reach), Math.min(...reach)];
        middle.addScaledVector(side, ((most + least) / 2) * distance);
        return (most - least) / pixel;
      });
    }
    return { distance, seen };
  }

  // What the views show reaches from where to where, of the rim of the picture, 1: [least, most]
  // sideways and upwards; null before the first frame.
  reach() {
    if (!this.cornersNow) return null;
    const seen = this.cornersNow().map((corner) => corner.project(this.stage.camera));
    return ["x", "y"].map((k) => {
      const all = seen.map((point) => point[k]);
      return [Math.min(...all), Math.max(...all)];
    });
  }

  look(position, target) {
    this.mode = "free";
    this.stage.camera.clearViewOffset();
    this.controls.target.fromArray(target);
    this.stage.camera.position.fromArray(position);
    this.controls.update();
    this.stage.invalidate();
  }

  // Where the camera is and what it looks at, as look() takes them in one.
  place() {
    return [...this.stage.camera.position.toArray(), ...this.controls.target.toArray()];
  }

  follow(on) {
    this.following = on;
    at("follow").setAttribute("aria-pressed", String(on));
    if (!this.#known) return;
    if (on) {
      // Closer, from where one looks already.
      const { position } = this.stage.camera;
      const away = position.clone().sub(this.controls.target).normalize();
      position.copy(this.#tool).addScaledVector(away, this.#center());
      this.stage.invalidate();
    } else {
      this.view(this.mode in VIEWS ? this.mode : "home");
    }
  }

  // A picture that is taller than wide sees less from the same place.
  #followed() {
    return (FOLLOWED * this.nearby) / Math.min(1, this.stage.camera.aspect);
  }

  // Something else lies on the scene: a fixed view is fitted again.
  refit() {
    if (this.mode in VIEWS && !this.following) this.view(this.mode);
  }

  // The picture has another shape, `before` was its width over its height: a fixed view is fitted
  // again, from elsewhere as much is seen as before.
  #resized(before) {
    if (!this.cornersNow) return;
    if (this.mode in VIEWS && !this.following) return this.refit();
    const { camera } = this.stage;
    const { target } = this.controls;
    const farther = Math.min(1, before) / Math.min(1, camera.aspect);
    camera.position.sub(target).multiplyScalar(farther).add(target);
    this.controls.update();
  }

  // Where the tool is now.
  track(position) {
    if (this.following && this.#known) this.#shift(this.#step.subVectors(position, this.#tool));
    this.#tool.copy(position);
    this.#known = true;
  }

  #shift(by) {
    this.controls.target.add(by);
    this.stage.camera.position.add(by);
    this.stage.invalidate();
  }

  update() {
    this.controls.update();
  }

  // The directions of the one who looks, level with the floor: ahead, to the left, up.
  heading() {
    const ahead = new Vector3();
    this.stage.camera.getWorldDirection(ahead);
    // Looking straight down, ahead is where the top of the picture is.
    const steep = Math.hypot(ahead.x, ahead.y) < 0.05;
    if (steep) ahead.set(0, 1, 0).applyQuaternion(this.stage.camera.quaternion);
    ahead.z = 0;
    ahead.normalize();
    const up = new Vector3(0, 0, 1);
    return { ahead, left: new Vector3().crossVectors(up, ahead), up };
  }

  key(event) {
    const name = ["home", "front", "side", "top"][Number(event.key) - 1];
    if (name) this.view(name);
    else if (event.key === "5") this.follow(!this.following);
    else return false;
    return true;
  }
}
