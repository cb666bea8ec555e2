// SPDX-License-Identifier: BSD-3-Clause
// Where a mesh is in none of its convex parts: bright dots, and what the legend says of them.

import { Color, Vector3 } from "./vendor/three.min.js";
import { Beads } from "./batches.js";
import { colour, onTheme } from "./theme.js";
import { at, mm, write } from "./words.js";

const MOST = 2000;  // dots

export class Gaps {
  count = 0;  // dots that are seen
  #dots = [];  // with the part in whose frame each is
  #point = new Vector3();
  #dot = new Color();
  #rim = new Color();

  constructor(stage, parts) {
    this.stage = stage;
    this.parts = parts;
    this.beads = new Beads(stage.scene, 2 * MOST);
    onTheme(() => {
      this.#dot.set(colour("gap"));
      this.#rim.set(colour("gap-rim"));
    });
  }

  scene(scene) {
    this.#dots = scene.parts.flatMap(({ gaps }, part) =>
      gaps.map(([x, y, z, depth]) => ({ part, point: new Vector3(x, y, z), depth })));
    const all = scene.parts.reduce((sum, { gap_count }) => sum + gap_count, 0);
    const deepest = Math.max(0, ...this.#dots.map((dot) => dot.depth));
    at("gap-row").hidden = all === 0;
    const places = all === 1 ? "1 place" : `${all} places`;
    const shown = all > this.#dots.length ? `, the ${this.#dots.length} deepest shown` : "";
    write(at("gap-text"), `not covered: ${places}, up to ${mm(deepest, 2)} mm deep${shown}`);
  }

  // `unit`: a length that is as long on the screen from wherever it is looked at.
  update(unit) {
    this.beads.clear();
    this.count = 0;
    this.stage.scene.updateMatrixWorld();
    for (const { part, point } of this.#dots.slice(0, MOST)) {
      const holder = this.parts.seen(part);
      if (!holder) continue;
      this.#point.copy(point).applyMatrix4(holder.matrixWorld);
      this.beads.add(this.#point, 5 * unit, this.#rim);
      this.beads.add(this.#point, 3.6 * unit, this.#dot);
      this.count += 1;
    }
    this.beads.done();
  }
}
