// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a tick that can be drawn over time, by the names that they have in a CSV log; those
// of pictures, some 60 a second, over the last minute. Of what every tick tells, a picture has the
// greatest since the one before, of the distance the least.

import { forcesOf, state, thisArm, thisArmNow } from "./state.js";
import { finite, norm } from "./words.js";

const MOST = 3600;
const PICTURE_S = 1 / 60;
const GAP_S = 0.5;  // without news of the scene
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

// The least or greatest of those that are numbers.
const picked = (values, pick) => {
  const known = values.filter(finite);
  return known.length > 0 ? known.reduce((a, b) => pick(a, b)) : null;
};

// What is told of the ticks since the last jump back.
function ticksOf(frame) {
  const { recent } = frame;
  const forces = forcesOf(frame);
  let ticks = [];
  recent.tick.forEach((tick, k) => {
    const time = tick / state.scene.rate_hz;
    if (time < ticks.at(-1)?.time) ticks = [];
    ticks.push({ time, nearest_m: recent.nearest_m[k], force_n: forces[k],
                 compute_us: recent.compute_us[k], late_us: recent.late_us[k] });
  });
  return ticks;
}

// What the picture itself tells of its tick.
function atPicture({ arms, pairs }) {
  const force = arms[state.arm]?.force;
  return { force_n: force ? norm(force) : null, nearest_m: pairs[0]?.d };
}

export class SignalHistory {
  #time = [];
  #rows = [];  // by moment: the numbers in the order of signalNames()

  // What is known now, to be kept while more comes.
  held() {
    const copy = new SignalHistory();
    copy.#time = this.#time.slice();
    copy.#rows = this.#rows.slice();
    return copy;
  }

  clear() {
    this.#time.length = this.#rows.length = 0;
  }

  // A frame that goes back in time begins anew. One that comes late, as after a jump ahead, tells
  // of many ticks: they are as many moments as they would have had pictures.
  add(frame) {
    const now = frame.time_s;
    if (!finite(now)) return;
    if (now < (this.#time.at(-1) ?? -Infinity)) this.clear();
    if (now === this.#time.at(-1)) return;
    const ticks = ticksOf(frame);
    let from = 0;
    for (let k = 1; k <= ticks.length; ++k) {
      const next = ticks[k]?.time ?? now;
      if (next - ticks[from].time < PICTURE_S || now - ticks[k - 1].time < PICTURE_S) continue;
      this.#put(ticks[k - 1].time, ticks.slice(from, k));
      from = k;
    }
    this.#put(now, [...ticks.slice(from), atPicture(frame)], frame.arms[state.arm]?.signals);
    if (this.#time.length > 1.1 * MOST) {
      this.#time.splice(0, this.#time.length - MOST);
      this.#rows.splice(0, this.#rows.length - MOST);
    }
  }

  // Where nothing was told for long there is a gap: null. What only pictures tell is undefined
  // between two of them, over which the line goes on.
  #put(time, ticks, signals = []) {
    const last = this.#time.at(-1);
    if (time <= last) return;
    if (time - last > GAP_S) {
      this.#time.push((last + time) / 2);
      this.#rows.push(signalNames().map(() => null));
    }
    this.#time.push(time);
    const most = ([name, pick]) => picked(ticks.map((tick) => tick[name]), pick);
    this.#rows.push([...OF_TICKS.map(most), ...signals]);
  }

  // [times [s], values of the first name, of the second, ...], as uPlot takes them.
  columns(names) {
    const all = signalNames();
    const places = names.map((name) => all.indexOf(name));
    return [this.#time.slice(),
            ...places.map((k) => this.#rows.map((row) => (k < 0 ? null : row[k])))];
  }
}
