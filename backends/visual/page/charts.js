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
const MOST = 8;  // charts at the start
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
  #held = null;  // the columns of each chart, from when it was paused
  #zoom = null;  // [from, to] in seconds; null: the last seconds
  #zooming = false;

  constructor(history) {
    this.history = history;
    at("chart-add").addEventListener("click", () => this.#add([]));
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
    this.#charts.length = 0;
    this.#pause(false);
    this.#wanted = Array.isArray(names) && names.length > 0 ? names : FIRST;
  }

  frame() {
    if (at("pane-charts").hidden) return;
    const known = new Set(signalNames());
    for (const some of this.#wanted?.filter(Array.isArray).slice(0, MOST) ?? []) {
      this.#add(some.filter((name) => known.has(name)).slice(0, TINTS.length));
    }
    this.#wanted = null;
    if (this.#held) return;
    for (const chart of this.#charts) this.#show(chart);
  }

  #pause(yes) {
    this.#held = yes ? this.#charts.map(({ names }) => this.history.columns(names)) : null;
    if (!yes) this.#zoom = null;
    at("chart-pause").setAttribute("aria-pressed", String(yes));
    at("chart-pause").textContent = yes ? "Go on" : "Hold";
  }

  #columns(chart) {
    return this.#held?.[this.#charts.indexOf(chart)] ?? this.history.columns(chart.names);
  }

  #add(names) {
    const element = at("charts").appendChild(document.createElement("figure"));
    const chart = { names, element, plot: null };
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
    this.#keep();
    this.#draw(chart);
  }

  #remove(chart) {
    chart.plot?.destroy();
    chart.element.remove();
    this.#held?.splice(this.#charts.indexOf(chart), 1);
    this.#charts.splice(this.#charts.indexOf(chart), 1);
    this.#keep();
  }

  #toggle(chart, choice) {
    const name = choice.value;
    choice.value = "";
    if (chart.names.includes(name)) chart.names = chart.names.filter((other) => other !== name);
    else if (chart.names.length < TINTS.length) chart.names = [...chart.names, name];
    if (this.#held) this.#held[this.#charts.indexOf(chart)] = this.history.columns(chart.names);
    this.#keep();
    this.#draw(chart);
  }

  #keep() {
    set("charts", this.names);
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
      value: (_, value) => (value === null ? "\u2013" : `${brief(value)} ${unitOf(name)}`),
    }));
    chart.plot = new uPlot({
      width: this.#width(chart), height: HEIGHT, ms: 1e-3,
      scales: { x: { time: false } },
      series: [{ label: "time", value: (_, t) => (t === null ? "\u2013" : `${t.toFixed(3)} s`) },
               ...series],
      axes: [{ ...axis, size: 26, values: (_, all) => all.map((t) => `${t} s`) },
             ...units.slice(0, 2).map((unit, k) => ({
               ...axis, scale: unit || "one", side: k === 0 ? 3 : 1, size: 46, label: unit || "1",
               labelSize: 14, labelFont: "10px system-ui",
             }))],
      cursor: { sync: { key: "repel" }, drag: { x: true, y: false } },
      hooks: { setSelect: [(plot) => this.#zoomed(plot)] },
    }, this.#columns(chart), chart.holder);
    chart.plot.over.addEventListener("dblclick", () => {
      this.#zoom = null;
      this.#charts.forEach((each) => this.#show(each));
    });
    this.#show(chart);
  }

  #width({ element }) {
    return Math.max(120, element.clientWidth);
  }

  // What is zoomed is held: it would run out of the picture.
  #zoomed(plot) {
    if (!(plot.select.width > 2) || this.#zooming) return;
    const { left, width } = plot.select;
    this.#zoom = [plot.posToVal(left, "x"), plot.posToVal(left + width, "x")];
    if (!this.#held) {
      const zoom = this.#zoom;
      this.#pause(true);
      this.#zoom = zoom;
    }
    this.#zooming = true;
    this.#charts.forEach((chart) => this.#show(chart));
    this.#zooming = false;
  }

  #show(chart) {
    const { plot } = chart;
    if (!plot) return;
    const width = this.#width(chart);
    if (width !== plot.width) plot.setSize({ width, height: HEIGHT });
    const columns = this.#columns(chart);
    const last = columns[0].at(-1) ?? 0;
    const [min, max] = this.#zoom ?? [Math.max(columns[0][0] ?? 0, last - SPAN_S), last];
    plot.batch(() => {
      plot.setData(columns, false);
      plot.setScale("x", { min, max: Math.max(max, min + 1e-3) });
    });
  }

  #png({ names, plot }) {
    const { canvas } = plot.ctx;
    const picture = document.createElement("canvas");
    Object.assign(picture, { width: canvas.width, height: canvas.height });
    const context = picture.getContext("2d");
    context.fillStyle = colour("card");
    context.fillRect(0, 0, picture.width, picture.height);
    context.drawImage(canvas, 0, 0);
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
