// SPDX-License-Identifier: BSD-3-Clause
// A click in the scene, and what it hit: the nearest of what is seen. A drag is no click.

import { Raycaster, Vector2 } from "./vendor/three.min.js";

const STILL_PX = 5;

// `hit({ part, body, point })` hears of every click; each is null where the click met nothing. A
// link that is drawn as it looks is met there: then `part` is null and `body` says which it is.
export function startPicking(stage, parts, visuals, hit) {
  const ray = new Raycaster();
  const pointer = new Vector2();
  let from = null;
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
    const [first] = ray.intersectObjects([...solids.keys(), ...looks.keys()], false);
    const part = solids.get(first?.object) ?? null;
    const body = part === null ? looks.get(first?.object) ?? null : parts.parts[part].body;
    hit({ part, body, point: first?.point ?? null });
  });
}
