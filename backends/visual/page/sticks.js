// SPDX-License-Identifier: BSD-3-Clause
// Two sticks on the glass as a device, where one drives with the fingers: the left one moves along,
// the right one up and round, as on a gamepad; a button makes the right one tilt.

import { at } from "./words.js";

const DEAD = 0.12;  // of the way to the rim: a finger that rests does not drive

// Where a finger is, as rates between -1 and 1 to the right and up: none within the dead band, and
// no faster beyond the rim. `dx`, `dy`: from the middle, down is positive; `rim` in the same unit.
export function deflection(dx, dy, rim) {
  const size = Math.hypot(dx, dy) / rim;
  if (!(size > DEAD)) return { right: 0, up: 0 };
  const rate = Math.min(1, (size - DEAD) / (1 - DEAD)) / (size * rim);
  return { right: dx * rate, up: -dy * rate };
}

class Stick {
  right = 0;
  up = 0;
  held = false;
  #finger = null;

  constructor(element) {
    this.element = element;
    this.knob = element.querySelector("i");
    element.addEventListener("pointerdown", (event) => {
      if (this.held) return;
      this.#finger = event.pointerId;
      this.held = true;
      element.setPointerCapture(event.pointerId);
      this.#lead(event);
    });
    element.addEventListener("pointermove", (event) => this.#lead(event));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"]) {
      element.addEventListener(end, (event) => {
        if (event.pointerId === this.#finger) this.let();
      });
    }
    element.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  #lead(event) {
    if (!this.held || event.pointerId !== this.#finger) return;
    const box = this.element.getBoundingClientRect();
    const rim = 0.36 * box.width;
    const dx = event.clientX - box.left - box.width / 2;
    const dy = event.clientY - box.top - box.height / 2;
    Object.assign(this, deflection(dx, dy, rim));
    const shown = Math.min(1, rim / Math.max(1, Math.hypot(dx, dy)));
    this.knob.style.transform = `translate(${dx * shown}px, ${dy * shown}px)`;
  }

  // Springs back.
  let() {
    this.#finger = null;
    this.held = false;
    this.right = this.up = 0;
    this.knob.style.transform = "";
  }
}

export class Sticks {
  name = "sticks";
  #tilts = false;

  constructor() {
    this.along = new Stick(at("stick-along"));
    this.round = new Stick(at("stick-round"));
    at("tilt").addEventListener("click", () => this.#switch());
    // A finger whose release is not seen would drive for ever.
    addEventListener("blur", () => this.#let());
    document.addEventListener("visibilitychange", () => this.#let());
  }

  #let() {
    this.along.let();
    this.round.let();
  }

  #switch() {
    this.#tilts = !this.#tilts;
    at("tilt").setAttribute("aria-pressed", String(this.#tilts));
    at("stick-round").classList.toggle("tilts", this.#tilts);
    this.round.let();
  }

  // There is nothing to touch for whoever does not drive.
  operator({ you }) {
    at("sticks").hidden = you !== true;
    if (at("sticks").hidden) this.#let();
  }

  poll() {
    const { along, round } = this;
    if (!along.held && !round.held) return null;
    return {
      linear: [along.up, -along.right, this.#tilts ? 0 : round.up],
      angular: this.#tilts ? [round.right, -round.up, 0] : [0, 0, -round.right],
      clutch: true,
    };
  }
}
