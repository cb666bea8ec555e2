// SPDX-License-Identifier: BSD-3-Clause
// The axes of the world, in the corner of the picture, as the camera sees them.

import { Vector3 } from "./vendor/three.min.js";

const SVG = "http://www.w3.org/2000/svg";
const AXES = [["x", [1, 0, 0]], ["y", [0, 1, 0]], ["z", [0, 0, 1]]];

export class Triad {
  #axis = new Vector3();

  constructor(svg, camera) {
    this.camera = camera;
    this.axes = AXES.map(([name, axis]) => {
      const line = svg.appendChild(document.createElementNS(SVG, "line"));
      const text = svg.appendChild(document.createElementNS(SVG, "text"));
      text.textContent = name;
      return { axis, line, text };
    });
  }

  draw() {
    for (const { axis, line, text } of this.axes) {
      this.#axis.fromArray(axis).transformDirection(this.camera.matrixWorldInverse);
      const { x, y } = this.#axis;
      line.setAttribute("x2", (22 * x).toFixed(1));
      line.setAttribute("y2", (-22 * y).toFixed(1));
      text.setAttribute("x", (31 * x).toFixed(1));
      text.setAttribute("y", (-31 * y + 4).toFixed(1));
    }
  }
}
