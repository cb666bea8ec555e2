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
// whole where it is one piece of a mesh.
export const partName = (index) => {
  const part = state.scene?.parts[index];
  return part ? part.of || part.name : "?";
};

// The near pairs, those between the pieces of two meshes taken together: { pairs: the nearest
// first, force: the length of their sum [N] }.
export function together(pairs) {
  const groups = new Map();
  for (const pair of pairs) {
    const [a, b] = state.scene?.pairs[pair.i] ?? [];
    const name = (index) => {
      const part = state.scene?.parts[index];
      return part?.of ? `${part.body} ${part.of}` : index;
    };
    const key = `${name(a)}|${name(b)}`;
    if (!groups.has(key)) groups.set(key, { pairs: [], sum: [0, 0, 0] });
    const group = groups.get(key);
    group.pairs.push(pair);
    pair.n?.forEach((x, k) => (group.sum[k] += pair.f * x));
  }
  return [...groups.values()].map(({ pairs: all, sum }) => ({ pairs: all,
                                                              force: Math.hypot(...sum) }));
}
