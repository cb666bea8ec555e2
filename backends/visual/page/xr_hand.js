// SPDX-License-Identifier: BSD-3-Clause
// A hand in the headset: where its controller is, drawn with the ray that it points with. It may be
// a controller, a bare hand, or the screen of a phone that is held into the scene.

import {
  Color, CylinderGeometry, Group, Mesh, MeshBasicMaterial, Quaternion, TorusGeometry, Vector3,
} from "./vendor/three.min.js";
import { colour } from "./theme.js";

const RAY = 0.6;  // [m]
const HANDLE = new CylinderGeometry(0.012, 0.015, 0.1, 12).rotateX(Math.PI / 2);
const RING = new TorusGeometry(0.035, 0.004, 6, 24).translate(0, 0, -0.05);
const BEAM = new CylinderGeometry(0.0012, 0.0012, 1, 6, 1, true).rotateX(-Math.PI / 2)
  .translate(0, 0, -0.5);

export class XrHand {
  grip = { position: new Vector3(), quaternion: new Quaternion() };
  ray = { position: new Vector3(), quaternion: new Quaternion() };
  tracked = false;  // this frame says where it is
  selects = false;
  pinches = false;  // draws the scene, with the other one
  drags = null;  // a box: { part, place in the hand, at in the scene }
  #material = new MeshBasicMaterial();

  constructor(source, clutch, rig) {
    Object.assign(this, { source, clutch });
    this.drawn = new Group();
    this.handle = new Group();
    this.handle.add(new Mesh(HANDLE, this.#material), new Mesh(RING, this.#material));
    this.beam = new Mesh(BEAM, this.#material);
    this.drawn.add(this.handle, this.beam);
    this.drawn.visible = false;
    rig.add(this.drawn);
  }

  get holds() {
    return this.clutch.by === this;
  }

  get onScreen() {
    return this.source.targetRayMode === "screen";
  }

  // Whether it has something to squeeze; otherwise it holds the tool with what selects.
  get squeezes() {
    const { gamepad, hand } = this.source;
    return !hand && !this.onScreen && gamepad?.mapping === "xr-standard" && gamepad.buttons.length > 1;
  }

  // Where it is in this frame. A position that is guessed, without seeing the hand, is none. A
  // touched screen is where the phone is.
  read(frame, space, viewer) {
    const { gripSpace, targetRaySpace } = this.source;
    const pose = this.onScreen ? viewer : gripSpace && frame.getPose(gripSpace, space);
    const ray = frame.getPose(targetRaySpace, space);
    this.tracked = Boolean(pose && ray) && !pose.emulatedPosition;
    if (this.tracked) {
      set(this.grip, pose.transform);
      set(this.ray, ray.transform);
    }
  }

  // `reach`: to what the ray meets [m], where it meets something.
  draw(reach) {
    this.drawn.visible = this.tracked && !this.onScreen;
    this.#material.color.set(new Color(colour(this.clutch.held ? "operator" : "dim")));
    this.handle.position.copy(this.grip.position);
    this.handle.quaternion.copy(this.grip.quaternion);
    this.beam.position.copy(this.ray.position);
    this.beam.quaternion.copy(this.ray.quaternion);
    this.beam.scale.set(1, 1, reach ?? RAY);
    this.beam.visible = !this.clutch.held;
  }

  leave() {
    this.drawn.removeFromParent();
    this.#material.dispose();
  }
}

function set({ position, quaternion }, { position: p, orientation: q }) {
  position.set(p.x, p.y, p.z);
  quaternion.set(q.x, q.y, q.z, q.w);
}
