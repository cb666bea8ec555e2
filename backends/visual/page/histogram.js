// SPDX-License-Identifier: BSD-3-Clause
// How long ticks computed and how late they woke, as histograms on a logarithmic axis, with the
// deadline. Counts are logarithmic too: the rare late tick is what one looks for.

import { state } from "./state.js";
import { fitted } from "./strips.js";
import { colour } from "./theme.js";
import { at, brief, finite, write } from "./words.js";

const BOTTOM = 15;
const LEFT = 1;  // [us]

const name = (us) => (us >= 1000 ? `${us / 1000} ms` : `${us} us`);

export class Histogram {
  constructor(canvas) {
    this.canvas = canvas;
  }

  draw() {
    const timing = state.timing;
    const { context, width, height } = fitted(this.canvas);
    const edges = timing?.edges_us ?? [];
    if (edges.length < 2 || width < 10) return;
    const period = state.scene?.period_us ?? 1000;
    const right = Math.max(2 * period, 1.2 * (timing.late_us.max ?? 0),
                           1.2 * (timing.compute_us.max ?? 0));
    const x = (us) => (width * Math.log(Math.max(us, LEFT) / LEFT)) / Math.log(right / LEFT);
    const floor = height - BOTTOM;
    this.#axis(context, x, right, floor, width);
    this.#bars(context, edges, timing.late, x, floor, colour("late"));
    this.#bars(context, edges, timing.compute, x, floor, colour("compute"));
    this.#deadline(context, x(period), period, floor);
    this.#numbers(timing);
  }

  #axis(context, x, right, floor, width) {
    context.strokeStyle = colour("rule");
    context.fillStyle = colour("dim");
    context.lineWidth = 1;
    context.beginPath();
    for (let us = LEFT; us <= right; us *= 10) {
      context.moveTo(Math.round(x(us)) + 0.5, 0);
      context.lineTo(Math.round(x(us)) + 0.5, floor);
      const room = context.measureText(name(us)).width + 3;
      context.textAlign = x(us) + room > width ? "right" : "left";
      context.fillText(name(us), x(us) + (context.textAlign === "left" ? 2 : -2), floor + 12);
    }
    context.moveTo(0, floor + 0.5);
    context.lineTo(width, floor + 0.5);
    context.stroke();
  }

  #bars(context, edges, counts, x, floor, tint) {
    const most = Math.max(1, ...counts.filter(finite));
    const y = (count) => floor - ((floor - 6) * Math.log1p(count)) / Math.log1p(most);
    context.beginPath();
    let open = false;
    counts.forEach((count, k) => {
      if (!(count > 0) || !(edges[k + 1] > LEFT)) {
        if (open) context.lineTo(x(edges[k]), floor);
        open = false;
        return;
      }
      if (!open) context.moveTo(x(edges[k]), floor);
      context.lineTo(x(edges[k]), y(count));
      context.lineTo(x(edges[k + 1] ?? edges[k]), y(count));
      open = true;
    });
    if (open) context.lineTo(x(edges.at(-1)), floor);
    context.fillStyle = tint;
    context.strokeStyle = tint;
    context.globalAlpha = 0.35;
    context.fill();
    context.globalAlpha = 1;
    context.lineWidth = 1.25;
    context.stroke();
  }

  #deadline(context, x, period, floor) {
    context.strokeStyle = colour("bad");
    context.fillStyle = colour("bad");
    context.lineWidth = 1.5;
    context.setLineDash([4, 3]);
    context.beginPath();
    context.moveTo(x, 0);
    context.lineTo(x, floor);
    context.stroke();
    context.setLineDash([]);
    context.textAlign = "right";
    context.fillText(`deadline ${name(period)}`, x - 4, 9);
  }

  #numbers(timing) {
    const misses = `${timing.misses ?? "\u2013"} missed of ${timing.ticks ?? "\u2013"}`;
    const drops = timing.dropped > 0 ? `, ${timing.dropped} not shown here` : "";
    write(at("timing-counts"), misses + drops);
    for (const [row, values] of [["c", timing.compute_us], ["l", timing.late_us]]) {
      for (const [column, key] of [["50", "p50"], ["99", "p99"], ["max", "max"]]) {
        write(at(row + column), brief(values[key]));
      }
    }
  }
}
