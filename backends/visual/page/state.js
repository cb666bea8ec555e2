// SPDX-License-Identifier: BSD-3-Clause
// What the program said last, and the last seconds of every tick.

import { settings } from "./settings.js";
import { norm } from "./words.js";

const SECONDS = 10;
const MOST_TICKS = 200000;

// A ring of force and distance, one entry a tick.
export class History {
  #capacity = 1;
  #count = 0;
  #next = 0;
  #last = -1;

  // For a program of `rate` ticks a second.
  reset(rate) {
    this.rate = rate > 0 ? rate : 1000;
    this.#capacity = Math.min(MOST_TICKS, Math.ceil(SECONDS * this.rate) + 1);
    this.time = new Float64Array(this.#capacity);
    this.force = new Float32Array(this.#capacity);
    this.nearest = new Float32Array(this.#capacity);
    this.clear();
  }

  clear() {
    this.#count = this.#next = 0;
    this.#last = -1;
  }

  get seconds() {
    return SECONDS;
  }

  get length() {
    return this.#count;
  }

  get now() {
    return this.#last < 0 ? 0 : this.#last / this.rate;
  }

  // Position in the arrays of the i-th entry, the oldest first.
  slot(i) {
    return (this.#next - this.#count + i + this.#capacity) % this.#capacity;
  }

  // NaN stands for nothing near, and for what is missing.
  add(frame) {
    const { recent } = frame;
    const forces = forcesOf(frame);
    const ticks = recent.tick;
    for (let i = 0; i < ticks.length; ++i) {
      if (ticks[i] === null) continue;
      if (ticks[i] <= this.#last) this.clear();  // restarted, or sought back
      this.#last = ticks[i];
      this.time[this.#next] = ticks[i] / this.rate;
      this.force[this.#next] = forces[i] ?? NaN;
      this.nearest[this.#next] = recent.nearest_m[i] ?? NaN;
      this.#next = (this.#next + 1) % this.#capacity;
      this.#count = Math.min(this.#count + 1, this.#capacity);
    }
  }

  // Position of the entry nearest to a time; -1 when there is none within a fifth of a second.
  find(time) {
    let low = 0;
    let high = this.#count - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.time[this.slot(middle)] < time) low = middle + 1;
      else high = middle;
    }
    if (this.#count === 0) return -1;
    const slot = this.slot(low);
    return Math.abs(this.time[slot] - time) < 0.2 ? slot : -1;
  }
}

export const state = {
  scene: null,
  frame: null,
  timing: null,
  operator: null,
  connected: false,
  radius: 1,  // of a sphere that holds the scene [m]
  arm: 0,  // the one whose numbers are shown
  history: new History(),
};

// How long the arrow of a newton is [m]: a scene of ten metres needs longer ones.
export function forceScale() {
  return settings.forceScale || 0.001 * 10 ** Math.max(0, Math.round(Math.log10(state.radius)));
}

// By tick since the last picture: the force on the tool of the arm that is shown [N]. Of all but
// the first arm only pictures tell it.
export function forcesOf({ recent, arms }) {
  if (state.arm === 0) return recent.force_n;
  const force = arms[state.arm]?.force;
  return recent.tick.map(() => (force ? norm(force) : null));
}

export const thisArm = () => state.scene?.arms[state.arm] ?? null;
export const thisArmNow = () => state.frame?.arms[state.arm] ?? null;
export const rangeOf = (pair) => state.scene?.pairs[pair.i]?.[2];

// Where the tool of an arm is in a frame, and null when it is not told.
export const toolPose = (frame, arm = 0) => frame.bodies[state.scene?.arms[arm]?.tool_body] ?? null;

// The two parts of a pair, the one that is pushed away first: part of an arm rather than an
// obstacle. `sign` is -1 where that turned them round.
export function sides(pair) {
  const indices = state.scene?.pairs[pair.i];
  if (!indices) return null;
  const parts = state.scene.parts;
  const [a, b] = indices;
  if (!parts[a] || !parts[b]) return null;
  const turned = parts[a].group === "obstacle" && parts[b].group !== "obstacle";
  return turned ? { pushed: b, by: a, point: pair.b, sign: -1 }
                : { pushed: a, by: b, point: pair.a, sign: 1 };
}

const LEAST_PUSH = 0.05;  // [N]: less is not called a push

// Who pushes the arm that is shown: how many bodies the tool, how many the links, and the pair
// that pushes hardest. What stands fixed is one body, in which each obstacle counts for itself, a
// mesh as one. Where two parts that can move meet, each is pushed by the other.
export function pushes(pairs) {
  const tool = new Set();
  const links = new Set();
  let hardest = null;
  for (const pair of pairs) {
    if (!(pair.f > LEAST_PUSH)) continue;
    const [a, b] = state.scene?.pairs[pair.i] ?? [];
    const parts = state.scene?.parts ?? [];
    if (!parts[a] || !parts[b]) continue;
    for (const [pushed, by] of [[a, b], [b, a]]) {
      const whose = parts[pushed].arm === state.arm && { tool, link: links }[parts[pushed].group];
      if (!whose) continue;
      whose.add(parts[by].body > 0 ? `body ${parts[by].body}` : parts[by].of || `part ${by}`);
      if (pair.f > (hardest?.f ?? 0)) hardest = pair;
    }
  }
  return { tool: tool.size, links: links.size, hardest };
}
