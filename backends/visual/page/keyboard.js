// SPDX-License-Identifier: BSD-3-Clause
// The keyboard as a device: held keys are rates, seen from where one looks.

const SLOW = 0.25;  // with shift

// Position on the keyboard: what it moves, and by how much. Axes: ahead, left, up.
const MOVES = {
  KeyW: ["linear", 0, 1], KeyS: ["linear", 0, -1],
  KeyA: ["linear", 1, 1], KeyD: ["linear", 1, -1],
  KeyR: ["linear", 2, 1], KeyF: ["linear", 2, -1],
  KeyE: ["linear", 2, 1], KeyQ: ["linear", 2, -1],
  KeyI: ["angular", 1, 1], KeyK: ["angular", 1, -1],
  KeyJ: ["angular", 2, 1], KeyL: ["angular", 2, -1],
  KeyU: ["angular", 0, -1], KeyO: ["angular", 0, 1],
};
export const LEVER_KEYS = { KeyM: 1, KeyN: -1 };

export class Keyboard {
  name = "keyboard";
  #held = new Set();
  #slow = false;

  constructor() {
    // A key whose release is not seen would drive for ever.
    addEventListener("blur", () => this.#held.clear());
    document.addEventListener("visibilitychange", () => this.#held.clear());
  }

  // Whether it is a key to drive with.
  down(event) {
    if (!(event.code in MOVES) && !(event.code in LEVER_KEYS)) return false;
    this.#held.add(event.code);
    this.#slow = event.shiftKey;
    return true;
  }

  up(event) {
    this.#held.delete(event.code);
    this.#slow = event.shiftKey;
  }

  poll() {
    const rates = { linear: [0, 0, 0], angular: [0, 0, 0], clutch: true };
    for (const code of this.#held) {
      const [kind, axis, sign] = MOVES[code] ?? [];
      if (kind) rates[kind][axis] += sign * (this.#slow ? SLOW : 1);
    }
    return rates;
  }

  // Of the lever, between -1 and 1.
  lever() {
    let rate = 0;
    for (const code of this.#held) rate += LEVER_KEYS[code] ?? 0;
    return Math.max(-1, Math.min(1, rate)) * (this.#slow ? SLOW : 1);
  }
}
