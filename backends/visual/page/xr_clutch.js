// SPDX-License-Identifier: BSD-3-Clause
// The clutch between a hand in the headset and the tool. While it is closed the tool follows what
// the hand has moved and turned since: where the hand was when it closed does not matter. What a
// hand cannot do, or a pose that does not come, opens it; only a new squeeze closes it again.

import { Quaternion, Vector3 } from "./vendor/three.min.js";

const LAG_S = 0.04;  // the tool is led to where the hand has it within about this
// Without a pose for longer the tool rests, and then the hand is let go: as the program does with a
// page that it does not hear.
const REST_MS = 100;
const SILENT_MS = 250;
const SILENT = "its poses stopped coming";
// No hand is as fast: a pose that says so is wrong.
export const FASTEST_HAND = 4;  // [m/s]
export const FASTEST_TURN = 25;  // [rad/s]
const LEAST_STEP_S = 1 / 144;  // between two poses: jitter of the clock is no speed

// The shortest turn that a quaternion is, as an axis times its angle [rad].
export function turnOf({ x, y, z, w }, into = new Vector3()) {
  const sine = Math.hypot(x, y, z);
  const angle = 2 * Math.atan2(sine, Math.abs(w));
  return into.set(x, y, z).multiplyScalar(sine > 1e-9 ? (Math.sign(w) || 1) * angle / sine : 0);
}

function turnBy(vector, share, into) {
  const angle = vector.length();
  if (!(angle > 1e-12)) return into.identity();
  return into.setFromAxisAngle(axis.copy(vector).divideScalar(angle), angle * share);
}

const axis = new Vector3();
const step = new Quaternion();

export class Clutch {
  name = "headset";
  hand = undefined;  // of a network with two: which of them this one moves
  by = null;  // the hand that holds it closed
  why = "";  // that hand was let go
  #known = false;  // a pose since it closed
  #from = { position: new Vector3(), turn: new Quaternion() };
  #last = { position: new Vector3(), turn: new Quaternion(), at: 0 };
  #wanted = { along: new Vector3(), turn: new Quaternion() };
  #led = { along: new Vector3(), turn: new Quaternion() };  // as the program has it by now
  #rate = new Vector3();
  #spin = new Vector3();
  #polledAt = 0;

  // `onLet(why)` hears that the hand is let go.
  constructor(onLet) {
    this.onLet = onLet;
  }

  get held() {
    return this.by !== null;
  }

  close(hand) {
    this.by = hand;
    this.why = "";
    this.#known = false;
  }

  // `why` is empty when the hand itself let go.
  open(why = "") {
    if (!this.held) return;
    this.by = null;
    this.why = why;
    this.onLet(why);
  }

  // Where the hand is at a time [ms], in the room and in the scene: the room says how fast it is,
  // the scene where the tool is to go. `scale`: motion of the tool per motion of the hand there.
  // `engaged`: the tool is ours; until then the hand leads nothing.
  move({ room, scene, turn }, now, scale, engaged) {
    if (!this.held) return;
    const known = this.#known && engaged;
    if (this.#known) {
      if (now - this.#last.at > SILENT_MS) return this.open(SILENT);
      const passed = Math.max((now - this.#last.at) / 1000, LEAST_STEP_S);
      step.copy(this.#last.turn).invert().premultiply(turn);
      const jumps = room.distanceTo(this.#last.position) > FASTEST_HAND * passed ||
                    turnOf(step).length() > FASTEST_TURN * passed;
      if (jumps) return this.open("it was faster than a hand is");
    }
    this.#last.position.copy(room);
    this.#last.turn.copy(turn);
    this.#last.at = now;
    this.#known = true;
    if (!known) this.#begin(scene, turn, now);
    this.#wanted.along.subVectors(scene, this.#from.position).multiplyScalar(scale);
    this.#wanted.turn.copy(this.#from.turn).invert().premultiply(turn);
  }

  #begin(scene, turn, now) {
    this.#from.position.copy(scene);
    this.#from.turn.copy(turn);
    this.#led.along.set(0, 0, 0);
    this.#led.turn.identity();
    this.#rate.set(0, 0, 0);
    this.#spin.set(0, 0, 0);
    this.#polledAt = now;
  }

  // Rates in the world [m/s, rad/s], within what the tool may.
  poll(now, { fastest, turning }) {
    const unseen = now - this.#last.at;
    if (this.#known && unseen > SILENT_MS) this.open(SILENT);
    if (!this.held || !this.#known) return null;
    // What was asked for last has gone on until now.
    const passed = Math.min(now - this.#polledAt, REST_MS) / 1000;
    this.#polledAt = now;
    this.#led.along.addScaledVector(this.#rate, passed);
    this.#led.turn.premultiply(turnBy(this.#spin, passed, step)).normalize();
    this.#rate.subVectors(this.#wanted.along, this.#led.along).divideScalar(LAG_S);
    step.copy(this.#led.turn).invert().premultiply(this.#wanted.turn);
    turnOf(step, this.#spin).divideScalar(LAG_S);
    const seen = unseen > REST_MS ? 0 : 1;
    this.#rate.clampLength(0, seen * fastest);
    this.#spin.clampLength(0, seen * turning);
    return { world: this.#rate.toArray(), round: this.#spin.toArray(), clutch: true };
  }
}
