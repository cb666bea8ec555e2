// SPDX-License-Identifier: BSD-3-Clause
// Names in the scene: elements that lie over the canvas where a point of the scene is seen. They
// move apart where they would lie on each other.

import { Vector3 } from "./vendor/three.min.js";

const HEIGHT = 20;  // of a label, with a gap [px]
const READ_MS = 200;  // between two texts of a label: faster cannot be read, and each is painted

export class Labels {
  #shown = new Map();  // by what it is of: its element, and what that says and where
  #wanted = [];
  #point = new Vector3();

  constructor(holder, stage) {
    this.holder = holder;
    this.stage = stage;
  }

  clear() {
    this.#wanted.length = 0;
  }

  // `of`: what keeps its element while its text changes; `tint` names a colour of the page.
  put(position, of, text, tint = "ink") {
    const { clientWidth: width, clientHeight: height } = this.stage.canvas;
    const p = this.#point.copy(position).project(this.stage.camera);
    if (p.z > 1 || Math.abs(p.x) > 1 || Math.abs(p.y) > 1) return;
    const x = ((p.x + 1) / 2) * width;
    const y = ((1 - p.y) / 2) * height;
    this.#wanted.push({ x: x + 8, y: y - 9, of, text, tint });
  }

  show(now) {
    this.#wanted.sort((a, b) => a.y - b.y);
    this.#wanted.forEach((label, k) => {
      for (const above of this.#wanted.slice(0, k)) {
        const longest = Math.max(label.text.length, above.text.length);
        const aside = Math.abs(label.x - above.x) > 7 * longest;
        if (!aside && label.y - above.y < HEIGHT) label.y = above.y + HEIGHT;
      }
    });
    const { clientWidth: width } = this.stage.canvas;
    for (const [of, { span }] of this.#shown) {
      if (this.#wanted.some((label) => label.of === of)) continue;
      span.remove();
      this.#shown.delete(of);
    }
    for (const label of this.#wanted) this.#write(label, now, width);
  }

  // Only what changed: the browser paints again for everything that is set.
  #write({ x, y, of, text, tint }, now, width) {
    let label = this.#shown.get(of);
    if (!label) {
      label = { span: this.holder.appendChild(document.createElement("span")), at: -Infinity };
      this.#shown.set(of, label);
    }
    const { span } = label;
    if (label.text !== text && now - label.at >= READ_MS) {
      span.textContent = label.text = text;
      label.width = span.offsetWidth;
      label.at = now;
    }
    if (label.tint !== tint) span.style.setProperty("--c", `var(--${(label.tint = tint)})`);
    const left = Math.max(0, Math.min(x, width - label.width));
    const place = `translate(${Math.round(left)}px, ${Math.round(y)}px)`;
    if (label.place !== place) span.style.transform = label.place = place;
  }
}
