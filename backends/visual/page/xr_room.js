// SPDX-License-Identifier: BSD-3-Clause
// How the room of the headset lies in the scene: at the scene's size or so that it stands on a
// table, before whoever looks; and led by two hands that pinch. The room has y up, the scene z.

import { Quaternion, Vector3 } from "./vendor/three.min.js";

const UP = new Vector3(0, 0, 1);
const UPRIGHT = new Quaternion().setFromAxisAngle(new Vector3(1, 0, 0), Math.PI / 2);
const STANDS_OFF = 0.4;  // [m] from the scene at its size
const TABLE = { radius: 0.35, ahead: 0.65, below: 0.45 };  // [m], from the eyes
const SCALES = [0.01, 1000];  // metres of the scene in a metre of the room
const LEAST_SPAN = 0.02;  // [m] between two hands

export class Room {
  size = "life";  // or "table"
  #yaw = 0;
  #pinch = null;
  #point = new Vector3();

  // `rig`: the object of the scene in which camera and hands move as in the room.
  constructor(rig) {
    this.rig = rig;
    this.leave();
  }

  get scale() {
    return this.rig.scale.x;
  }

  // What is drawn outside of the headset has no room.
  leave() {
    this.#pinch = null;
    this.rig.position.set(0, 0, 0);
    this.rig.quaternion.identity();
    this.rig.scale.setScalar(1);
    this.rig.updateMatrixWorld();
  }

  // A point of the room in the scene.
  toScene(point, into) {
    return into.copy(point).applyMatrix4(this.rig.matrixWorld);
  }

  // A turn in the room as one in the scene.
  turnToScene(turn, into) {
    return into.copy(turn).premultiply(this.rig.quaternion);
  }

  // Puts the scene before the viewer, a { position, quaternion } in the room. `heading`: where to
  // the viewer looks in the scene, level; `sphere`: what holds the scene; `lowest` of it [m].
  place({ position, quaternion }, heading, { center, radius }, lowest) {
    const ahead = new Vector3(0, 0, -1).applyQuaternion(quaternion).setY(0);
    if (ahead.length() < 0.1) ahead.set(0, 1, 0).applyQuaternion(quaternion).setY(0);
    ahead.normalize();
    const yaw = Math.atan2(heading.y, heading.x) - Math.atan2(-ahead.z, ahead.x);
    const stands = this.#point.copy(position);
    const middle = center.clone();
    if (this.size === "table") {
      stands.addScaledVector(ahead, TABLE.ahead);
      stands.y -= TABLE.below;
      this.#lay(yaw, radius / TABLE.radius, stands, middle);
    } else {
      stands.addScaledVector(ahead, radius + STANDS_OFF).setY(0);
      this.#lay(yaw, 1, stands, middle.setZ(lowest));
    }
  }

  // So that a point of the room is a point of the scene.
  #lay(yaw, scale, inRoom, inScene) {
    this.#yaw = yaw;
    const { rig } = this;
    rig.scale.setScalar(Math.min(Math.max(scale, SCALES[0]), SCALES[1]));
    rig.quaternion.setFromAxisAngle(UP, yaw).multiply(UPRIGHT);
    rig.position.set(0, 0, 0);
    rig.updateMatrixWorld();
    rig.position.copy(inScene).sub(this.toScene(inRoom, new Vector3()));
    rig.updateMatrixWorld();
  }

  // Two hands in the room hold the scene: what is between them stays there.
  pinch(one, other) {
    const span = this.#point.subVectors(other, one);
    const length = Math.max(span.length(), LEAST_SPAN);
    const angle = Math.atan2(-span.z, span.x);
    const middle = one.clone().add(other).multiplyScalar(0.5);
    this.#pinch ??= { length, angle, yaw: this.#yaw, scale: this.scale,
                      held: this.toScene(middle, new Vector3()) };
    const begun = this.#pinch;
    this.#lay(begun.yaw + begun.angle - angle, (begun.scale * begun.length) / length, middle,
              begun.held);
  }

  letPinch() {
    this.#pinch = null;
  }
}
