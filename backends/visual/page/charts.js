// SPDX-License-Identifier: BSD-3-Clause
// Charts of any signals over the last minute, by uPlot, which is loaded with the first of them. They
// share pause, zoom and the moment at the pointer.

import { save } from "./capture.js";
import { set, settings } from "./settings.js";
import { signalNames, unitOf } from "./signals.js";
import { state } from "./state.js";
import { colour, onTheme } from "./theme.js";
import { at, brief } from "./words.js";

const TINTS = ["operator", "force", "fixture", "level", "near", "far"];
const MOST = 8;  // charts
const HEIGHT = 150;
const FIRST = [["force_n"], ["nearest_m"]];
const SPAN_S = 20;  // what is seen until it is zoomed

let loading = null;

// Once, when it is needed: the page is seen sooner without it.
function uPlotLoaded() {
  loading ??= new Promise((done, failed) => {
    const style = document.head.appendChild(document.createElement("link"));
    style.rel = "stylesheet";
    style.href = "vendor/uplot.css";
    const script = document.head.appendChild(document.createElement("script"));
    script.src = "vendor/uplot.min.js";
    script.onload = () => done(globalThis.uPlot);
    script.onerror = failed;
  });
  return loading;
}

export class Charts {
  #charts = [];  // { names, element, plot }
  #wanted = null;  // names by chart, until the page of the charts is seen
  #elsewhere = [];  // names of charts whose signals another scene or arm has
  #held = null;  // what was known when it was paused
  #zoom = null;  // [from, to] in seconds; null: the last seconds
  #all = false;  // without a zoom all that is known is seen
  #zooming = false;

