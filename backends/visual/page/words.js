// SPDX-License-Identifier: BSD-3-Clause
// Numbers and status bits as people read them.

export const at = (id) => document.getElementById(id);

export const finite = (x) => typeof x === "number" && Number.isFinite(x);

// A number with `digits` decimals, or a dash: what is missing must not look like a zero.
export function fixed(x, digits) {
  if (!finite(x)) return "\u2013";
  const digitsOfX = Math.abs(x).toFixed(digits);
  return x < 0 && Number(digitsOfX) > 0 ? `\u2212${digitsOfX}` : digitsOfX;
}

export const mm = (metres, digits = 1) => fixed(finite(metres) ? 1000 * metres : null, digits);

// Three figures, whatever the size.
export function brief(x) {
  if (!finite(x)) return "\u2013";
  const size = Math.abs(x);
  return fixed(x, size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 3);
}

export const norm = (v) => (v ? Math.hypot(...v) : 0);

// The end of a bar that stood at `end` and must hold `size`: it stays, or is the next of 1, 2, 5
// times a power of ten, so that a number can stand at it.
export function endOf(end, size) {
  if (size <= end) return end;
  const power = 10 ** Math.floor(Math.log10(size));
  return Number(([1, 2, 5, 10].find((k) => k * power >= size) * power).toPrecision(1));
}

// Sets a text only where it changed: the browser lays out again for every one that is set.
export function write(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

// What is to be said of the script: that it is over, or that there is none. While one plays that is
// nothing, nor while somebody else drives.
export function scriptInWords({ scene, frame, operator }) {
  if (!scene || !["script", "nobody", "recording"].includes(operator?.by)) return "";
  if (!scene.scripted) return "No script plays";
  return frame?.scriptOver ? "The script is over" : "";
}

const bodies = (count) => (count === 1 ? "1 body" : `${count} bodies`);

// How many bodies push the tool, and how many push links of the arm.
export function pushesInWords(tool, links) {
  const said = [];
  if (tool > 0) said.push(`the tool is pushed by ${bodies(tool)}`);
  if (links > 0) said.push(`${said.length > 0 ? "" : "the "}links by ${bodies(links)}`);
  if (said.length === 0) return "nothing pushes";
  return tool > 0 ? said.join(", ") : said[0].replace("links by", "links are pushed by");
}

// The bits of core/repel/base/status.hpp: how bad, and what they mean. `bad` ones ramp the force to
// zero.
const BITS = {
  bad_pose: ["bad", "a pose was not a number: the arm brakes"],
  bad_command: ["bad", "the operator's input was not a number: the operator is let go"],
  bad_joints: ["bad", "the arm reported no proper joints: it brakes"],
  clock_fault: ["bad", "the clock stood still or ran back: the operator is let go"],
  stale_pairs: ["warn", "some pairs kept an old answer"],
  late_result: ["warn", "a worker did not answer in time"],
  torque_limit: ["warn", "a joint torque is at its limit"],
  crowded_pairs: ["warn", "more pairs are near than there is memory for"],
  expired_pairs: ["bad", "answers are too old: the operator is let go"],
  silent_device: ["bad", "the device is silent: the operator is let go"],
  saturated: ["warn", "the operator asks for more than the coupling gives"],
  joint_limit: ["warn", "a joint is at the end of its range"],
  network_fault: ["bad", "the network could not be solved: the operator is let go"],
  implausible_joints: ["bad", "the joints reported cannot be true: the arm brakes"],
  frozen_joints: ["bad", "a joint reports the same although it moves: the arm brakes"],
  clock_gap: ["bad", "the loop stood still: the operator is let go"],
  bad_torque: ["bad", "a torque was not a number: gravity is held"],
  arm_stopped: ["bad", "the arm is stopped"],
  pushed_out: ["bad", "the arm is pushed out of what it started in"],
  energy_gain: ["bad", "the arm gains energy from its own control"],
  bad_wrench: ["warn", "the force sensor cannot be believed"],
  hold_lost: ["bad", "a hard wall cannot be held"],
  silent_site: ["bad", "the site is silent: this is what it told last"],
  torque_rate: ["warn", "a torque changed as fast as it may"],
  tool_speed: ["warn", "the tool is as fast as it may be"],
  speed_limit: ["warn", "a joint is as fast as it may be"],
};

// { level: good, warn or bad, text }
export function describe(status) {
  const known = status.map((bit) => BITS[bit] ?? ["warn", bit]);
  if (known.length === 0) return { level: "good", text: "ok" };
  const bad = known.filter(([level]) => level === "bad");
  const shown = bad.length > 0 ? bad : known;
  return { level: shown[0][0], text: shown.map(([, text]) => text).join("; ") };
}

// Shows what it was last given for at least `ms`: a status of one tick would flicker unread.
export class Held {
  #value = null;
  #until = 0;
  constructor(ms) {
    this.ms = ms;
  }
  next(value, now, matters) {
    if (matters || now >= this.#until || this.#value === null) {
      this.#value = value;
      this.#until = matters ? now + this.ms : 0;
    }
    return this.#value;
  }
}
