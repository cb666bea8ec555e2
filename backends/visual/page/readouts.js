// SPDX-License-Identifier: BSD-3-Clause
// The words and numbers: status, phase, the big numbers, the nearest pairs, the energies.

import { partName, together } from "./bodies.js";
import { moduleWords } from "./module_words.js";
import { pushes, sides, state, thisArm, thisArmNow } from "./state.js";
import {
  at, brief, describe, finite, fixed, Held, mm, norm, pushesInWords, scriptInWords, write,
} from "./words.js";

const ROWS = 5;
const LATE_MS = 5000;  // as long it is said that ticks were late
const FADED = 0.995;  // gain of the forces below which it is said that they are faded

export class Readouts {
  #status = new Held(700);
  #rows = [];
  #energies = [];
  #misses = 0;
  #missedAt = -Infinity;

  // `colourOf(pair)`: that of the thread in the scene. `armChosen` hears when another arm is shown.
  constructor(colourOf, armChosen) {
    Object.assign(this, { colourOf, armChosen });
    for (let k = 0; k < ROWS; ++k) {
      const row = at("pair-rows").insertRow();
      const cells = [row.insertCell(), row.insertCell(), row.insertCell()];
      const dot = cells[0].appendChild(document.createElement("i"));
      const name = cells[0].appendChild(document.createElement("span"));
      this.#rows.push({ row, cells, dot, name });
    }
  }

  scene(scene) {
    write(at("scene-name"), scene.name);
    document.title = `${scene.name} - repel`;
    at("mode").hidden = scene.mode !== "replay";
    write(at("mode"), "replay");
    const ranges = scene.parts.map((part) => part.range_m).filter((range) => range > 0);
    if (ranges.length > 0) write(at("ramp-text"), `${mm(Math.max(...ranges), 0)} to 0 mm`);
    const walls = scene.parts.filter((part) => part.group === "obstacle");
    at("wall-key").hidden = walls.every((part) => part.passable || part.color);
    for (const key of ["ramp-key", "overlap-key", "push-key", "total-key"]) {
      at(key).hidden = scene.pairs.length === 0;
    }
    at("membrane-key").hidden = !walls.some((part) => part.passable);
    at("stale-key").hidden = true;
    this.#arms(scene.arms);
  }

