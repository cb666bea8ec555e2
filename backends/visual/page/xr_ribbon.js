// SPDX-License-Identifier: BSD-3-Clause
// The force of the last seconds as a ribbon: as high as the force was, the present at the right.

import {
  BufferAttribute, BufferGeometry, Color, DoubleSide, DynamicDrawUsage, Mesh, MeshBasicMaterial,
} from "./vendor/three.min.js";
import { state } from "./state.js";
import { colour, onTheme } from "./theme.js";

const SECONDS = 5;
const COLUMNS = 120;
const LEAST_HIGH = 10;  // [N] as high as the ribbon may be, or the largest force in it

export class Ribbon {
  #corners = new Float32Array(6 * COLUMNS);

  // As wide and high as told [m].
  constructor(width, height) {
    Object.assign(this, { width, height });
    const geometry = new BufferGeometry();
    this.attribute = new BufferAttribute(this.#corners, 3).setUsage(DynamicDrawUsage);
    geometry.setAttribute("position", this.attribute);
    const strip = [];
    for (let k = 0; k + 1 < COLUMNS; ++k) {
      const low = 2 * k;
      strip.push(low, low + 2, low + 1, low + 1, low + 2, low + 3);
    }
    geometry.setIndex(strip);
    this.mesh = new Mesh(geometry, new MeshBasicMaterial({ side: DoubleSide, transparent: true,
                                                           opacity: 0.85 }));
    this.mesh.frustumCulled = false;
    onTheme(() => this.mesh.material.color.set(new Color(colour("force"))));
  }

  update() {
    const { history } = state;
    const forces = [];
    for (let k = 0; k < COLUMNS; ++k) {
      const slot = history.find(history.now - SECONDS * (1 - k / (COLUMNS - 1)));
      forces.push(slot < 0 ? 0 : history.force[slot] || 0);
    }
    const most = Math.max(LEAST_HIGH, ...forces);
    forces.forEach((force, k) => {
      const x = (k / (COLUMNS - 1) - 0.5) * this.width;
      // A thread remains where there was no force.
      this.#corners.set([x, 0, 0, x, 0.001 + (force / most) * this.height, 0], 6 * k);
    });
    this.attribute.needsUpdate = true;
  }
}
