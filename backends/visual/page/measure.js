// SPDX-License-Identifier: BSD-3-Clause
// A tape: from one click in the scene to the next, with the distance and how far that is along each
// axis. Both ends stay where they were put.

import { Color, Vector3 } from "./vendor/three.min.js";
import { Beads, Rods } from "./batches.js";
import { toast } from "./messages.js";
import { colour, onTheme } from "./theme.js";
import { at, mm } from "./words.js";

export class Measure {
  #ends = [];
  #middle = new Vector3();
  #tint = new Color();

  constructor(stage, labels) {
    Object.assign(this, { stage, labels });
    this.rod = new Rods(stage.scene, 1);
    this.beads = new Beads(stage.scene, 2);
    this.on = false;
    at("measure").addEventListener("click", () => this.#turn(!this.on));
    onTheme(() => this.#tint.set(colour("level")));
    addEventListener("keydown", (event) => event.key === "Escape" && this.#turn(false));
  }

  #turn(on) {
    this.on = on;
    this.#ends.length = 0;
    at("measure").setAttribute("aria-pressed", String(on));
    this.stage.canvas.parentElement.classList.toggle("measuring", on);
    this.stage.invalidate();
  }

  // The two points, or fewer.
  get ends() {
    return this.#ends.map((point) => point.toArray());
  }

  // A third click begins again.
  put(point) {
    if (!point) return toast("Nothing is there to measure from");
    if (this.#ends.length === 2) this.#ends.length = 0;
    this.#ends.push(point.clone());
    this.stage.invalidate();
  }

  draw(unit) {
    this.rod.clear();
    this.beads.clear();
    for (const end of this.#ends) this.beads.add(end, 3 * unit, this.#tint);
    if (this.#ends.length === 2) {
      const [a, b] = this.#ends;
      this.rod.add(a, b, unit, this.#tint);
      this.#middle.addVectors(a, b).multiplyScalar(0.5);
      const along = b.clone().sub(a).toArray().map((x, k) => `${"xyz"[k]} ${mm(x)}`).join(", ");
      this.labels.put(this.#middle, "measure", `${mm(a.distanceTo(b))} mm (${along})`, "level");
    }
    this.rod.done();
    this.beads.done();
  }
}
