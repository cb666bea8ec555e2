// SPDX-License-Identifier: BSD-3-Clause
// The mouse as a device: the tool is dragged by its handle, in the plane of the picture. A pale
// copy of the tool stands where it is wanted, a rubber band joins both; the tool follows as fast as
// it may and as far as the walls let it.

import {
  Color, Mesh, MeshBasicMaterial, Plane, Raycaster, TorusGeometry, Vector2, Vector3,
} from "./vendor/three.min.js";
import { Rods } from "./batches.js";
import { colour, onTheme } from "./theme.js";

const GAIN = 4;  // [1/s]: the rate for a metre of rubber band
const REACH_PX = 26;  // of the handle
const FINGER_PX = 38;

export class Drag {
  name = "mouse";
  #grabbed = false;
  #pointerId = null;  // of what grabbed it: other fingers do other things
  #target = new Vector3();
  #offset = new Vector3();
  #plane = new Plane();
  #ray = new Raycaster();
  #pointer = new Vector2();
  #hit = new Vector3();
  #tint = new Color();

  // `mayDrive()`: whether the controls are ours; `take()` asks for them.
  constructor(stage, parts, { mayDrive, take }) {
    Object.assign(this, { stage, parts, mayDrive, take });
    this.tool = null;
    this.band = new Rods(stage.scene, 16, 0.9);
    const material = new MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.9 });
    this.handle = new Mesh(new TorusGeometry(1, 0.09, 6, 40), material);
    this.handle.renderOrder = 11;
    this.handle.visible = false;
    stage.scene.add(this.handle);
    onTheme(() => material.color.copy(this.#tint.set(colour("operator"))));
    // Before the orbit camera hears of it.
    stage.canvas.parentElement.addEventListener("pointerdown", (e) => this.#down(e), true);
    addEventListener("pointermove", (e) => this.#move(e));
    for (const end of ["pointerup", "pointercancel"]) {
      addEventListener(end, (e) => e.pointerId === this.#pointerId && this.#let());
    }
    addEventListener("blur", () => this.#let());
  }

  // The body that is dragged; the copy is made again with every scene.
  scene(body) {
    this.body = body;
    this.tool = this.parts.bodies[body] ?? null;
    this.ghost?.removeFromParent();
    this.ghost = this.tool ? this.parts.ghost(body) : null;
    this.#let();
  }

  #aim(event) {
    const box = this.stage.canvas.getBoundingClientRect();
    this.#pointer.set(((event.clientX - box.left) / box.width) * 2 - 1,
                      1 - ((event.clientY - box.top) / box.height) * 2);
    this.#ray.setFromCamera(this.#pointer, this.stage.camera);
    return box;
  }

  #onTool(event) {
    const box = this.#aim(event);
    const seen = this.#hit.copy(this.tool.position).project(this.stage.camera);
    const off = Math.hypot(((seen.x - this.#pointer.x) * box.width) / 2,
                           ((seen.y - this.#pointer.y) * box.height) / 2);
    const reach = event.pointerType === "touch" ? FINGER_PX : REACH_PX;
    return off < reach || this.#ray.intersectObjects(this.parts.solidsOf(this.body)).length > 0;
  }

  #down(event) {
    if (event.target !== this.stage.canvas || event.button !== 0 || !this.tool) return;
    if (this.#grabbed) return;
    if (!event.shiftKey && !(this.mayDrive() && this.#onTool(event))) return;
    if (!this.mayDrive()) this.take();
    event.stopPropagation();
    this.#aim(event);
    const normal = this.stage.camera.getWorldDirection(new Vector3());
    this.#plane.setFromNormalAndCoplanarPoint(normal, this.tool.position);
    if (!this.#ray.ray.intersectPlane(this.#plane, this.#hit)) return;
    this.#offset.subVectors(this.tool.position, this.#hit);
    this.#target.copy(this.tool.position);
    this.#grabbed = true;
    this.#pointerId = event.pointerId;
    this.stage.canvas.parentElement.classList.add("dragging");
  }

  #move(event) {
    if (!this.#grabbed || event.pointerId !== this.#pointerId) return;
    this.#aim(event);
    if (this.#ray.ray.intersectPlane(this.#plane, this.#hit)) {
      this.#target.addVectors(this.#hit, this.#offset);
    }
    this.stage.invalidate();
  }

  #let() {
    this.#grabbed = false;
    this.#pointerId = null;
    this.stage.canvas.parentElement.classList.remove("dragging");
    this.stage.invalidate();
  }

  // In the world, in metres a second.
  poll() {
    if (!this.#grabbed || !this.tool) return null;
    const rate = this.#hit.subVectors(this.#target, this.tool.position).multiplyScalar(GAIN);
    return { world: rate.toArray(), angular: [0, 0, 0], clutch: true };
  }

  draw() {
    const { tool, ghost, handle, band, stage } = this;
    band.clear();
    const shown = this.mayDrive() && tool !== null && !stage.immersive;
    handle.visible = shown;
    if (ghost) ghost.visible = shown && this.#grabbed;
    if (shown) {
      const unit = 0.0009 * stage.camera.position.distanceTo(tool.position);
      handle.position.copy(this.#grabbed ? this.#target : tool.position);
      handle.quaternion.copy(stage.camera.quaternion);
      handle.scale.setScalar(14 * unit);
      if (this.#grabbed) {
        ghost.position.copy(this.#target);
        ghost.quaternion.copy(tool.quaternion);
        band.addDashed(tool.position, this.#target, unit, this.#tint, 8);
      }
    }
    band.done();
  }
}
