// SPDX-License-Identifier: BSD-3-Clause
// Boxes that the user brings into the scene: dragged from their button to where they are to stand,
// moved by hand, level or, with Alt, up and down, and taken away.

import { Plane, Raycaster, Vector2, Vector3 } from "./vendor/three.min.js";
import { state } from "./state.js";
import { at } from "./words.js";

const SIZE = [0.08, 0.08, 0.08];  // [m] of a new box
const PERIOD_MS = 60;  // between two messages while a box is dragged
const UP = new Vector3(0, 0, 1);

export class Boxes {
  #ray = new Raycaster();
  #pointer = new Vector2();
  #plane = new Plane();
  #hit = new Vector3();
  #offset = new Vector3();
  #target = new Vector3();
  #grabbed = null;  // index of a part
  #last = null;  // the one that was grabbed last
  #pointerId = null;  // of what drags it
  #level = true;
  #bringing = false;
  #sentAt = 0;

  constructor(connection, stage, parts) {
    Object.assign(this, { connection, stage, parts });
    this.spare = [];
    // Before the tool and the orbit camera hear of it.
    stage.canvas.parentElement.addEventListener("pointerdown", (e) => this.#down(e), true);
    addEventListener("pointermove", (e) => this.#move(e));
    addEventListener("pointerup", (e) => e.pointerId === this.#pointerId && this.#up(e));
    addEventListener("pointercancel", (e) => e.pointerId === this.#pointerId && this.#let());
    addEventListener("blur", () => this.#let());
    at("add-box").addEventListener("pointerdown", (e) => {
      this.#bringing = true;
      this.#pointerId = e.pointerId;
      // Else a finger's drag would end on the button where it began.
      e.target.releasePointerCapture?.(e.pointerId);
    });
    at("add-box").addEventListener("click", (e) => {
      if (e.detail === 0) this.#bring(this.#besideTool());  // by the keyboard
    });
    at("remove-box").addEventListener("click", () => this.remove());
  }

  scene(scene) {
    this.spare = scene.spare;
    this.#last = null;
    at("boxes").hidden = this.spare.length === 0 || scene.mode === "replay";
  }

  // Takes away the box that was grabbed last, or else the last of all.
  remove() {
    const { frame, scene } = state;
    const there = this.spare.filter((k) => frame && !frame.absent.includes(scene.parts[k].body));
    const part = there.includes(this.#last) ? this.#last : there.at(-1);
    if (part !== undefined) this.connection.send({ type: "remove_part", part });
    this.#last = null;
  }

  #body(part) {
    return this.parts.bodies[state.scene?.parts[part]?.body];
  }

  #aim(event) {
    const box = this.stage.canvas.getBoundingClientRect();
    this.#pointer.set(((event.clientX - box.left) / box.width) * 2 - 1,
                      1 - ((event.clientY - box.top) / box.height) * 2);
    this.#ray.setFromCamera(this.#pointer, this.stage.camera);
  }

  // The box that is nearest along a ray, and where it is; null: something else is, or nothing.
  along(ray) {
    const seen = this.#seen(ray);
    const part = this.spare.find((k) => seen && this.parts.parts[k]?.solid === seen.object);
    return part === undefined ? null : { part, position: this.#body(part).position.clone() };
  }

  // Leads a box, now and then, and to where it comes to stand: that must not be left out.
  lead(part, position, last = false) {
    this.#last = part;
    if (!last && performance.now() - this.#sentAt < PERIOD_MS) return;
    this.#sentAt = performance.now();
    this.connection.send({ type: "move_part", part, position: position.toArray() });
  }

  // The nearest solid along a ray.
  #seen(ray = this.#ray) {
    const solids = this.parts.parts
      .filter(({ body }) => this.parts.bodies[body]?.visible)
      .map(({ solid }) => solid);
    return ray.intersectObjects(solids, false)[0];
  }

  #down(event) {
    if (event.target !== this.stage.canvas || event.button !== 0 || event.shiftKey) return;
    if (this.spare.length === 0 || this.#grabbed !== null) return;
    this.#aim(event);
    const seen = this.#seen();
    const part = this.spare.find((k) => seen && this.parts.parts[k]?.solid === seen.object);
    if (part === undefined) return;
    event.stopPropagation();
    const { position } = this.#body(part);
    this.#level = !event.altKey;
    const normal = this.#level ? UP.clone()
      : this.stage.camera.getWorldDirection(new Vector3()).setZ(0).normalize();
    this.#plane.setFromNormalAndCoplanarPoint(normal, seen.point);
    this.#offset.subVectors(position, seen.point);
    this.#target.copy(position);
    this.#grabbed = this.#last = part;
    this.#pointerId = event.pointerId;
    this.stage.canvas.parentElement.classList.add("dragging");
  }

  #move(event) {
    if (this.#grabbed === null || event.pointerId !== this.#pointerId) return;
    this.#aim(event);
    if (!this.#ray.ray.intersectPlane(this.#plane, this.#hit)) return;
    this.#hit.add(this.#offset);
    if (this.#level) this.#target.setX(this.#hit.x).setY(this.#hit.y);
    else this.#target.setZ(this.#hit.z);
    this.lead(this.#grabbed, this.#target);
  }

  #up(event) {
    if (this.#grabbed !== null) this.lead(this.#grabbed, this.#target, true);
    if (this.#bringing && event.target === at("add-box")) this.#bring(this.#besideTool());
    if (this.#bringing && event.target === this.stage.canvas) {
      this.#aim(event);
      const seen = this.#seen();
      this.#bring(seen ? seen.point.clone().addScaledVector(UP, SIZE[2] / 2) : this.#besideTool());
    }
    this.#let();
  }

  #let() {
    this.#bringing = false;
    if (this.#grabbed === null) return;
    this.#grabbed = null;
    this.stage.canvas.parentElement.classList.remove("dragging");
  }

  #besideTool() {
    const tool = this.parts.bodies[state.scene?.arms[0]?.tool_body];
    return (tool?.position.clone() ?? new Vector3()).add(new Vector3(0, 0.25, 0));
  }

  #bring(position) {
    this.connection.send({ type: "add_box", size: SIZE, position: position.toArray() });
  }
}
