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

// `done()`: what was asked for has happened; then the step after it comes by itself.
const STEPS = [
  { text: "An arm, and walls that exist in the model alone. Turn the scene: drag beside the arm." },
  { text: "Take the controls: press the button at the top right, or C.",
    done: () => state.operator?.you === true },
  { text: "Drive down with F, up with R, along with W A S D, or drag the ring at the tool. Go down " +
          "to the table, and feel it: the orange arrow is its push, and it does not let you in.",
    done: () => force() > FELT_N },
  { text: "Now go into a corner, between two walls: each pushes for itself.",
    done: () => state.frame?.pairs.filter((pair) => pair.f > FELT_N).length > 1 },
  { text: "A violet membrane can be passed: push harder until you are through.",
    there: () => state.scene?.parts.some((part) => part.passable),
    done: () => meets((part) => part.passable) },
  { text: "At the right, Energy has the ledger: what went into each module of the network. A module " +
          "that gives more than it got would be orange; none does for long." },
  { text: "Click a body to see what it is and what it is near. Joints, charts and events are beside " +
          "it. ? has all keys. Restart plays the script again." },
];

export class Tour {
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
    this.#step = -1;
    this.#show(true);
    this.#next();
  }

  frame() {
    const step = STEPS[this.#step];
    if (step?.done?.()) this.#next();
  }

  #show(yes) {
    at("tour").hidden = !yes;
    this.moved();
  }

  #next() {
    do this.#step += 1;
    while (STEPS[this.#step]?.there?.() === false);
    const step = STEPS[this.#step];
    if (!step) return this.#end();
    write(at("tour-text"), `${this.#step + 1} of ${STEPS.length}. ${step.text}`);
    write(at("tour-next"), this.#step === STEPS.length - 1 ? "Done" : "Next");
    write(at("tour-skip"), "Skip");
  }

  #end() {
    this.#step = -1;
    this.#show(false);
    set("toured", true);
  }
}
