// SPDX-License-Identifier: BSD-3-Clause
// Where on the picture of the scene nothing lies.

const LYING = ".top > *, .foot > *, .sticks > *, .tour";
const GAP = 8;  // around it [px]

// The rectangles { x, y, width, height } [px] of an element that reach from what lies on it, or the
// rim, to what lies on it.
export function openings(view) {
  const whole = view.getBoundingClientRect();
  const cards = [...view.querySelectorAll(LYING)].map((card) => card.getBoundingClientRect())
    .filter(({ width }) => width > 0)
    .map(({ left, right, top, bottom }) => ({
      left: left - whole.left - GAP, right: right - whole.left + GAP,
      top: top - whole.top - GAP, bottom: bottom - whole.top + GAP }));
  const found = [];
  for (const left of [0, ...cards.map((card) => card.right)]) {
    for (const right of [whole.width, ...cards.map((card) => card.left)]) {
      const across = cards.filter((card) => card.left < right && card.right > left);
      for (const top of [0, ...across.map((card) => card.bottom)]) {
        const below = across.filter((card) => card.bottom > top).map((card) => card.top);
        const height = Math.min(whole.height, ...below) - top;
        const width = right - left;
        if (width > 0 && height > 0) found.push({ x: left, y: top, width, height });
      }
    }
  }
  return found.length > 0 ? found : [{ x: 0, y: 0, width: whole.width, height: whole.height }];
}
