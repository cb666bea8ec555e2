// SPDX-License-Identifier: BSD-3-Clause
// What people call a body: a link with all its parts, or an obstacle, of however many convex parts
// it is made.

import { state } from "./state.js";

// { id, name, kind: tool, link or obstacle, arm, body, parts: indices }, in the order of the scene.
export function bodiesOf(scene) {
  const found = new Map();
  scene.parts.forEach((part, k) => {
    const fixed = part.group === "obstacle";
    const kind = ["tool", "link"].includes(part.group) ? part.group : "obstacle";
    const name = fixed ? part.of || part.name : scene.bodies[part.body] || part.name;
    const id = `${part.body} ${fixed ? name : ""}`;
    if (!found.has(id)) {
      found.set(id, { id, name, kind, arm: part.arm, body: part.body, parts: [] });
    }
    found.get(id).parts.push(k);
  });
  return [...found.values()];
}

// What a part is called: its own name where it is one of several things on a link, that of the
// whole where it is one piece of a mesh, or one of the numbered pieces of a link.
export function partName(index) {
  const part = state.scene?.parts[index];
  if (!part) return "?";
  const whole = state.scene.bodies[part.body];
  const isNumbered = part.name.startsWith(`${whole}_`) &&
    /^\d+$/.test(part.name.slice(whole.length + 1));
  return part.of || (isNumbered ? whole : part.name);
}

const bodyOf = (index) => state.scene?.parts[index]?.body;

// The near pairs, those between the same two things taken together, whatever pieces of these
// meet: { pairs: the nearest first, force: the length of their sum [N] }. `own`: parts that are one
// thing.
export function together(pairs, own = new Set()) {
  const groups = new Map();
  const name = (index) => (own.has(index) ? "own" : `${bodyOf(index)} ${partName(index)}`);
  for (const pair of pairs) {
    const [a, b] = state.scene?.pairs[pair.i] ?? [];
    const names = [name(a), name(b)];
    const sign = names[0] <= names[1] ? 1 : -1;
    const key = names.sort().join("|");
    if (!groups.has(key)) groups.set(key, { pairs: [], sum: [0, 0, 0] });
    const group = groups.get(key);
    group.pairs.push(pair);
    pair.n?.forEach((x, k) => (group.sum[k] += sign * pair.f * x));
  }
  return [...groups.values()].map(({ pairs: all, sum }) => ({ pairs: all,
                                                              force: Math.hypot(...sum) }));
}

// The sum of what pushes these parts [N], as a length. What pushes one off another adds nothing.
export function pushOn(own, pairs) {
  const sum = [0, 0, 0];
  for (const pair of pairs) {
    const [a, b] = state.scene?.pairs[pair.i] ?? [];
    const sign = Number(own.has(a)) - Number(own.has(b));
    pair.n?.forEach((x, k) => (sum[k] += sign * pair.f * x));
  }
  return Math.hypot(...sum);
}
