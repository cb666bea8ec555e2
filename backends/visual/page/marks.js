// SPDX-License-Identifier: BSD-3-Clause
// What is between the parts: threads to what is near, and arrows of forces, with names on them.

import { Color, Vector3 } from "./vendor/three.min.js";
import { Arrows, Beads, Rods } from "./batches.js";
import { partName } from "./bodies.js";
import { settings } from "./settings.js";
import { forceScale, rangeOf, sides, state, toolPose } from "./state.js";
import { colour, onTheme } from "./theme.js";
import { brief } from "./words.js";

const MOST_PAIRS = 512;
const LEAST_FORCE = 0.05;  // [N]: shorter arrows are not seen
const LEAST_SUM = 1;  // [N]: of the thick ones
const MOST_NAMES = 4;

export class Marks {
  #a = new Vector3();
  #b = new Vector3();
  #n = new Vector3();
  #mixed = new Color();
  #colours = {};

  constructor(stage, labels) {
    this.stage = stage;
    this.labels = labels;
    this.threads = new Rods(stage.scene, 8 * MOST_PAIRS);
    this.beads = new Beads(stage.scene, 2 * MOST_PAIRS);
    this.directions = new Arrows(stage.scene, MOST_PAIRS);
    this.pushes = new Arrows(stage.scene, 2 * MOST_PAIRS);
    this.sums = new Arrows(stage.scene, 16);
    this.counts = { threads: 0, forceArrows: 0, staleThreads: 0 };
    onTheme(() => {
      for (const name of ["far", "near", "overlap", "stale", "force", "total", "operator", "ink"]) {
        this.#colours[name] = new Color(colour(name));
      }
    });
  }

  // From far at the range to near at the surface; inside has a colour of its own.
  colourOf(pair) {
    if (pair.stale) return this.#colours.stale;
    if (pair.d === null) return this.#colours.far;
    if (pair.d < 0) return this.#colours.overlap;
    const closeness = 1 - Math.min(1, pair.d / (rangeOf(pair) || 0.02));
    return this.#mixed.lerpColors(this.#colours.far, this.#colours.near, closeness);
  }

  update(frame) {
    for (const batch of [this.threads, this.beads, this.directions, this.pushes, this.sums]) {
      batch.clear();
    }
    this.counts = { threads: 0, forceArrows: 0, staleThreads: 0 };
    // As thick on the screen from wherever it is looked at.
    this.unit = 0.00085 * this.stage.eye.distanceTo(this.stage.target);
    this.scale = forceScale() * this.stage.rig.scale.x;  // in a headset as long in the room
    for (const pair of frame.pairs.slice(0, MOST_PAIRS)) this.#pair(pair);
    this.#name(frame.pairs);
    if (settings.forces) this.#arms(frame);
    for (const batch of [this.threads, this.beads, this.directions, this.pushes, this.sums]) {
      batch.done();
    }
  }

  #pair(pair) {
    if (!pair.a || !pair.b) return;
    const a = this.#a.fromArray(pair.a);
    const b = this.#b.fromArray(pair.b);
    const tint = this.colourOf(pair);
    if (settings.threads) {
      if (pair.stale) this.threads.addDashed(a, b, this.unit, tint);
      else this.threads.add(a, b, this.unit, tint);
      this.beads.add(a, 2.2 * this.unit, tint);
      this.beads.add(b, 2.2 * this.unit, tint);
      this.counts.threads += 1;
      this.counts.staleThreads += pair.stale ? 1 : 0;
    }
    if (!pair.n) return;
    const n = this.#n.fromArray(pair.n);
    if (settings.directions) {
      this.directions.add(a, n, 22 * this.unit, 0.8 * this.unit, this.#colours.ink);
    }
    if (settings.forces && pair.f > LEAST_FORCE) this.#push(pair, a, b, n);
  }

  // On A along n, and the same backwards on B where B can move.
  #push(pair, a, b, n) {
    const indices = state.scene?.pairs[pair.i] ?? [];
    const moves = (index) => state.scene?.parts[index]?.group !== "obstacle";
    const length = pair.f * this.scale;
    const tint = pair.stale ? this.#colours.stale : this.#colours.force;
    if (moves(indices[0])) this.pushes.add(a, n, length, 1.7 * this.unit, tint);
    if (moves(indices[1])) this.pushes.add(b, n.negate(), length, 1.7 * this.unit, tint);
    this.counts.forceArrows += 1;
  }

  // What pushes, named once, where it pushes hardest; its other pushes are counted up beside.
  #name(pairs) {
    if (!settings.labels) return;
    const pushing = pairs.filter((pair) => pair.f > 0.5).sort((p, q) => q.f - p.f);
    const named = new Map();
    for (const pair of pushing) {
      const side = sides(pair);
      if (!side?.point || !pair.n) continue;
      const name = partName(side.by);
      if (!named.has(name)) named.set(name, []);
      named.get(name).push({ pair, side });
    }
    for (const [name, pushes] of [...named].slice(0, MOST_NAMES)) {
      const [{ pair, side }] = pushes;
      this.#n.fromArray(pair.n).multiplyScalar(side.sign * pair.f * this.scale);
      this.#a.fromArray(side.point).add(this.#n);
      const forces = pushes.slice(0, 3).map((push) => brief(push.pair.f)).join(" + ");
      const age = pair.stale ? `, ${pair.age} ticks old` : "";
      const text = `${name} ${forces} N${age}`;
      this.labels.put(this.#a, name, text, pair.stale ? "stale" : "force");
    }
  }

  // All virtual force on each tool, and what pulls for the operator.
  #arms(frame) {
    frame.arms.forEach((arm, k) => {
      const pose = toolPose(frame, k);
      if (!pose) return;
      this.#a.fromArray(pose);
      this.#sum(arm.force, "total");
      this.#sum(arm.coupling, "operator");
    });
  }

  #sum(force, name) {
    if (!force) return;
    this.#n.fromArray(force);
    const size = this.#n.length();
    if (!(size > LEAST_SUM)) return;
    this.#n.divideScalar(size);
    const length = size * this.scale;
    this.sums.add(this.#a, this.#n, length, 3.2 * this.unit, this.#colours[name]);
  }
}
