// SPDX-License-Identifier: BSD-3-Clause
// A gamepad as a device: the left stick moves along, the right one up and round, the cross tilts.
// It rumbles with the force, where it can.

import { settings } from "./settings.js";
import { at, write } from "./words.js";

const SHOULDERS = [4, 5];
const CROSS = { up: 12, down: 13, left: 14, right: 15 };
const RUMBLE_MS = 100;
const FULL_RUMBLE = 60;  // [N]

// A stick's deflection without its dead band, scaled; the rest of the range stays whole.
export function shaped(x) {
  const size = Math.abs(x) - settings.deadBand;
  if (!(size > 0)) return 0;
  const value = (Math.sign(x) * size * settings.deviceScale) / (1 - settings.deadBand);
  return Math.max(-1, Math.min(1, value));
}

export class Gamepad {
  name = "gamepad";
  #rumbled = 0;

  #pad() {
    return Array.from(navigator.getGamepads?.() ?? []).find((pad) => pad?.connected) ?? null;
  }

  poll() {
    const pad = this.#pad();
    write(at("gamepad-name"),
          `Gamepad: ${pad ? pad.id.split("(")[0].trim() : "none. Press one of its buttons."}`);
    if (!pad) return null;
    const [x, y, turn, lift] = [0, 1, 2, 3].map((k) => shaped(pad.axes[k] ?? 0));
    const cross = (key) => (pad.buttons[CROSS[key]]?.pressed ? 1 : 0);
    const held = SHOULDERS.some((k) => pad.buttons[k]?.pressed);
    return {
      linear: [-y, -x, -lift],
      angular: [cross("right") - cross("left"), cross("up") - cross("down"), -turn],
      clutch: settings.clutchMode === "always" || held,
    };
  }

  rumble(force, now) {
    if (!settings.rumble || force < 1 || now - this.#rumbled < RUMBLE_MS) return;
    const actuator = this.#pad()?.vibrationActuator;
    if (!actuator?.playEffect) return;
    this.#rumbled = now;
    const strength = Math.min(1, force / FULL_RUMBLE);
    const effect = { duration: RUMBLE_MS + 20, strongMagnitude: strength,
                     weakMagnitude: strength / 2 };
    actuator.playEffect("dual-rumble", effect).catch(() => {});  // it may be busy, or gone
  }
}
