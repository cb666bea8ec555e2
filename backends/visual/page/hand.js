// SPDX-License-Identifier: BSD-3-Clause
// The hand at the master: what it feels, and what it can switch in the network. Hidden where there
// is nothing of it; it can be switched by whoever drives, and is shown to all.

import { state, thisArm, thisArmNow } from "./state.js";
import { at, endOf, finite, fixed, norm, write } from "./words.js";

const PATIENCE_MS = 500;  // what was chosen here is shown until the program can have taken it over
const AXES = ["x", "y", "z"];
const WORDS = { x: "along x", y: "along y", z: "along z", rx: "about x", ry: "about y",
                rz: "about z" };

export class Hand {
  second = false;  // the keys move the second hand
  #most = {};
  #chosenAt = -Infinity;
  #boxes = { guides: [], compliant: [] };

  constructor(connection) {
    this.connection = connection;
    at("hand-scale").addEventListener("input", () => {
      this.#say({ type: "scale", factor: factorOf(Number(at("hand-scale").value)) });
    });
    at("guide-strength").addEventListener("input", () => this.#guides());
    const choice = at("hand-choice");
    let pointed = false;
    choice.addEventListener("pointerdown", () => (pointed = true));
    choice.addEventListener("keydown", () => (pointed = false));
    choice.addEventListener("change", () => {
      this.second = choice.value === "second";
      if (pointed) choice.blur();  // the next key drives
    });
  }

  // Of which hand the rates are, for a message; of the only one it need not be said.
  get named() {
    return this.second ? { hand: "second" } : {};
  }

  swap() {
    const choice = at("hand-choice");
    if (at("hand-row").hidden || at("switches").disabled) return;
    choice.value = this.second ? "first" : "second";
    choice.dispatchEvent(new Event("change"));
  }

  scene() {
    this.second = false;
    at("hand-choice").value = "first";
    this.arm();
  }

  // Another arm is shown.
  arm() {
    const arm = thisArm();
    this.#most = {};
    this.#boxes.guides = boxes("fixture-boxes", arm?.fixtures.map(({ name }) => [name, name]),
                               () => this.#guides());
    for (const [k, { title }] of (arm?.fixtures.map(titleOf) ?? []).entries()) {
      this.#boxes.guides[k].parentElement.title = title;
    }
    this.#boxes.compliant = boxes("compliant-boxes",
                                  arm?.compliant.map((word) => [word, word, WORDS[word]]),
                                  () => this.#compliant());
    at("fixture-box").hidden = this.#boxes.guides.length === 0;
    at("compliant-box").hidden = this.#boxes.compliant.length === 0;
    at("hand-scale-row").hidden = !arm?.scales;
    at("hand-row").hidden = !(arm?.hands > 1);
    at("felt-lever").hidden = !arm?.modules.includes("torque_arm");
    at("switches").hidden = ["fixture-box", "compliant-box", "hand-scale-row", "hand-row"]
      .every((id) => at(id).hidden);
    this.#show();
  }

  frame() {
    this.#show();
    const now = thisArmNow();
    at("switches").disabled = !(state.operator?.you === true && state.arm === 0);
    this.#feel("felt-lever", [now?.lever_nm], "N m", 1);
    const [force, torque] = this.second ? [now?.second_grip_n, now?.second_grip_nm]
                                        : [now?.grip_n, now?.grip_nm];
    this.#feel("felt-force", force, "N", 10);
    this.#feel("felt-torque", torque, "N m", 1);
    if (performance.now() - this.#chosenAt < PATIENCE_MS || !now) return;
    for (const box of this.#boxes.guides) box.checked = now.guides?.includes(box.value) === true;
    for (const box of this.#boxes.compliant) {
      box.checked = now.compliant?.includes(box.value) === true;
    }
    const frame = now.compliant_frame;
    write(at("compliant-frame"), frame ? `in the axes of the ${frame}` : "");
    if (finite(now.guide_strength)) at("guide-strength").value = now.guide_strength;
    if (finite(now.scale)) at("hand-scale").value = Math.log10(now.scale);
    write(at("strength-out"), `${fixed(100 * now.guide_strength, 0)} %`);
    write(at("hand-scale-out"), factorText(now.scale));
  }

  // There is something to feel as soon as a frame says so.
  #show() {
    const now = thisArmNow();
    const felt = Boolean(now?.grip_n || now?.second_grip_n);
    at("felt-force").hidden = at("felt-torque").hidden = !felt;
    at("hand").hidden = at("switches").hidden && at("felt-lever").hidden && !felt;
  }

  // A bar ends at `least`, or at a round number that holds the largest there was.
  #feel(id, values, unit, least) {
    const row = at(id);
    if (row.hidden) return;
    const there = Boolean(values?.every(finite));
    const size = there ? norm(values) : 0;
    this.#most[id] = endOf(this.#most[id] ?? least, size);
    write(row.querySelector("output"),
          there ? `${fixed(size, 2)} of ${this.#most[id]} ${unit}` : "\u2013");
    row.querySelector("i").style.transform = `scaleX(${(size / this.#most[id]).toFixed(3)})`;
    const parts = there && values.length === 3
      ? AXES.map((axis, k) => `${axis} ${fixed(values[k], 1)}`).join("  ") : "";
    const small = row.querySelector("small");
    if (small) write(small, parts);
  }

  #say(message) {
    this.#chosenAt = performance.now();
    if (message.factor) write(at("hand-scale-out"), factorText(message.factor));
    this.connection.send(message);
  }

  #guides() {
    const strength = Number(at("guide-strength").value);
    write(at("strength-out"), `${fixed(100 * strength, 0)} %`);
    this.#say({ type: "guides", on: chosen(this.#boxes.guides), strength });
  }

  #compliant() {
    const frame = thisArmNow()?.compliant_frame;
    this.#say({ type: "compliant", directions: chosen(this.#boxes.compliant),
                ...(frame ? { frame } : {}) });
  }
}

const titleOf = ({ shape }) => ({ title: `a ${shape} that attracts the tool` });
const chosen = (boxes) => boxes.filter((box) => box.checked).map((box) => box.value);
export const factorOf = (power) => Number((10 ** power).toPrecision(3));
export const factorText = (factor) => (finite(factor) ? `\u00d7 ${Number(factor.toPrecision(3))}` : "");

// A box to check for each [value, text, title], in the element of that name.
function boxes(id, entries = [], changed) {
  const made = entries.map(([value, text, title]) => {
    const label = document.createElement("label");
    const box = label.appendChild(document.createElement("input"));
    box.type = "checkbox";
    box.value = value;
    box.addEventListener("change", changed);
    label.append(text);
    if (title) label.title = title;
    return { label, box };
  });
  at(id).replaceChildren(...made.map(({ label }) => label));
  return made.map(({ box }) => box);
}
