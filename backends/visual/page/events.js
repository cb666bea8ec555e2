// SPDX-License-Identifier: BSD-3-Clause
// What happened, and when: faults and limits that came and went, phases of the script, who drives.
// In a replay a click goes there.

import { state } from "./state.js";
import { at, describe, fixed, write } from "./words.js";

const MOST = 200;
const CALM_S = 0.5;  // what is back before that had not gone
const JUMP_S = 0.5;  // between two frames: not played

export class Events {
  #rows = [];  // { time, until, text, item, lasted }, the last first
  #since = new Map();  // by status bit that is set: its row
  #gone = new Map();  // by one that has gone: its row
  #phase = "";
  #driver = "";
  #shown = -Infinity;  // time of the last frame

  // `go(time)` goes there.
  constructor(go) {
    this.go = go;
    at("events-clear").addEventListener("click", () => this.clear());
  }

  clear() {
    this.#rows.length = 0;
    this.#shown = -Infinity;
    this.#forget();
    at("events").replaceChildren();
    this.#count();
  }

  get count() {
    return this.#rows.length;
  }

  // `recent.status`: [tick, bits], of the first tick and of every one at which they are others. Of
  // a replay that jumps back, what was seen of it stays in the list. Where one jumps into a phase
  // is not where it begins.
  add(frame) {
    const replay = state.scene?.mode === "replay";
    const jumps = frame.time_s < this.#shown || frame.time_s > this.#shown + JUMP_S;
    if (frame.time_s < this.#shown) {
      this.#phase = "";
      if (replay) this.#forget();
      else this.clear();
    }
    const rate = state.scene?.rate_hz || 1;
    for (const [tick, bits] of frame.recent.status) this.#bits(tick / rate, bits);
    const { phase } = frame;
    const begins = !(replay && jumps && frame.time_s > JUMP_S);
    if (phase && phase !== this.#phase && begins) this.#put(frame.time_s, "", phase);
    this.#phase = phase || this.#phase;
    this.#shown = frame.time_s;
  }

  driver(words) {
    if (words === this.#driver) return;
    this.#driver = words;
    if (state.frame) this.#put(state.frame.time_s, "", words);
  }

  #forget() {
    this.#since.clear();
    this.#gone.clear();
  }

  #bits(time, bits) {
    for (const [bit, row] of this.#since) {
      if (bits.includes(bit)) continue;
      this.#since.delete(bit);
      this.#gone.set(bit, row);
      row.until = Math.max(time, row.until);
      write(row.lasted, `for ${fixed(row.until - row.time, 3)} s`);
    }
    for (const bit of bits) {
      if (this.#since.has(bit)) continue;
      const before = this.#gone.get(bit);
      this.#gone.delete(bit);
      const again = before && time - before.until < CALM_S && time >= before.until;
      if (again) write(before.lasted, "");
      const { level, text } = describe([bit]);
      this.#since.set(bit, again ? before : this.#put(time, level, text, bit));
    }
  }

  // A new row, or that of the same moment, which a replay has come to once more.
  #put(time, level, text, bit = "") {
    const known = this.#rows.find((row) => row.text === text && time > row.time - CALM_S &&
                                           time < row.until + CALM_S);
    if (known) return known;
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
    const row = { time, until: time, text, item,
                  lasted: button.appendChild(document.createElement("small")) };
    const place = this.#rows.findIndex((other) => other.time <= time);
    const k = place < 0 ? this.#rows.length : place;
    at("events").insertBefore(item, this.#rows[k]?.item ?? null);
    this.#rows.splice(k, 0, row);
    for (const { item: old } of this.#rows.splice(MOST)) old.remove();
    this.#count();
    return row;
  }

  #count() {
    at("events-none").hidden = this.count > 0;
  }
}