  constructor(history) {
    this.history = history;
    at("chart-add").addEventListener("click", () => {
      this.#add([]);
      this.#keep();
    });
    at("chart-pause").addEventListener("click", () => this.#pause(this.#held === null));
    onTheme(() => this.#charts.forEach((chart) => this.#draw(chart)));
  }

  // What is drawn, for a link to this page.
  get names() {
    return this.#charts.map(({ names }) => names);
  }

  get paused() {
    return this.#held !== null;
  }

  // For tests: numbers in the first chart.
  get points() {
    return this.#charts[0]?.plot?.data[0].length ?? 0;
  }

  // Another scene or arm has other signals; `names` are wanted, those that it has.
  arm(names = settings.charts) {
    for (const { plot, element } of this.#charts) {
      plot?.destroy();
      element.remove();
    }
    this.#charts.length = this.#elsewhere.length = 0;
    this.#pause(false);
    this.#wanted = Array.isArray(names) && names.length > 0 ? names : FIRST;
  }

  frame() {
    if (at("pane-charts").hidden) return;
    for (const names of this.#wanted?.filter(Array.isArray) ?? []) this.#restore(names);
    this.#wanted = null;
    if (this.#held) return;
    for (const chart of this.#charts) this.#show(chart);
  }

  // A chart as it was kept; signals that are not known here are kept for where they are.
  #restore(names) {
    const known = new Set(signalNames());
    const here = names.filter((name) => known.has(name)).slice(0, TINTS.length);
    const missing = names.filter((name) => !known.has(name));
    if (this.#charts.length < MOST && (here.length > 0 || names.length === 0)) {
      this.#add(here, missing);
    } else this.#elsewhere.push(names);
  }

  #pause(yes) {
    this.#held = yes ? this.history.held() : null;
    if (!yes) this.#zoom = null;
    at("chart-pause").setAttribute("aria-pressed", String(yes));
    at("chart-pause").textContent = yes ? "Go on" : "Hold";
  }

  #columns(chart) {
    return (this.#held ?? this.history).columns(chart.names);
  }

  #add(names, missing = []) {
    const element = at("charts").appendChild(document.createElement("figure"));
    const chart = { names, missing, element, plot: null };
    this.#charts.push(chart);
    const head = element.appendChild(document.createElement("figcaption"));
    const choice = head.appendChild(document.createElement("select"));
    choice.setAttribute("aria-label", "signal to draw or to take out");
    choice.append(new Option("add or take out a signal", ""));
    for (const name of signalNames()) choice.append(new Option(name, name));
    choice.addEventListener("change", () => this.#toggle(chart, choice));
    const button = (text, title, press) => {
      const made = head.appendChild(document.createElement("button"));
      Object.assign(made, { type: "button", textContent: text, title });
      made.addEventListener("click", press);
    };
    button("PNG", "Save the picture of this chart", () => this.#png(chart));
    button("CSV", "Save the numbers of this chart", () => this.#csv(chart));
    button("\u00d7", "Take this chart away", () => this.#remove(chart));
    chart.holder = element.appendChild(document.createElement("div"));
    chart.holder.tabIndex = 0;
    chart.holder.setAttribute("role", "group");
    chart.holder.setAttribute("aria-label", "Chart. Arrow keys: the moment that is told; " +
                                            "+ and \u2212: zoom; 0: all");
    chart.holder.addEventListener("keydown", (event) => this.#key(chart, event));
    at("chart-add").disabled = this.#charts.length === MOST;
    this.#draw(chart);
  }

  #remove(chart) {
    chart.plot?.destroy();
    chart.element.remove();
    this.#charts.splice(this.#charts.indexOf(chart), 1);
    at("chart-add").disabled = false;
    this.#keep();
  }

  #toggle(chart, choice) {
    const name = choice.value;
    choice.value = "";
    if (chart.names.includes(name)) chart.names = chart.names.filter((other) => other !== name);
    else if (chart.names.length < TINTS.length) chart.names = [...chart.names, name];
    this.#keep();
    this.#draw(chart);
  }

  #keep() {
    set("charts", [...this.#charts.map(({ names, missing }) => [...names, ...missing]),
                   ...this.#elsewhere]);
  }

  async #draw(chart) {
    const uPlot = await uPlotLoaded();
    chart.plot?.destroy();
    if (!chart.element.isConnected) return;
    const axis = { stroke: colour("dim"), grid: { stroke: colour("rule"), width: 1 },
                   ticks: { show: false }, font: "10px system-ui" };
    const units = [...new Set(chart.names.map(unitOf))];
    const series = chart.names.map((name, k) => ({
      label: name, stroke: colour(TINTS[k]), width: 1.5, scale: unitOf(name) || "one",
      value: (_, value) => (value == null ? "\u2013" : `${brief(value)} ${unitOf(name)}`),
    }));
    chart.plot = new uPlot({
      width: this.#width(chart), height: HEIGHT, ms: 1e-3,
      scales: { x: { time: false } },
      series: [{ label: "time", value: (_, t) => (t === null ? "\u2013" : `${t.toFixed(3)} s`) },
               ...series],
      axes: [{ ...axis, size: 26, values: (_, all) => all.map((t) => `${t} s`) },
             ...units.slice(0, 2).map((unit, k) => ({
               ...axis, scale: unit || "one", side: k === 0 ? 3 : 1, size: 46, label: unit || "1",
               labelSize: 14, labelFont: "10px system-ui", values: (_, all, __, ___, step) =>
                 all.map((y) => y.toFixed(Math.max(0, Math.ceil(-Math.log10(step) - 1e-9)))),
             }))],
      cursor: { sync: { key: "repel" }, drag: { x: true, y: false } },
      hooks: { setSelect: [(plot) => this.#zoomed(plot)] },
    }, this.#columns(chart), chart.holder);
    chart.plot.over.addEventListener("dblclick", () => this.#whole());
    this.#show(chart);
  }

  #width({ element }) {
    return Math.max(120, element.clientWidth);
  }

  #zoomed(plot) {
    const { left, width } = plot.select;
    if (!(width > 2) || this.#zooming) return;
    this.#look(plot.posToVal(left, "x"), plot.posToVal(left + width, "x"));
  }

  // What is zoomed is held: it would run out of the picture.
  #look(from, to) {
    if (!this.#held) this.#pause(true);
    this.#zoom = [from, to];
    this.#zooming = true;
    this.#charts.forEach((chart) => this.#show(chart));
    this.#zooming = false;
  }

  // As the pointer does: to the moment before or after, and nearer or farther around it.
  #key({ plot }, event) {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const factor = { "+": 0.5, "-": 2 }[event.key];
    if (!plot || event.ctrlKey || !(step || factor || event.key === "0")) return;
    event.preventDefault();
    event.stopPropagation();
    if (event.key === "0") return this.#whole();
    const { min, max } = plot.scales.x;
    const { left } = plot.cursor;
    const width = plot.over.clientWidth;
    const place = left >= 0 ? left : width / 2;
    if (step) {
      const to = Math.max(0, Math.min(width, place + (step * width) / 100));
      plot.setCursor({ left: to, top: HEIGHT / 2 });
      return;
    }
    const middle = plot.posToVal(place, "x");
    this.#look(middle - factor * (middle - min), middle + factor * (max - middle));
  }

  // All that is known, or the last seconds again.
  #whole() {
    this.#all = this.#zoom !== null || !this.#all;
    this.#zoom = null;
    this.#charts.forEach((chart) => this.#show(chart));
  }

  #show(chart) {
    const { plot } = chart;
    if (!plot) return;
    const width = this.#width(chart);
    if (width !== plot.width) plot.setSize({ width, height: HEIGHT });
    const columns = this.#columns(chart);
    const last = columns[0].at(-1) ?? 0;
    const first = columns[0][0] ?? 0;
    const [min, max] = this.#zoom ?? [this.#all ? first : Math.max(first, last - SPAN_S), last];
    plot.batch(() => {
      plot.setData(columns, false);
      plot.setScale("x", { min, max: Math.max(max, min + 1e-3) });
    });
  }

  // With its names above it, in their colours.
  #png({ names, plot }) {
    const { canvas } = plot.ctx;
    const line = Math.round((18 * canvas.width) / plot.width);
    const title = [state.scene?.name ?? "repel", ...names];
    const picture = document.createElement("canvas");
    Object.assign(picture, { width: canvas.width, height: canvas.height + line * title.length });
    const context = picture.getContext("2d");
    context.fillStyle = colour("card");
    context.fillRect(0, 0, picture.width, picture.height);
    context.font = `${Math.round(0.66 * line)}px system-ui, sans-serif`;
    context.textBaseline = "middle";
    title.forEach((words, k) => {
      context.fillStyle = colour(k === 0 ? "ink" : TINTS[k - 1]);
      context.fillText(words, line / 2, line * (k + 0.5));
    });
    context.drawImage(canvas, 0, line * title.length);
    picture.toBlob((blob) => save(blob, `${names.join("_") || "chart"}.png`));
  }

  #csv(chart) {
    const [times, ...values] = this.#columns(chart);
    const rows = times.map((time, k) => [time, ...values.map((all) => all[k] ?? "")].join(","));
    const text = [["time_s", ...chart.names].join(","), ...rows].join("\n");
    const name = `${state.scene?.name ?? "repel"}_${chart.names.join("_") || "time"}.csv`;
    save(new Blob([`${text}\n`], { type: "text/csv" }), name);
  }
}
