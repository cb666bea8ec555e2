// SPDX-License-Identifier: BSD-3-Clause
// What a hand in the headset feels: a vibration that grows with the force, and a tick at the first
// touch. A phone has no strengths: there the share of the time that it vibrates grows.

import { settings } from "./settings.js";

const TOUCH = 1;  // [N]
const GONE = 0.5;  // [N]
const FULL = 60;  // [N]
const PERIOD_MS = 50;
const TICK = { strength: 0.8, ms: 15 };

export class Feel {
  pulses = 0;  // since the page was opened
  strength = 0;  // of the last one
  #touches = false;
  #nextAt = 0;

  // `force` on the tool [N]; `sources`: the input sources of the hands that hold it.
  feel(sources, force, now) {
    if (sources.length === 0 || !settings.rumble) return this.rest();
    const first = !this.#touches && force > TOUCH;
    this.#touches = force > (this.#touches ? GONE : TOUCH);
    if (!this.#touches || (!first && now < this.#nextAt)) return;
    this.#nextAt = now + PERIOD_MS;
    this.strength = first ? TICK.strength : Math.min(1, force / FULL);
    this.pulses += 1;
    const ms = first ? TICK.ms : PERIOD_MS + 10;
    for (const source of sources) vibrate(source, this.strength, ms);
  }

  rest() {
    this.#touches = false;
    this.#nextAt = 0;
  }
}

// What browsers have in common is not much. A refusal is no fault: it may be busy, or gone.
function vibrate({ gamepad, targetRayMode }, strength, ms) {
  const actuator = gamepad?.hapticActuators?.[0];
  if (actuator?.pulse) actuator.pulse(strength, ms)?.catch?.(() => {});
  else if (gamepad?.vibrationActuator?.playEffect) {
    gamepad.vibrationActuator
      .playEffect("dual-rumble", { duration: ms, strongMagnitude: strength,
                                   weakMagnitude: strength })
      .catch(() => {});
  } else if (targetRayMode === "screen") navigator.vibrate?.(Math.ceil(strength * ms));
}
