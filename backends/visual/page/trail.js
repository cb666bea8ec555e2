// SPDX-License-Identifier: BSD-3-Clause
// Where the tool has been: a line of its last positions.

import { BufferAttribute, BufferGeometry, Line, LineBasicMaterial } from "./vendor/three.min.js";
import { settings } from "./settings.js";
import { colour, onTheme } from "./theme.js";

const MOST = 3000;
const LEAST_STEP = 0.001;  // [m]

export class Trail {
  #positions = new Float32Array(3 * MOST);
  #count = 0;

  constructor(stage) {
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(this.#positions, 3));
    this.line = new Line(geometry, new LineBasicMaterial({ transparent: true, opacity: 0.85 }));
    this.line.frustumCulled = false;
    stage.scene.add(this.line);
    onTheme(() => this.line.material.color.set(colour("operator")));
    this.clear();
  }

  clear() {
    this.#count = 0;
    this.line.geometry.setDrawRange(0, 0);
  }

  add({ x, y, z }) {
    this.line.visible = settings.trail;
    const p = this.#positions;
    const k = 3 * this.#count;
    const far = k === 0 || Math.hypot(x - p[k - 3], y - p[k - 2], z - p[k - 1]) > LEAST_STEP;
    if (!far) return;
    if (this.#count === MOST) {
      p.copyWithin(0, 3 * (MOST / 10));
      this.#count -= MOST / 10;
    }
    p.set([x, y, z], 3 * this.#count);
    this.#count += 1;
    this.line.geometry.setDrawRange(0, this.#count);
    this.line.geometry.attributes.position.needsUpdate = true;
  }
}
