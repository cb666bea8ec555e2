// SPDX-License-Identifier: BSD-3-Clause
// Who drives. While the controls are ours, what the devices say is added up and sent fifty times a
// second, at rest too: the program takes a driver who says nothing for gone.

import { banner, toast } from "./messages.js";
import { bind, settings } from "./settings.js";
import { state } from "./state.js";
import { at, finite, scriptInWords, write } from "./words.js";

const PERIOD_MS = 20;
const HANDS = ["first", "second"];

export class Controls {
  #leading = false;  // the lever was used last, rather than the rates
  #beatAt = -Infinity;
  #both = false;  // the hand that the keys do not move was moved last
  #askedAt = -Infinity;

  // `devices` answer poll(now, limits) with rates between -1 and 1, ahead, left and up, or with
  // rates in the world in metres and radians a second, `world` and `round`; with null when they are
  // not there. One that has a `hand` moves that hand, the others the one that is chosen.
  constructor(connection, devices, lever, hand, heading) {
    Object.assign(this, { connection, devices, lever, hand, heading });
    const percent = (id) => (x) => write(at(id), `${Math.round(100 * x)} %`);
    bind("drive-speed", "driveSpeed", () => this.#speeds());
    bind("dead-band", "deadBand", percent("dead-out"));
    bind("device-scale", "deviceScale", percent("scale-out"));
    bind("clutch-mode", "clutchMode");
    bind("rumble", "rumble");
    at("take").addEventListener("click", () => (this.ours ? this.release() : this.take()));
    setInterval(() => this.#tick(), PERIOD_MS);
    addEventListener("pagehide", () => this.release());
    document.addEventListener("visibilitychange", () => this.#visible());
  }

  get ours() {
    return state.connected && state.operator?.you === true;
  }

  get #arm() {
    return state.scene?.arms[0];
  }

  take() {
    if (this.ours || state.scene?.mode === "replay") return;
    if (performance.now() - this.#askedAt < 300) return;  // the answer is on its way
    this.#askedAt = performance.now();
    if (state.operator?.looksOn) return toast(`You look on: ${state.operator.whyNot}`);
    const plays = state.operator?.by === "script" && scriptInWords(state) === "";
    if (this.connection.send({ type: "take" }) && plays) {
      toast("You take over: the script is over");
    }
  }

  release() {
    if (this.ours) this.connection.send({ type: "release" });
  }

  scene(scene) {
    this.lever.scene(scene.arms[0]);
    this.#speeds();
  }

  operator(message) {
    const { by, you, silent, looksOn, whyNot } = message;
    this.#who(message);
    write(at("take"), you ? "Release" : "Take the controls");
    at("take").hidden = looksOn || by === "recording";
    at("onlooker").hidden = !looksOn;
    at("onlooker").title = whyNot ?? "";
    at("drive-body").hidden = !you;
    at("view").classList.toggle("driving", you);
    banner("silent", silent ? "The device is silent: the operator is let go" : "");
  }

  frame() {
    if (state.operator?.by === "script") this.#who(state.operator);
  }

  #who({ by, you, name }) {
    const words = {
      script: scriptInWords(state) || "The script drives",
      page: you ? "You drive" : "Another page drives",
      device: `${name || "A device"} drives`,
      recording: "A recording plays",
      nobody: "Nobody drives",
    };
    write(at("who"), words[by] ?? by);
  }

  refused({ what, why }) {
    // Whoever asks again at once has read this answer.
    if (what === "take") this.#askedAt = -Infinity;
    const asked = what === "take" ? "No controls" : `Not done (${what})`;
    toast(`${asked}: ${why || "no reason given"}`);
  }

  #speeds() {
    const most = this.#arm?.max_speed_m_s;
    const speed = finite(most) ? `${Math.round(1000 * most * settings.driveSpeed)} mm/s` : "";
    write(at("speed-out"), speed);
  }

  // A hidden page gets no time to drive with, so it does not try.
  #visible() {
    if (document.hidden) {
      this.wasDriving = this.ours;
      this.beat();  // what was held was let go
    } else if (this.wasDriving) {
      toast("While this page was hidden nobody drove: the forces had ramped to zero");
    }
  }

  #tick() {
    if (!document.hidden && performance.now() - this.#beatAt > PERIOD_MS / 2) this.beat();
  }

  // Says what the devices ask for at once, and whether it did. It need not wait for the next turn
  // of a device that knows when it has something to say.
  beat() {
    if (!this.ours) return false;
    this.#beatAt = performance.now();
    const chosen = HANDS[Number(this.hand.second)];
    const [own, other] = [[], []];
    for (const device of this.devices) {
      ((device.hand ?? chosen) === chosen ? own : other).push(device);
    }
    const { linear, angular, clutch } = this.#rates(own);
    const rate = this.hand.second ? 0 : this.lever.rate();
    const moving = [...linear, ...angular].some((x) => x !== 0);
    if (rate !== 0 || moving) this.#leading = rate !== 0;
    const sent = this.#leading && !this.hand.second
      ? this.connection.send({ type: "servo_lever", direction: this.lever.direction(), rate })
      : this.connection.send({ type: "servo_cv", linear, angular, frame: "world", clutch,
                               ...this.hand.named });
    this.#moveOther(other, HANDS[1 - HANDS.indexOf(chosen)]);
    return sent;
  }

  // The last time with a rate of zero.
  #moveOther(devices, hand) {
    const rates = this.#rates(devices);
    if (!rates.clutch && !this.#both) return;
    this.#both = rates.clutch;
    this.connection.send({ type: "servo_cv", ...rates, frame: "world", hand });
  }

  // What these devices together ask for, within what the arm may.
  #rates(devices) {
    const { ahead, left, up } = this.heading();
    const axes = [ahead, left, up].map((axis) => axis.toArray());
    const world = (v) => [0, 1, 2].map((k) => v.reduce((sum, x, i) => sum + x * axes[i][k], 0));
    const share = settings.driveSpeed;
    const fastest = share * (this.#arm?.max_speed_m_s ?? 0.1);
    const turning = share * (this.#arm?.max_turn_rad_s ?? 0.5);
    const linear = [0, 0, 0];
    const angular = [0, 0, 0];
    let clutch = false;
    for (const device of devices) {
      const rates = device.poll(performance.now(), { fastest, turning });
      if (!rates?.clutch) continue;
      clutch = true;
      const along = rates.world ?? world(rates.linear).map((x) => x * fastest);
      const round = rates.round ?? world(rates.angular).map((x) => x * turning);
      for (let k = 0; k < 3; ++k) {
        linear[k] += along[k];
        angular[k] += round[k];
      }
    }
    return { linear: within(linear, fastest), angular: within(angular, turning), clutch };
  }
}

// The vector, shortened to a length where it is longer.
function within(v, most) {
  const size = Math.hypot(...v);
  return size > most ? v.map((x) => (x * most) / size) : v;
}
