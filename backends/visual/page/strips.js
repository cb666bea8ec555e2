// SPDX-License-Identifier: BSD-3-Clause
// Strip charts: a quantity over the last ten seconds, with what it was where the pointer is. On a
// canvas of their own and not by uPlot: the history is a ring of up to 200000 ticks, of which each
// column of pixels shows the least and the greatest; uPlot would want it copied in order each time.

import { colour } from "./theme.js";
import { fixed, write } from "./words.js";

const MARGIN = { left: 34, right: 4, top: 14, bottom: 15 };
const LABEL = 11;  // height of a number at the axis [px]

// From a distance [mm] to where it is on the axis: even below 2 mm, logarithmic above, so that the
// last 20 mm keep at least half of the height when something is 300 mm away.
const SOFT = 2;
export const bent = (mm) => Math.asinh(mm / SOFT);
const TICKS = [0, 20, 5, 100, 1, 500, 2000, -5, -20, -1, -100];  // who has room first [mm]
const LEAST_TOP = 20;
const LEAST_BOTTOM = -0.7;  // a little below what touches

const minus = (text) => text.replace("-", "\u2212");

// A canvas as large as it is shown, in the pixels of the screen; its size in CSS pixels.
export function fitted(canvas) {
  const ratio = Math.min(devicePixelRatio || 1, 3);
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  const context = canvas.getContext("2d");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  context.font = `10px ${getComputedStyle(document.body).fontFamily}`;
  return { context, width, height };
}

// The next of 1, 2, 5 times a power of ten.
function nice(x) {
  const power = 10 ** Math.floor(Math.log10(x));
  return [1, 2, 5, 10].find((k) => k * power >= x * 0.999) * power;
}

let hovered = null;  // how long ago the pointer is, in seconds; shared by all strips

export class Strip {
  zone = 0;  // up to here from zero obstacles push, in the unit shown

  // `series`: of the history; `scale`: from its unit to the one shown; `least`: the smallest span;
  // `bends`: the axis is that of a distance, see above.
  constructor({ canvas, value, history, series, scale, unit, tint, least, bends = false }) {
    Object.assign(this, { canvas, value, history, series, scale, unit, tint, least, bends });
    canvas.addEventListener("pointermove", (event) => {
      const across = canvas.clientWidth - MARGIN.left - MARGIN.right;
      const share = (event.offsetX - MARGIN.left) / across;
      hovered = history.seconds * (1 - Math.max(0, Math.min(1, share)));
    });
    canvas.addEventListener("pointerleave", () => (hovered = null));
  }

  draw() {
    const { context, width, height } = fitted(this.canvas);
    const box = { x: MARGIN.left, y: MARGIN.top, w: width - MARGIN.left - MARGIN.right,
                  h: height - MARGIN.top - MARGIN.bottom };
    if (box.w < 10 || box.h < 10 || !this.history.rate) return;
    const columns = this.#columns(Math.floor(box.w));
    const { low, high, ticks } = this.bends ? this.#bentSpan(columns) : this.#span(columns);
    const on = this.bends ? bent : (value) => value;
    const y = (value) => box.y + (box.h * (on(high) - on(value))) / (on(high) - on(low));
    this.span = { low, high };
    this.#zones(context, box, low, y);
    this.#grid(context, box, ticks, y);
    this.#curve(context, box, columns, y);
    this.#readout(context, box, y);
  }

