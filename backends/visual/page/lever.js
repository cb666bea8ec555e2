// SPDX-License-Identifier: BSD-3-Clause
// The lever of the torque arm: a slider that springs back leads it, a bar shows what it would give
// the hand. A force is shown here where it cannot be felt.

import { at, endOf, finite, fixed, write } from "./words.js";

const LEAST_NM = 1;  // of the end of the bar

export class Lever {
  #most = LEAST_NM;
  #fastest = 0;  // [rad/s]

  constructor(keyboard, heading) {
    this.keyboard = keyboard;
    this.heading = heading;
    this.slider = at("lever");
    for (const end of ["pointerup", "pointercancel", "blur", "keyup"]) {
      this.slider.addEventListener(end, () => (this.slider.value = 0));
    }
  }

  scene(arm) {
    at("lever-box").hidden = !arm?.modules.includes("torque_arm");
    this.#most = LEAST_NM;
    this.#fastest = arm?.max_lever_rad_s ?? 0;
  }

  // In rad/s; 0 at rest.
  rate() {
    if (at("lever-box").hidden) return 0;
    return this.#fastest * (Number(this.slider.value) || this.keyboard.lever());
  }

  direction() {
    const choice = at("lever-direction").value;
    const axis = ["x", "y", "z"].indexOf(choice);
    if (axis >= 0) return [0, 1, 2].map((k) => (k === axis ? 1 : 0));
    const { ahead, left, up } = this.heading();
    return ({ away: ahead, left, up }[choice] ?? up).toArray();
  }

  frame(arm) {
    const torque = arm?.lever_nm;
    const size = finite(torque) ? torque : 0;
    this.#most = endOf(this.#most, Math.abs(size));
    write(at("lever-out"), `${fixed(torque, 2)} of ${this.#most} N m`);
    at("lever-bar").style.transform = `scaleX(${(size / this.#most).toFixed(3)})`;
  }
}
