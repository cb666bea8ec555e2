// SPDX-License-Identifier: BSD-3-Clause
// What can be taken away from the page: a file, a picture of the scene, and a link that opens the
// page with the same camera, arm, body, hidden bodies, tab and charts.

import { toast } from "./messages.js";
import { state } from "./state.js";
import { showTab, shownTab } from "./tabs.js";
import { at, finite } from "./words.js";

const FAR = 1e6;  // [m] no camera is farther

export function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// What stands behind the address: #t=12.5&camera=...; a number that is none is left out.
export function asked(hash = location.hash) {
  const words = new URLSearchParams(hash.slice(1));
  const numbers = (name, count) => {
    const all = (words.get(name) ?? "").split(",").map((word) => (word ? Number(word) : NaN));
    return all.length === count && all.every((x) => Math.abs(x) < FAR) ? all : null;
  };
  const charts = words.get("charts");
  return { time: /^[0-9.]+$/.test(words.get("t") ?? "") ? Number(words.get("t")) : null,
           camera: numbers("camera", 6), tab: words.get("tab"), arm: numbers("arm", 1)?.[0],
           body: words.get("body"), hidden: words.getAll("hidden"),
           charts: charts ? charts.split(";").map((some) => some.split(",")) : null };
}

// `looked()`: the names of the body that is looked at and of those that are hidden.
export function startCapture({ stage, cameras, charts, looked }) {
  at("screenshot").addEventListener("click", () => {
    stage.picture((blob) => save(blob, `${state.scene?.name ?? "repel"}.png`));
  });
  at("share").addEventListener("click", async () => {
    const words = new URLSearchParams();
    if (state.scene?.mode === "replay" && finite(state.frame?.time_s)) {
      words.set("t", state.frame.time_s.toFixed(3));
    }
    words.set("camera", cameras.place().map((x) => Number(x.toFixed(4))).join(","));
    const { body, hidden } = looked();
    if (state.arm > 0) words.set("arm", state.arm);
    if (body) words.set("body", body);
    for (const name of hidden) words.append("hidden", name);
    words.set("tab", shownTab());
    if (shownTab() === "charts") {
      words.set("charts", charts.names.map((some) => some.join(",")).join(";"));
    }
    const link = words.toString().replace(/%2C/g, ",").replace(/%3B/g, ";");
    history.replaceState(null, "", `#${link}`);
    try {
      await navigator.clipboard.writeText(location.href);
      toast("The link is copied: it has what is seen now");
    } catch {
      toast("The link is in the address bar: it has what is seen now");
    }
  });
}

// Once the scene stands. What is no key of the page is left out. `show({ arm, body, hidden })`.
export function follow({ cameras, charts, show }) {
  const { camera, tab, charts: names, ...others } = asked();
  if (camera) cameras.look(camera.slice(0, 3), camera.slice(3));
  show(others);
  if (tab) showTab(tab);
  if (names) charts.arm(names);
}
