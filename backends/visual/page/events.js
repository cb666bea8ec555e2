// SPDX-License-Identifier: BSD-3-Clause
// What happened, and when: faults and limits that came and went, phases of the script, who drives.
// In a replay a click goes there.

import { state } from "./state.js";
import { at, describe, fixed, write } from "./words.js";

const MOST = 200;
const CALM_S = 0.5;  // what is back before that had not gone

export class Events {
  #since = new Map();  // by status bit that is set: its row
  #gone = new Map();  // by one that has gone: its row, and when
  #phase = "";
  #driver = "";

  // `go(time)` goes there.
  constructor(go) {
    this.go = go;
    at("events-clear").addEventListener("click", () => this.clear());
  }

  clear() {
    this.#since.clear();
    this.#gone.clear();
    at("events").replaceChildren();
    this.#count();
  }

  get count() {
    return at("events").childElementCount;
  }

  // `changes`: [tick, bits], of the first tick and of every one at which they are others.
  add(frame) {
    const rate = state.scene?.rate_hz || 1;
    for (const [tick, bits] of frame.recent.status) this.#bits(tick / rate, bits);
    if (frame.phase && frame.phase !== this.#phase) this.#put(frame.time_s, "", frame.phase);
    this.#phase = frame.phase || this.#phase;
  }

  driver(words) {
    if (words === this.#driver) return;
    this.#driver = words;
    if (state.frame) this.#put(state.frame.time_s, "", words);
  }

  #bits(time, bits) {
    for (const [bit, row] of this.#since) {
      if (bits.includes(bit)) continue;
      this.#since.delete(bit);
      this.#gone.set(bit, { row, time });
      write(row.lasted, `for ${fixed(time - row.time, 3)} s`);
    }
    for (const bit of bits) {
      if (this.#since.has(bit)) continue;
      const before = this.#gone.get(bit);
      this.#gone.delete(bit);
      const again = before && time - before.time < CALM_S && time >= before.time;
      if (again) write(before.row.lasted, "");
      const { level, text } = describe([bit]);
      this.#since.set(bit, again ? before.row : this.#put(time, level, text, bit));
    }
  }

  #put(time, level, text, bit = "") {
    const item = document.createElement("li");
    const button = item.appendChild(document.createElement("button"));
    button.type = "button";
    button.className = level;
    button.title = bit;
    button.disabled = state.scene?.mode !== "replay";
    button.addEventListener("click", () => this.go(time));
    const when = button.appendChild(document.createElement("span"));
    when.className = "num";
    when.textContent = `${fixed(time, 3)} s`;
    button.appendChild(document.createElement("b")).textContent = text;
    const lasted = button.appendChild(document.createElement("small"));
    at("events").prepend(item);
    while (this.count > MOST) at("events").lastChild.remove();
    this.#count();
    return { lasted, time };
  }

  #count() {
    at("events-none").hidden = this.count > 0;
  }
}
