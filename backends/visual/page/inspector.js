// SPDX-License-Identifier: BSD-3-Clause
// One body closely: what it is, where it is, what it pushes with, and what it is near. It is chosen
// by a click in the scene or in the list of the bodies.

import { partName, together } from "./bodies.js";
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

// What a law says, in a sentence.
export function lawInWords({ range_m, surface_force_n, damping_ns_m, ceiling_n, passable, hard }) {
  const kind = passable ? "membrane" : hard ? "hard wall" : "wall";
  const most = finite(ceiling_n) ? `, at most ${brief(ceiling_n)} N` : "";
  return `${kind}: from ${mm(range_m, 0)} mm on, ${brief(surface_force_n)} N at the surface${most}, ` +
    `damping ${brief(damping_ns_m)} N s/m`;
}

const KINDS = { tool: "tool", link: "link of the arm", obstacle: "obstacle" };

export class Inspector {
  #body = null;

  constructor(parts) {
    this.parts = parts;
    at("inspect-close").addEventListener("click", () => this.choose(null));
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
    const corners = own.reduce((sum, { levels }) => sum + (levels[0]?.vertices.length ?? 0) / 3, 0);
    const levels = Math.max(0, ...own.map((part) => part.levels.length));
    const size = this.parts.sizeOf(body.parts).map((x) => mm(x, 0)).join(" \u00d7 ");
    write(at("inspect-shape"), `${size} mm, ${corners} corners drawn, ${levels} levels`);
    const index = new Set(body.parts);
    const laws = new Set(scene.pairs.filter((pair) => pair && (index.has(pair[0]) ||
      index.has(pair[1]))).map((pair) => pair[3]).filter(Number.isInteger));
    const words = [...laws].map((k) => scene.laws[k]).filter(Boolean).map(lawInWords);
    write(at("inspect-law"), words.join("; ") || "meets nothing");
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
    const groups = together(near).slice(0, MOST_NEAR);
    const most = Math.max(0, ...groups.map(({ force }) => force));
    write(at("inspect-force"), `${fixed(most, 1)} N`);
    const rows = groups.map(({ pairs, force }) => {
      const [a, b] = state.scene.pairs[pairs[0].i];
      const pieces = pairs.length > 1 ? ` (${pairs.length} pairs)` : "";
      return `${partName(own.has(a) ? b : a)}: ${mm(pairs[0].d)} mm, ${fixed(force, 1)} N${pieces}`;
    });
    write(at("inspect-near"), rows.join("\n"));
  }
}
