// SPDX-License-Identifier: BSD-3-Clause
// A click in the scene, and what it hit: the nearest of what is seen, and glass only where nothing
// else is. Another click at the same place hits what is behind. A drag is no click.

import { Raycaster, Vector2 } from "./vendor/three.min.js";

const STILL_PX = 5;

// `hit({ part, body, point })` hears of every click; each is null where the click met nothing. A
// link that is drawn as it looks is met there: then `part` is null and `body` says which it is.
export function startPicking(stage, parts, visuals, hit) {
  const ray = new Raycaster();
  const pointer = new Vector2();
  let from = null;
  let again = { x: 0, y: 0, count: -1 };  // clicks at that place [px]
  stage.canvas.addEventListener("pointerdown", (event) => {
    from = event.button === 0 && event.isPrimary ? [event.clientX, event.clientY] : null;
  });
  stage.canvas.addEventListener("pointerup", (event) => {
    const moved = from ? Math.hypot(event.clientX - from[0], event.clientY - from[1]) : Infinity;
    from = null;
    if (moved > STILL_PX) return;
    const box = stage.canvas.getBoundingClientRect();
    pointer.set(((event.clientX - box.left) / box.width) * 2 - 1,
                1 - ((event.clientY - box.top) / box.height) * 2);
    ray.setFromCamera(pointer, stage.camera);
    const solids = parts.seenSolids();
    const looks = visuals.seenMeshes();
    const met = new Map();  // by link or obstacle: where it is met first
    for (const { object, point } of ray.intersectObjects([...solids.keys(), ...looks.keys()],
                                                         false)) {
      const part = solids.get(object) ?? null;
      const { body, group } = part === null ? { body: looks.get(object) } : parts.parts[part];
      const key = group === "obstacle" ? object : body;
      if (!met.has(key)) met.set(key, { part, body, point, glass: 1 });
      if (!object.material.transparent) met.get(key).glass = 0;
    }
    const all = [...met.values()].sort((a, b) => a.glass - b.glass);
    const { clientX: x, clientY: y } = event;
    const same = Math.hypot(x - again.x, y - again.y) <= STILL_PX;
    again = { x, y, count: same ? again.count + 1 : 0 };
    hit(all[again.count % all.length] ?? { part: null, body: null, point: null });
  });
}
