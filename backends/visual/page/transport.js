// SPDX-License-Identifier: BSD-3-Clause
// Pause, steps, restart; of a replay also time and speed.

import { asked } from "./capture.js";
import { state } from "./state.js";
import { at, finite, fixed, write } from "./words.js";

const ELSEWHERE = "the robot is elsewhere";  // how a station refuses
const SEEK_PAUSE_MS = 60;  // between two messages while the slider is dragged

export class Transport {
  #dragging = false;
  #last = 0;
  #replay = false;
  #looksOn = false;
  #why = "";  // it may not be paused, stepped and restarted from here; empty: it may
  #titles = {};  // of what can be pressed, when it can

  constructor(connection) {
    this.connection = connection;
    at("pause").addEventListener("click", () => this.toggle());
    at("step-1").addEventListener("click", () => this.step(1));
    at("step-10").addEventListener("click", () => this.step(10));
    at("restart").addEventListener("click", () => this.restart());
    at("speed").addEventListener("change", () => {
      connection.send({ type: "speed", factor: Number(at("speed").value) });
    });
    at("seek").addEventListener("input", () => this.#seek(false));
    at("seek").addEventListener("change", () => this.#seek(true));
    addEventListener("hashchange", () => this.#followLink());
  }

  scene(scene) {
    const replay = scene.mode === "replay";
    at("replay-box").hidden = !replay;
    at("seek").max = scene.duration_s > 0 ? scene.duration_s : 1;
    write(at("duration"), `of ${fixed(scene.duration_s, 1)} s`);
    this.#replay = replay;
    this.#followLink();
  }

  // A report links to its slowest ticks as #t=SECONDS.
  #followLink() {
    const { time } = asked();
    if (finite(time)) this.go(time);
  }

  // There a replay stops and is looked at.
  go(time) {
    if (!this.#replay) return;
    this.connection.send({ type: "pause" });
    this.connection.send({ type: "seek", time_s: time });
  }

  // Who looks on has nothing to press, and at a station only drives: the robot is elsewhere.
  operator({ looksOn, whyNot, noConduct }) {
    this.#looksOn = looksOn === true;
    this.#why = (this.#looksOn && whyNot) || noConduct || "";
    this.#enable();
  }

  // A program that did not say so before says it now.
  refused({ what, why }) {
    if (!["pause", "resume", "step", "restart"].includes(what) || state.operator?.looksOn) return;
    if (!why.startsWith(ELSEWHERE)) return;
    this.#why = why;
    this.#enable();
  }

  #enable() {
    for (const id of ["restart", "pause", "step-1", "step-10", "seek", "speed"]) {
      const button = at(id);
      this.#titles[id] ??= button.title;
      button.disabled = this.#looksOn || this.#why !== "";
      button.title = this.#why ? `Not from here: ${this.#why}` : this.#titles[id];
    }
  }

  frame(frame) {
    write(at("pause"), frame.running ? "Pause" : "Resume");
    if (!this.#dragging && finite(frame.time_s)) at("seek").value = frame.time_s;
  }

  toggle() {
    this.connection.send({ type: state.frame?.running === false ? "resume" : "pause" });
  }

  step(ticks) {
    if (state.frame?.running !== false) this.connection.send({ type: "pause" });
    this.connection.send({ type: "step", ticks });
  }

  restart() {
    this.connection.send({ type: "restart" });
  }

  #seek(final) {
    this.#dragging = !final;
    const now = performance.now();
    if (!final && now - this.#last < SEEK_PAUSE_MS) return;
    this.#last = now;
    this.connection.send({ type: "seek", time_s: Number(at("seek").value) });
  }

  key(event) {
    if (this.#looksOn) return false;
    if (event.key === " ") this.toggle();
    else if (event.key === ".") this.step(1);
    else if (event.key === ">") this.step(10);
    else if (event.key === "Home") this.restart();
    else return false;
    return true;
  }
}
