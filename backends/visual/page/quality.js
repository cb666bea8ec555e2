// SPDX-License-Identifier: BSD-3-Clause
// How finely the scene is drawn: as finely as the machine manages. Slow frames make it coarser at
// once, quick ones make it finer after a while, and later each time that this was too much.

// The finest first: share of the screen's pixels along a side, and whether shadows are cast. Where
// the processor draws, these cost more than all the rest, so they go first.
export const LEVELS = [
  { pixels: 1, shadow: true },
  { pixels: 1, shadow: false },
  { pixels: 0.85, shadow: false },
  { pixels: 0.7, shadow: false },
  { pixels: 0.5, shadow: false },
];

const SOFTWARE = 2;  // the level to begin with where the processor draws
const CHEAPEST = 3;  // still fewer pixels save time, but hardly the processor

const SLOW_MS = 45;
const QUICK_MS = 20;
const COST_MS = 18;  // of the processor to draw a picture, which is as bad as a slow frame
const LEAST_PATIENCE = 4;  // quick means in a row before it gets finer
const MOST_PATIENCE = 64;
const FRAMES = 15;  // to a mean
const ASKS = 5;  // pictures from one whose cost is measured to the next
const PAUSE_MS = 2000;  // a longer gap is no frame: the machine slept, or nothing was to be drawn

export const finest = () => ({ level: 0, quick: 0, patience: LEAST_PATIENCE, raised: false });

// What follows on a mean time of a frame: { level, quick means in a row, patience, whether the last
// change was to a finer level }.
export function decide({ level, quick, patience, raised }, meanMs) {
  if (meanMs > SLOW_MS && level < LEVELS.length - 1) {
    const longer = raised ? Math.min(2 * patience, MOST_PATIENCE) : patience;
    return { level: level + 1, quick: 0, patience: longer, raised: false };
  }
  if (!(meanMs < QUICK_MS) || level === 0) return { level, quick: 0, patience, raised };
  if (quick + 1 < patience) return { level, quick: quick + 1, patience, raised };
  return { level: level - 1, quick: 0, patience, raised: true };
}

export class Quality {
  #now = finest();
  #sum = 0;
  #count = 0;
  #last = null;
  #cost = Infinity;  // the least of those measured [ms]
  #pictures = 0;

  // `apply(level of LEVELS)` hears of every change. `software`: the processor draws.
  constructor(apply, software) {
    this.apply = apply;
    this.software = software;
    this.adapts = true;
    if (software) this.#now.level = SOFTWARE;
  }

  get level() {
    return this.#now.level;
  }

  // Stays as fine as it can be, or adapts.
  adapt(yes) {
    this.adapts = yes;
    this.#now = finest();
    this.apply(LEVELS[0]);
  }

  // Before each picture: whether it wants to know what the processor takes for this one, for which
  // one has to wait.
  asks() {
    return this.software && this.adapts && this.#pictures++ % ASKS === 0;
  }

  cost(ms) {
    this.#cost = Math.min(this.#cost, ms);
  }

  // At every turn of the browser, with whether the scene was drawn at it.
  frame(now, drawn) {
    const took = this.#last === null ? Infinity : now - this.#last;
    this.#last = drawn ? now : null;
    if (!this.adapts || took > PAUSE_MS) return;
    this.#sum += took;
    if (++this.#count < FRAMES) return;
    const mean = this.#sum / this.#count;
    const cost = this.software ? (this.#cost / COST_MS) * SLOW_MS : 0;
    const counts = this.level < CHEAPEST ? cost : Math.min(cost, SLOW_MS);
    this.#sum = this.#count = 0;
    this.#cost = Infinity;
    this.#set(decide(this.#now, Math.max(mean, counts)));
  }

  #set(next) {
    const changed = next.level !== this.#now.level;
    this.#now = next;
    if (changed) this.apply(LEVELS[next.level]);
  }
}
