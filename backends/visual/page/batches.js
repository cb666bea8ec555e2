// SPDX-License-Identifier: BSD-3-Clause
// Rods, arrows and beads in any number, drawn in a call for each kind. Nothing is allocated while
// they move.

import {
  Color, ConeGeometry, CylinderGeometry, DynamicDrawUsage, InstancedMesh, Matrix4,
  MeshBasicMaterial, Quaternion, SphereGeometry, Vector3,
} from "./vendor/three.min.js";

const UP = new Vector3(0, 0, 1);
const matrix = new Matrix4();
const turn = new Quaternion();
const size = new Vector3();
const along = new Vector3();
const tip = new Vector3();
const step = new Vector3();
const part = new Vector3();
const white = new Color();

// Copies of one geometry. They lie on top of the scene: what points into a part must be seen.
class Batch {
  constructor(scene, geometry, capacity, opacity) {
    const material = new MeshBasicMaterial({ depthTest: false, transparent: true, opacity });
    this.mesh = new InstancedMesh(geometry, material, capacity);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.setColorAt(0, white);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = 10;
    this.capacity = capacity;
    scene.add(this.mesh);
    this.clear();
  }

  clear() {
    this.mesh.count = 0;
  }

  put(position, rotation, scale, colour) {
    const k = this.mesh.count;
    if (k >= this.capacity) return;
    this.mesh.setMatrixAt(k, matrix.compose(position, rotation, scale));
    this.mesh.setColorAt(k, colour);
    this.mesh.count = k + 1;
  }

  done() {
    this.mesh.instanceMatrix.needsUpdate = true;
    this.mesh.instanceColor.needsUpdate = true;
    this.mesh.visible = this.mesh.count > 0;
  }
}

// Straight pieces between two points.
export class Rods extends Batch {
  constructor(scene, capacity, opacity = 1) {
    const geometry = new CylinderGeometry(1, 1, 1, 8, 1, true).rotateX(Math.PI / 2);
    super(scene, geometry.translate(0, 0, 0.5), capacity, opacity);
  }

  add(from, to, radius, colour) {
    along.subVectors(to, from);
    const length = along.length();
    if (!(length > 1e-9)) return;
    turn.setFromUnitVectors(UP, along.divideScalar(length));
    this.put(from, turn, size.set(radius, radius, length), colour);
  }

  addDashed(from, to, radius, colour, dashes = 5) {
    step.subVectors(to, from).divideScalar(2 * dashes - 1);
    part.copy(from);
    for (let k = 0; k < dashes; ++k) {
      tip.addVectors(part, step);
      this.add(part, tip, radius, colour);
      part.addVectors(tip, step);
    }
  }
}

export class Beads extends Batch {
  constructor(scene, capacity) {
    super(scene, new SphereGeometry(1, 10, 8), capacity, 1);
  }

  add(position, radius, colour) {
    this.put(position, turn.identity(), size.setScalar(radius), colour);
  }
}

export class Arrows {
  constructor(scene, capacity) {
    this.shafts = new Rods(scene, capacity);
    const cone = new ConeGeometry(1, 1, 14).rotateX(Math.PI / 2).translate(0, 0, 0.5);
    this.heads = new Batch(scene, cone, capacity, 1);
  }

  get count() {
    return this.heads.mesh.count;
  }

  clear() {
    this.shafts.clear();
    this.heads.clear();
  }

  // From a point, `direction` of length one. A short one is all head.
  add(from, direction, length, radius, colour) {
    const head = Math.min(length, 7 * radius);
    tip.copy(from).addScaledVector(direction, length - head);
    this.shafts.add(from, tip, radius, colour);
    turn.setFromUnitVectors(UP, direction);
    this.heads.put(tip, turn, size.set((2.6 * head) / 7, (2.6 * head) / 7, head), colour);
  }

  done() {
    this.shafts.done();
    this.heads.done();
  }
}
