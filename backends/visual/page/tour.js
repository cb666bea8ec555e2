// SPDX-License-Identifier: BSD-3-Clause
// The first visit: a card that leads through the scene in two minutes. It is offered once, covers
// nothing that is needed, and can be left at any time; the help has it again.

import { set, settings } from "./settings.js";
import { state } from "./state.js";
import { at, norm, write } from "./words.js";

const FELT_N = 2;  // a wall is felt

const force = () => norm(state.frame?.arms[0]?.force);
const meets = (kind) => state.frame?.pairs.some((pair) => pair.f > FELT_N &&
  state.scene.pairs[pair.i]?.slice(0, 2).some((k) => kind(state.scene.parts[k])));

const parts = (kind) => (state.scene?.parts ?? []).filter(kind);
const walls = () => parts((part) => part.group === "obstacle" && !part.passable);
const folded = () => document.documentElement.classList.contains("folded");

// `done()`: what was asked for has happened; then the step after it comes by itself. `there()`:
// the scene has what it speaks of.
const STEPS = [
  { text: () => "An arm, and walls that exist in the model alone. Turn the scene: drag beside " +
                "the arm." },
  { text: () => "Take the controls: press the button at the top" +
                (folded() ? "." : " right, or C."),
    done: () => state.operator?.you === true },
  { text: () => `Drive ${folded() ? "with the sticks: the right one goes up and down"
                                  : "down with F, up with R, along with W A S D"}, or drag the ` +
                "ring at the tool. Go to a wall, and feel it: the orange arrow is its push, and " +
                "it does not let you in.",
    there: () => walls().length > 0,
    done: () => force() > FELT_N },
  { text: () => "Now go on to a second one: in a corner each pushes for itself.",
    there: () => walls().length > 1,
    done: () => state.frame?.pairs.filter((pair) => pair.f > FELT_N).length > 1 },
  { text: () => "A violet membrane can be passed: push harder until you are through.",
    there: () => parts((part) => part.passable).length > 0,
    done: () => meets((part) => part.passable) },
  { text: () => `${folded() ? "In the readings" : "At the right"}, Energy has the ledger: what ` +
                "went into each module of the network. A module that gives more than it got would " +
                "be orange; none does for long.",
    there: () => state.scene?.arms.some((arm) => arm.modules.length > 0) },
  { text: () => "Click a body to see what it is and what it is near. Joints, charts and events are " +
                "beside it. ? has all keys. Restart plays the script again." },
];

export class Tour {
  #steps = [];  // those of this scene
  #step = -1;
  #asked = false;

  // `mayDrive()`: whether this page may take the controls at all; `moved()` hears that the card has
  // come or gone.
  constructor(mayDrive, moved) {
    Object.assign(this, { mayDrive, moved });
    at("tour-next").addEventListener("click", () => this.#next());
    at("tour-skip").addEventListener("click", () => this.#end());
    at("tour-again").addEventListener("click", () => {
      at("help").close();
      this.start();
    });
  }

  // Once for each browser, where one can drive.
  offer() {
    if (this.#asked || settings.toured || !this.mayDrive()) return;
    this.#asked = true;
    this.#show(true);
    write(at("tour-text"), "Here for the first time? A tour of two minutes shows how walls feel.");
    write(at("tour-next"), "Start");
    write(at("tour-skip"), "No, thanks");
  }

  start() {
    this.#asked = true;
    this.#steps = STEPS.filter(({ there }) => there?.() !== false);
    this.#step = -1;
    this.#show(true);
    this.#next();
  }

  frame() {
    if (this.#steps[this.#step]?.done?.()) this.#next();
  }

  #show(yes) {
    at("tour").hidden = !yes;
    this.moved();
  }

  #next() {
    if (this.#steps.length === 0) return this.start();
    this.#step += 1;
    const step = this.#steps[this.#step];
    if (!step) return this.#end();
    write(at("tour-text"), `${this.#step + 1} of ${this.#steps.length}. ${step.text()}`);
    write(at("tour-next"), this.#step === this.#steps.length - 1 ? "Done" : "Next");
    write(at("tour-skip"), "Skip");
  }

  #end() {
    this.#steps = [];
    this.#show(false);
    set("toured", true);
  }
}
