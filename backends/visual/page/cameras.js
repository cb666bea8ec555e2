// SPDX-License-Identifier: BSD-3-Clause
// Where the scene is looked at from: orbit with the mouse, four fixed views, and keeping the tool
// in the middle.

import { OrbitControls, Vector3 } from "./vendor/three.min.js";
import { at } from "./words.js";

// From where each view looks, seen from the middle of the scene.
const VIEWS = {
  home: [0.62, -0.86, 0.5],
  front: [1, 0, 0.06],
  side: [0.0001, -1, 0.06],
  top: [-0.0001, 0, 1],
};

const MARGIN = 1.12;  // around what is seen
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
    this.controls.addEventListener("change", () => stage.invalidate());
    this.controls.addEventListener("start", () => (this.mode = "free"));
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
    let distance = this.#followed();
    if (this.following) middle.copy(this.#tool);
    else distance = this.#fit(away, middle);
    camera.position.copy(away).multiplyScalar(distance).add(middle);
    this.controls.update();
    this.stage.invalidate();
  }

  // Finds the point to look at, and the distance, for all corners to be seen from a direction.
  #fit(away, middle) {
    const { camera } = this.stage;
    const free = Math.max(0.3, 1 - this.stage.covered() / this.stage.canvas.clientHeight);
    const high = (Math.tan((camera.fov * Math.PI) / 360) / MARGIN) * free;
    const corners = this.cornersNow();
    const wide = (high / free) * camera.aspect;
    const right = new Vector3().crossVectors(camera.up, away).normalize();
    const up = new Vector3().crossVectors(away, right);
    const q = this.#step;
    middle.set(0, 0, 0);
    for (const corner of corners) middle.addScaledVector(corner, 1 / corners.length);
    let distance = 1;
    for (let round = 0; round < 4; ++round) {
      distance = Math.max(...corners.map((corner) => {
        q.subVectors(corner, middle);
        return Math.max(Math.abs(q.dot(right)) / wide, Math.abs(q.dot(up)) / high) + q.dot(away);
      }));
      for (const side of [right, up]) {
        const seen = corners.map((corner) => {
          q.subVectors(corner, middle);
          return q.dot(side) / (distance - q.dot(away));
        });
        middle.addScaledVector(side, ((Math.max(...seen) + Math.min(...seen)) / 2) * distance);
      }
    }
    return distance;
  }

  // How far what the views show reaches towards the rim of the picture, 1: sideways and upwards;
  // null before the first frame.
  extent() {
    if (!this.cornersNow) return null;
    const seen = this.cornersNow().map((corner) => corner.project(this.stage.camera));
    return ["x", "y"].map((k) => Math.max(...seen.map((point) => Math.abs(point[k]))));
  }

  look(position, target) {
    this.mode = "free";
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
      this.controls.target.copy(this.#tool);
      position.copy(this.#tool).addScaledVector(away, this.#followed());
      this.stage.invalidate();
    } else {
      this.view(this.mode in VIEWS ? this.mode : "home");
    }
  }

  // A picture that is taller than wide sees less from the same place.
  #followed() {
    return (FOLLOWED * this.nearby) / Math.min(1, this.stage.camera.aspect);
  }

  // The picture has another shape, `before` was its width over its height: a fixed view is fitted
  // again, from elsewhere as much is seen as before.
  #resized(before) {
    if (!this.cornersNow) return;
    if (this.mode in VIEWS && !this.following) return this.view(this.mode);
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
