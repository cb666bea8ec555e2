// SPDX-License-Identifier: BSD-3-Clause
// The joints of the arm that is shown: where each is between its ends, how fast and how hard it
// moves, as shares of what it may; and what hard walls hold.

import { partName } from "./bodies.js";
import { signalNow } from "./signals.js";
import { state, thisArm, thisArmNow } from "./state.js";
import { at, brief, finite, fixed, mm, write } from "./words.js";

const DEGREES = 180 / Math.PI;
const NEAR_END = 0.9;  // share of the greatest from which a bar warns

// A bar, its number, and `ends`: what it may be.
function track(row, ends) {
  const cell = row.insertCell();
  const bar = cell.appendChild(document.createElement("div"));
  bar.className = "joint-track";
  const fill = bar.appendChild(document.createElement("i"));
  const value = cell.appendChild(document.createElement("output"));
  cell.appendChild(document.createElement("small")).textContent = ends;
  return { fill, value };
}

export class Joints {
  #rows = [];

  // Another arm is shown, or another scene.
  arm() {
    const limits = thisArm()?.limits ?? [];
    at("joint-rows").replaceChildren();
    at("joints-none").hidden = limits.length > 0;
    this.#rows = limits.map((limit, k) => {
      const turns = thisArm().joints[k] !== "prismatic";
      const row = at("joint-rows").insertRow();
      const name = row.appendChild(document.createElement("th"));
      name.scope = "row";
      name.textContent = name.title = limit.name || `joint ${k + 1}`;
      const say = (x) => (finite(x) ? turns ? `${fixed(DEGREES * x, 0)}\u00b0` : `${mm(x, 0)} mm`
                                    : "\u221e");
      const most = (x, unit) => (finite(x) ? `of ${brief(x)} ${unit}` : unit);
      return { limit, turns, position: track(row, `${say(limit.lower)} to ${say(limit.upper)}`),
               rate: track(row, most(limit.rate, turns ? "rad/s" : "m/s")),
               effort: track(row, most(limit.effort, turns ? "N m" : "N")) };
    });
  }

  frame() {
    this.#rows.forEach(({ limit, turns, position, rate, effort }, k) => {
      const n = k + 1;
      const q = signalNow(turns ? `q${n}_rad` : `q${n}_m`);
      const v = signalNow(turns ? `v${n}_rad_s` : `v${n}_m_s`);
      const tau = signalNow(turns ? `tau${n}_nm` : `tau${n}_n`);
      write(position.value, turns ? `${fixed(DEGREES * q, 1)}\u00b0` : `${mm(q)} mm`);
      const share = (q - limit.lower) / (limit.upper - limit.lower);
      point(position.fill, finite(limit.lower) && finite(limit.upper) ? share : null);
      write(rate.value, brief(v));
      fill(rate.fill, v, limit.rate);
      write(effort.value, brief(tau));
      fill(effort.fill, tau, limit.effort);
    });
    this.#hold(thisArmNow()?.hold);
  }

  #hold(hold) {
    at("hold").hidden = !hold;
    if (!hold) return;
    const pair = state.scene?.pairs[hold.pair] ?? [];
    write(at("hold-pair"), pair.slice(0, 2).map(partName).join(" \u2013 "));
    write(at("hold-margin"), `${mm(hold.margin_m, 2)} mm`);
    at("hold-margin").classList.toggle("bad", hold.margin_m < 0);
    write(at("hold-force"), `${fixed(hold.force_n, 1)} N`);
  }
}

// A mark where the joint is between its ends; none where it has no end.
function point(element, share) {
  const there = finite(share);
  element.hidden = !there;
  if (!there) return;
  const within = Math.max(0, Math.min(1, share));
  element.className = `mark${Math.abs(2 * within - 1) > NEAR_END ? " warn" : ""}`;
  element.style.left = `${(100 * within).toFixed(1)}%`;
}

// A bar from the middle to where the share of the greatest is.
function fill(element, value, most) {
  const share = finite(value) && finite(most) ? Math.max(-1, Math.min(1, value / most)) : 0;
  element.className = Math.abs(share) > NEAR_END ? "warn" : "";
  element.style.transform = `scaleX(${share.toFixed(3)})`;
}
