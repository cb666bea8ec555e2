// SPDX-License-Identifier: BSD-3-Clause
// What the depth camera sees: near is warm, far is cold, black is nothing that was measured. The
// cells that were made of it are in the scene.

import { at, fixed, write } from "./words.js";

const NEAR = [224, 138, 0];
const FAR = [20, 60, 120];

export class Depth {
  #images = new Map();  // the last one by camera

  constructor() {
    at("depth-camera").addEventListener("change", () => this.#draw());
  }

  scene() {
    this.#images.clear();
    at("depth-camera").replaceChildren();
    at("depth-card").hidden = true;
  }

  show(image) {
    if (!image) return;
    const { camera } = image;
    if (!this.#images.has(camera)) {
      at("depth-camera").append(new Option(camera, camera));
      at("depth-camera").hidden = this.#images.size === 0;
    }
    this.#images.set(camera, image);
    if (camera === at("depth-camera").value) this.#draw();
  }

  #draw() {
    const image = this.#images.get(at("depth-camera").value);
    const seen = image.mm.filter((mm) => mm > 0 && mm < 65535);
    const low = seen.reduce((a, b) => Math.min(a, b), Infinity);
    const high = seen.reduce((a, b) => Math.max(a, b), 0);
    const canvas = at("depth");
    Object.assign(canvas, { width: image.width, height: image.height });
    const context = canvas.getContext("2d");
    const pixels = context.createImageData(image.width, image.height);
    image.mm.forEach((mm, k) => {
      const share = mm > 0 ? Math.min(1, (mm - low) / Math.max(1, high - low)) : NaN;
      NEAR.forEach((near, c) => {
        pixels.data[4 * k + c] = share >= 0 ? near + share * (FAR[c] - near) : 0;
      });
      pixels.data[4 * k + 3] = 255;
    });
    context.putImageData(pixels, 0, 0);
    at("depth-card").hidden = false;
    const range = seen.length > 0 ? `${fixed(low / 1000, 2)} to ${fixed(high / 1000, 2)} m`
                                  : "nothing is seen";
    write(at("depth-text"), `${image.camera}: ${range}`);
  }
}
