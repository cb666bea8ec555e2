// SPDX-License-Identifier: BSD-3-Clause
// How the parts look: one material for all that look the same, and one to see through them.

import { Color } from "./vendor/three.min.js";
import { colour, onTheme } from "./theme.js";

// Pushed back a little, for the edges to be seen whole.
const BEHIND_EDGES = { polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
const THROUGH = 0.22;  // opacity of what hides something
const POLISHED = 0.12;  // roughness of glass

export class Looks {
  #all = new Map();  // by kind, colour and opacity
  #solidity = 1;

  constructor(stage) {
    this.stage = stage;
    onTheme(() => this.#paint());
  }

  // Of a kind, which names a colour of the page, unless it has a colour of its own. `whole` is how
  // it looks, `through` when it hides something; `glass`: it is seen through anyway.
  of(kind, color, opacity) {
    const key = [kind, color, opacity].join();
    if (this.#all.has(key)) return this.#all.get(key);
    const glass = opacity < 1;
    const whole = this.stage.surface(BEHIND_EDGES, glass ? POLISHED : undefined);
    const through = this.stage.surface({ transparent: true, depthWrite: false,
                                         opacity: Math.min(THROUGH, opacity) });
    const look = { kind, color, opacity, glass, whole, through };
    this.#all.set(key, look);
    this.#fill(look);
    this.#fade(look);
    return look;
  }

  // How solid they are at most: less than 1 while what is in them is to be seen.
  fade(solidity) {
    this.#solidity = solidity;
    for (const look of this.#all.values()) this.#fade(look);
  }

  #fade({ whole, opacity: own }) {
    const opacity = Math.min(own, this.#solidity);
    const opaque = opacity === 1;
    if (whole.transparent === opaque) whole.needsUpdate = true;
    Object.assign(whole, { opacity, transparent: !opaque, depthWrite: opaque });
  }

  #fill({ kind, color, whole, through }) {
    if (color) whole.color.setRGB(color[0], color[1], color[2], "srgb");
    else whole.color.copy(new Color(colour(kind)));
    through.color.copy(whole.color);
  }

  #paint() {
    for (const look of this.#all.values()) this.#fill(look);
    this.stage.invalidate();
  }
}