  // Least and largest of the ticks in each column of pixels.
  #columns(count) {
    const { history } = this;
    const lows = new Float32Array(count).fill(Infinity);
    const highs = new Float32Array(count).fill(-Infinity);
    const values = history[this.series];
    const start = history.now - history.seconds;
    for (let i = 0; i < history.length; ++i) {
      const slot = history.slot(i);
      const value = values[slot] * this.scale;
      if (!Number.isFinite(value)) continue;
      const k = Math.floor(((history.time[slot] - start) / history.seconds) * (count - 1));
      if (k < 0 || k >= count) continue;
      if (value < lows[k]) lows[k] = value;
      if (value > highs[k]) highs[k] = value;
    }
    return { lows, highs, count };
  }

  #extremes({ lows, highs, count }, low, high) {
    for (let k = 0; k < count; ++k) {
      if (lows[k] < low) low = lows[k];
      if (highs[k] > high) high = highs[k];
    }
    return { low, high };
  }

  #span(columns) {
    const { low, high } = this.#extremes(columns, 0, this.least);
    const step = nice((high - low) / 3);
    const first = Math.floor(low / step);
    const last = Math.ceil(high / step);
    const ticks = Array.from({ length: last - first + 1 }, (_, k) => (first + k) * step);
    return { low: first * step, high: last * step, ticks };
  }

  #bentSpan(columns) {
    const { low, high } = this.#extremes(columns, LEAST_BOTTOM, LEAST_TOP);
    return { low, high, ticks: TICKS.filter((tick) => tick >= low && tick <= high) };
  }

  // Where obstacles push, and where parts overlap.
  #zones(context, box, low, y) {
    if (!this.bends) return;
    const band = (from, to, name) => {
      context.fillStyle = colour(name);
      context.globalAlpha = 0.14;
      context.fillRect(box.x, y(to), box.w, Math.max(0, y(from) - y(to)));
      context.globalAlpha = 1;
    };
    band(0, Math.min(this.zone, this.span.high), "near");
    band(low, 0, "overlap");
    if (!(this.zone > 0) || this.zone > this.span.high) return;
    context.strokeStyle = colour("near");
    context.setLineDash([4, 3]);
    context.beginPath();
    context.moveTo(box.x, Math.round(y(this.zone)) + 0.5);
    context.lineTo(box.x + box.w, Math.round(y(this.zone)) + 0.5);
    context.stroke();
    context.setLineDash([]);
  }

  #grid(context, box, ticks, y) {
    context.strokeStyle = colour("rule");
    context.fillStyle = colour("dim");
    context.lineWidth = 1;
    context.textAlign = "right";
    context.textBaseline = "middle";
    const rows = [];
    for (const value of ticks) {
      const row = Math.round(y(value)) + 0.5;
      if (rows.some((other) => Math.abs(other - row) < LABEL)) continue;
      rows.push(row);
      context.strokeStyle = colour(value === 0 ? "dim" : "rule");
      context.beginPath();
      context.moveTo(box.x, row);
      context.lineTo(box.x + box.w, row);
      context.stroke();
      context.fillText(minus(Number(value.toPrecision(6)).toString()), box.x - 5, row);
    }
    context.textBaseline = "alphabetic";
    context.fillText(this.unit, box.x - 5, 8);
    const { seconds } = this.history;
    context.textAlign = "left";
    context.fillText(`\u2212${seconds} s`, box.x, box.y + box.h + 12);
    context.textAlign = "center";
    context.fillText(`\u2212${seconds / 2} s`, box.x + box.w / 2, box.y + box.h + 12);
    context.textAlign = "right";
    context.fillText("now", box.x + box.w, box.y + box.h + 12);
  }

  // Broken where a column has no value.
  #curve(context, box, { lows, highs, count }, y) {
    context.strokeStyle = colour(this.tint);
    context.lineWidth = 1.5;
    context.lineJoin = "round";
    context.beginPath();
    let last = -9;
    for (let k = 0; k < count; ++k) {
      if (lows[k] > highs[k]) continue;
      if (k - last > 3) context.moveTo(box.x + k, y(highs[k]));
      context.lineTo(box.x + k, y(highs[k]));
      context.lineTo(box.x + k, y(lows[k]));
      last = k;
    }
    context.stroke();
  }

  #readout(context, box, y) {
    const { history } = this;
    const slot = history.find(history.now - (hovered ?? 0));
    const value = slot < 0 ? NaN : history[this.series][slot] * this.scale;
    const number = Number.isFinite(value) ? `${fixed(value, 1)} ${this.unit}` : "nothing near";
    const when = hovered === null ? "" : `, ${hovered.toFixed(2)} s ago`;
    write(this.value, history.length === 0 ? "" : number + when);
    if (hovered === null) return;
    const x = box.x + box.w * (1 - hovered / history.seconds);
    context.strokeStyle = colour("ink");
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(x, box.y);
    context.lineTo(x, box.y + box.h);
    context.stroke();
    if (!Number.isFinite(value)) return;
    context.fillStyle = colour("ink");
    context.beginPath();
    context.arc(x, y(value), 3, 0, 2 * Math.PI);
    context.fill();
  }
}
