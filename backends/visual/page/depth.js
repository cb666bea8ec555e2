// SPDX-License-Identifier: BSD-3-Clause
// What the depth camera sees: near is warm, far is cold, black is nothing that was measured. The
// cells that were made of it are in the scene.

import { at, fixed, write } from "./words.js";

const NEAR = [224, 138, 0];
const FAR = [20, 60, 120];

export class Depth {
  #camera = null;  // the one that is shown: the first that was told

  scene() {
    this.#camera = null;
    at("depth-card").hidden = true;
  }

  show(image) {
    if (!image || (this.#camera ?? image.camera) !== image.camera) return;
    this.#camera = image.camera;
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
