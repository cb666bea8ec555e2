// SPDX-License-Identifier: BSD-3-Clause
// Names in the scene: elements that lie over the canvas where a point of the scene is seen. They
// move apart where they would lie on each other.

import { Vector3 } from "./vendor/three.min.js";

const HEIGHT = 20;  // of a label, with a gap [px]

export class Labels {
  #spans = [];
  #wanted = [];
  #point = new Vector3();

  constructor(holder, stage) {
    this.holder = holder;
    this.stage = stage;
  }

  clear() {
    this.#wanted.length = 0;
  }

  // `tint` names a colour of the page, `kind` a class.
  put(position, text, tint = "ink", kind = "") {
    const { clientWidth: width, clientHeight: height } = this.holder;
    const p = this.#point.copy(position).project(this.stage.camera);
    if (p.z > 1 || Math.abs(p.x) > 1 || Math.abs(p.y) > 1) return;
    const x = ((p.x + 1) / 2) * width;
    const y = ((1 - p.y) / 2) * height;
    this.#wanted.push({ x: x + 8, y: y - 9, text, tint, kind });
  }

  show() {
    this.#wanted.sort((a, b) => a.y - b.y);
    this.#wanted.forEach((label, k) => {
      for (const above of this.#wanted.slice(0, k)) {
        const longest = Math.max(label.text.length, above.text.length);
        const aside = Math.abs(label.x - above.x) > 7 * longest;
        if (!aside && label.y - above.y < HEIGHT) label.y = above.y + HEIGHT;
      }
      this.#write(k, label);
    });
    for (let k = this.#wanted.length; k < this.#spans.length; ++k) this.#spans[k].hidden = true;
  }

  #write(k, { x, y, text, tint, kind }) {
    this.#spans[k] ??= this.holder.appendChild(document.createElement("span"));
    const span = this.#spans[k];
    span.hidden = false;
    if (span.textContent !== text) span.textContent = text;
    if (span.className !== kind) span.className = kind;
    span.style.setProperty("--c", `var(--${tint})`);
    span.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px)`;
  }
}
