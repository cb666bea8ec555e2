// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a tick that can be drawn over time, by the names that they have in a CSV log; those
// of pictures, some 60 a second, over the last minute. Of what every tick tells, a picture has the
// greatest since the one before, of the distance the least.

import { state, thisArm, thisArmNow } from "./state.js";
import { finite } from "./words.js";

const MOST = 3600;
const UNITS = [["_m_s", "m/s"], ["_rad_s", "rad/s"], ["_rad", "rad"], ["_nm", "N m"], ["_n", "N"],
               ["_m", "m"], ["_j", "J"], ["_us", "us"]];
const OF_TICKS = [["nearest_m", Math.min], ["force_n", Math.max], ["compute_us", Math.max],
                  ["late_us", Math.max]];

export const unitOf = (name) => UNITS.find(([end]) => name.endsWith(end))?.[1] ?? "";

// Of the arm that is shown; what the arm has by its index, with all others of its kind.
export function signalNames() {
  return [...OF_TICKS.map(([name]) => name), ...(thisArm()?.signals ?? [])];
}

export function signalNow(name) {
  const k = thisArm()?.signals.indexOf(name) ?? -1;
  return k < 0 ? null : thisArmNow()?.signals[k] ?? null;
}

export class SignalHistory {
  #time = [];
  #rows = [];  // by picture: the numbers in the order of signalNames()

  clear() {
    this.#time.length = this.#rows.length = 0;
  }

  // A frame that goes back in time begins anew.
  add(frame) {
    const now = frame.time_s;
    if (!finite(now)) return;
    if (now < (this.#time.at(-1) ?? -Infinity)) this.clear();
    if (now === this.#time.at(-1)) return;
    const ticks = OF_TICKS.map(([name, pick]) => {
      const values = frame.recent[name].filter(finite);
      return values.length > 0 ? values.reduce((a, b) => pick(a, b)) : null;
    });
    this.#time.push(now);
    this.#rows.push([...ticks, ...(frame.arms[state.arm]?.signals ?? [])]);
    if (this.#time.length > 1.1 * MOST) {
      this.#time.splice(0, this.#time.length - MOST);
      this.#rows.splice(0, this.#rows.length - MOST);
    }
  }

  // [times [s], values of the first name, of the second, ...], as uPlot takes them.
  columns(names) {
    const all = signalNames();
    const places = names.map((name) => all.indexOf(name));
    return [this.#time.slice(),
            ...places.map((k) => this.#rows.map((row) => (k < 0 ? null : row[k] ?? null)))];
  }
}
