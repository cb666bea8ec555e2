// SPDX-License-Identifier: BSD-3-Clause
// One body closely: what it is, where it is, what it pushes with, and what it is near. It is chosen
// by a click in the scene or in the list of the bodies.

import { partName, pushOn, together } from "./bodies.js";
import { state } from "./state.js";
import { at, brief, finite, fixed, mm, write } from "./words.js";

const MOST_NEAR = 6;
const DEGREES = 180 / Math.PI;

// Roll, pitch and yaw [deg] of a pose, as in URDF.
export function anglesOf([, , , x, y, z, w]) {
  const roll = Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y));
  const pitch = Math.asin(Math.max(-1, Math.min(1, 2 * (w * y - z * x))));
  const yaw = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  return [roll, pitch, yaw].map((angle) => DEGREES * angle);
}

// What laws say, a line for each kind: a number, or the least and the greatest.
export function lawsInWords(laws) {
  const kinds = new Map();
  for (const law of laws) {
    const kind = law.passable ? "membrane" : law.hard ? "hard wall" : "wall";
    if (!kinds.has(kind)) kinds.set(kind, []);
    kinds.get(kind).push(law);
  }
  return [...kinds].map(([kind, same]) => {
    const span = (name, say) => {
      const all = same.map((law) => law[name]).filter(finite).map(Number);
      const ends = [Math.min(...all), Math.max(...all)].map(say);
      return all.length === 0 ? "" : [...new Set(ends)].join(" to ");
    };
    const most = span("ceiling_n", brief);
    return `${kind}: from ${span("range_m", (x) => mm(x, 0))} mm on, ` +
      `${span("surface_force_n", brief)} N at the surface${most && `, at most ${most} N`}, ` +
      `damping ${span("damping_ns_m", brief)} N s/m`;
  });
}

const KINDS = { tool: "tool", link: "link of the arm", obstacle: "obstacle" };

export class Inspector {
  #body = null;

  // `close()` hears that it is to be left.
  constructor(parts, close) {
    this.parts = parts;
    at("inspect-close").addEventListener("click", close);
  }

  get body() {
    return this.#body;
  }

  choose(body) {
    this.#body = body;
    this.parts.select(body?.parts ?? []);
    at("inspect").hidden = body === null;
    if (body === null) return;
    const { scene } = state;
    write(at("inspect-name"), body.name);
    const count = body.parts.length;
    const own = body.parts.map((k) => scene.parts[k]);
    write(at("inspect-what"), `${KINDS[body.kind]}, ` +
      (count === 1 ? "one convex part" : `${count} convex parts`));
    const drawn = body.parts.filter((k) => this.parts.isDrawn(k));
    const cornersOf = (k) => (scene.parts[k].levels[0]?.vertices.length ?? 0) / 3;
    const corners = drawn.reduce((sum, k) => sum + cornersOf(k), 0);
    const levels = Math.max(0, ...own.map((part) => part.levels.length));
    const size = this.parts.sizeOf(drawn).map((x) => mm(x, 0)).join(" \u00d7 ");
    const left = body.parts.length - drawn.length;
    write(at("inspect-shape"),
          (drawn.length > 0 ? `${size} mm, ${corners} corners drawn, ${levels} levels` : "") +
          (left > 0 ? `${drawn.length > 0 ? "; " : ""}${left} of its parts not drawn` : ""));
    const index = new Set(body.parts);
    const laws = new Set(scene.pairs.filter((pair) => pair && (index.has(pair[0]) ||
      index.has(pair[1]))).map((pair) => pair[3]).filter(Number.isInteger));
    const words = lawsInWords([...laws].map((k) => scene.laws[k]).filter(Boolean));
    write(at("inspect-law"), words.join("\n") || "meets nothing");
    this.frame();
  }

  frame() {
    const body = this.#body;
    const { frame } = state;
    if (!body || !frame) return;
    const pose = this.parts.poseOf(body.parts[0]);
    const place = pose ? `${pose.slice(0, 3).map((x) => mm(x)).join(", ")} mm` : "\u2013";
    const turn = pose ? `${anglesOf(pose).map((x) => fixed(x, 1)).join(", ")}\u00b0` : "";
    write(at("inspect-pose"), frame.absent.includes(body.body) ? "not there" : place);
    write(at("inspect-turn"), turn);
    const own = new Set(body.parts);
    const near = frame.pairs.filter((pair) => state.scene.pairs[pair.i]?.slice(0, 2)
      .some((k) => own.has(k)));
    write(at("inspect-distance"), near.length > 0 ? `${mm(near[0].d)} mm` : "nothing near");
    const groups = together(near, own).slice(0, MOST_NEAR);
    write(at("inspect-force"), `${fixed(pushOn(own, near), 1)} N`);
    const rows = groups.map(({ pairs, force }) => {
      const [a, b] = state.scene.pairs[pairs[0].i];
      const pieces = pairs.length > 1 ? ` (${pairs.length} pairs)` : "";
      return `${partName(own.has(a) ? b : a)}: ${mm(pairs[0].d)} mm, ${fixed(force, 1)} N${pieces}`;
    });
    write(at("inspect-near"), rows.join("\n") || "\u2013");
  }
}
