// SPDX-License-Identifier: BSD-3-Clause
// The axes of the world in the corner of the picture, as the camera sees them. Each end is a button
// to look from there.

import { Quaternion, Vector3 } from "./vendor/three.min.js";

const REACH = 32;  // of an axis [px]

export class Triad {
  #seen = new Quaternion(0, 0, 0, 0);  // how the camera was turned when they were drawn
  #turn = new Quaternion();
  #axis = new Vector3();

  constructor(holder, cameras) {
    this.camera = cameras.stage.camera;
    this.ends = [0, 1, 2].flatMap((k) => [1, -1].map((sign) => {
      const axis = [0, 0, 0];
      axis[k] = sign;
      const name = "xyz"[k];
      const line = sign > 0 ? holder.appendChild(document.createElement("i")) : null;
      const end = holder.appendChild(document.createElement("button"));
      end.type = "button";
      end.textContent = sign > 0 ? name : "";
      end.title = end.ariaLabel = `Look from ${sign > 0 ? "+" : "−"}${name}`;
      end.classList.toggle("behind", sign < 0);
      for (const each of [line, end]) each?.style.setProperty("--c", `var(--${name}-axis)`);
      end.addEventListener("click", () => cameras.turn(axis));
      return { axis, line, end };
    }));
  }

  draw() {
    if (this.#seen.equals(this.camera.quaternion)) return;
    this.#seen.copy(this.camera.quaternion);
    this.#turn.copy(this.#seen).invert();
    for (const { axis, line, end } of this.ends) {
      const { x, y, z } = this.#axis.fromArray(axis).applyQuaternion(this.#turn)
        .multiplyScalar(REACH);
      const depth = String(Math.round(z) + REACH);  // what is nearer lies on top
      end.style.transform = `translate(${x.toFixed(1)}px, ${(-y).toFixed(1)}px)`;
      end.style.zIndex = depth;
      if (!line) continue;
      const [angle, length] = [Math.atan2(-y, x), Math.hypot(x, y) / REACH];
      line.style.transform = `rotate(${angle.toFixed(3)}rad) scaleX(${length.toFixed(3)})`;
      line.style.zIndex = String(Math.min(REACH, Number(depth)));
    }
  }
}