  #arms(arms) {
    state.arm = 0;
    at("arm-row").hidden = arms.length < 2;
    at("arm").replaceChildren(...arms.map((arm, k) => new Option(arm.name || `arm ${k + 1}`, k)));
    at("arm").onchange = () => this.choose(Number(at("arm").value));
    this.#modules();
  }

  // Shows another arm.
  choose(arm) {
    if (!state.scene.arms[arm] || arm === state.arm) return;
    state.arm = arm;
    at("arm").value = arm;
    this.#modules();
    this.armChosen();
  }

  #modules() {
    this.#energies = (thisArm()?.modules ?? []).map((name) => {
      const row = document.createElement("div");
      const label = row.appendChild(document.createElement("b"));
      const words = moduleWords(name);
      label.textContent = words.name;
      label.tabIndex = 0;
      const explain = () => write(at("energy-what"), `${name}: ${words.what}`);
      for (const kind of ["pointerenter", "focus"]) label.addEventListener(kind, explain);
      const bar = row.appendChild(document.createElement("span"))
        .appendChild(document.createElement("i"));
      return { row, bar, value: row.appendChild(document.createElement("output")) };
    });
    const ask = this.#energies.length > 0 ? "What a module does is said here: point at one." : "";
    write(at("energy-what"), ask);
    at("energy").replaceChildren(...this.#energies.map(({ row }) => row));
    at("energy-card").hidden = this.#energies.length === 0;
  }

  frame(frame, now) {
    write(at("time"), `${fixed(frame.time_s, 2)} s`);
    write(at("phase"), frame.phase || scriptInWords(state));
    this.#showStatus(frame, now);
    this.#showNumbers(frame.pairs);
    this.#showPairs(frame);
    this.#showEnergies();
  }

  #showStatus(frame, now) {
    const misses = state.scene?.mode === "live" ? state.timing?.misses ?? 0 : 0;
    if (misses > this.#misses) this.#missedAt = now;
    this.#misses = misses;
    const some = frame.status.length > 0;
    const said = some || misses === 0 ? describe(frame.status)
                                      : lateInWords(misses, now - this.#missedAt < LATE_MS);
    const { level, text } = this.#status.next(said, now, some);
    const words = state.connected ? text : "not connected";
    write(at("status"), words);
    at("status").title = words;
    at("status").className = `status ${state.connected ? level : "bad"}`;
  }

  #showNumbers(pairs) {
    const nearest = pairs[0]?.d;
    write(at("nearest"), mm(nearest));
    at("nearest").classList.toggle("overlap", nearest < 0);
    const force = thisArmNow()?.force;
    write(at("force"), fixed(force ? norm(force) : null, 1));
    const { tool, links, hardest } = pushes(pairs);
    write(at("pushes"), pushesInWords(tool, links));
    const side = hardest && sides(hardest);
    write(at("hardest"), side ? `${partName(side.pushed)} \u2013 ${partName(side.by)} ` +
                                `${brief(hardest.f)} N` : "");
  }

  #showPairs(frame) {
    const near = `${frame.near ?? "\u2013"} near, of ${frame.of ?? "\u2013"}`;
    const left = frame.pairs_omitted > 0 ? `, ${frame.pairs_omitted} not shown` : "";
    write(at("pair-counts"), near + left);
    at("pair-counts").title = `${frame.evaluated ?? "\u2013"} evaluated in this tick`;
    if (frame.pairs.some((pair) => pair.stale)) at("stale-key").hidden = false;
    const groups = together(frame.pairs);
    at("pairs-table").hidden = groups.length === 0;
    this.#rows.forEach(({ row, cells, dot, name }, k) => {
      const { pairs: [pair], force } = groups[k] ?? { pairs: [] };
      const side = pair && sides(pair);
      row.hidden = !side;
      row.classList.toggle("old", Boolean(pair?.stale));
      dot.hidden = !side;
      write(name, side ? `${partName(side.pushed)} \u2013 ${partName(side.by)}` : "");
      write(cells[1], side ? mm(pair.d) : "");
      write(cells[2], side ? (force > 0 ? fixed(force, 1) : "0") : "");
      if (!side) return;
      const parts = [side.pushed, side.by].map((index) => state.scene.parts[index].name);
      const count = groups[k].pairs.length;
      row.title = parts.join(" \u2013 ") + (count > 1 ? `, and ${count - 1} more` : "") +
        (pair.stale ? `, answer ${pair.age} ticks old` : "");
      const tint = this.colourOf(pair);
      dot.style.setProperty("--c", tint.getStyle());
    });
  }

  #showEnergies() {
    const energies = thisArmNow()?.energy_j ?? [];
    const most = Math.max(0.1, ...energies.map((e) => (finite(e) ? Math.abs(e) : 0)));
    this.#energies.forEach(({ bar, value }, k) => {
      const energy = energies[k];
      write(value, finite(energy) ? `${fixed(energy, 3)} J` : "\u2013");
      bar.style.transform = `scaleX(${finite(energy) ? Math.abs(energy) / most : 0})`;
      bar.classList.toggle("gives", energy < 0);
    });
  }
}

// Of late ticks it is not said that all is well.
function lateInWords(misses, lately) {
  const ticks = misses === 1 ? "1 tick was" : `${misses} ticks were`;
  return { level: lately ? "warn" : "good", text: `${ticks} late${lately ? "" : ", none now"}` };
}

// Whether and why forces are not what the walls ask for.
export function faded(arm) {
  return finite(arm?.gain) && arm.gain < FADED
    ? `The operator is let go: ${Math.round(100 * Math.max(0, arm.gain))} % of his force`
    : "";
}
