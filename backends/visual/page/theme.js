// SPDX-License-Identifier: BSD-3-Clause
// Light and dark: follows the system until the button says otherwise. Colours stand in page.css
// alone; what is drawn on canvases asks for them here.

import { set, settings } from "./settings.js";
import { at } from "./words.js";

const dark = matchMedia("(prefers-color-scheme: dark)");
const listeners = [];
let style = null;

export const theme = () => settings.theme || (dark.matches ? "dark" : "light");

// The value of the custom property --NAME.
export function colour(name) {
  style ??= getComputedStyle(document.documentElement);
  return style.getPropertyValue(`--${name}`).trim();
}

export function onTheme(listener) {
  listeners.push(listener);
  listener();
}

function apply() {
  document.documentElement.dataset.theme = theme();
  at("theme").textContent = theme() === "dark" ? "Light" : "Dark";
  for (const listener of listeners) listener();
}

export function startTheme() {
  for (const key of document.querySelectorAll("[data-c]")) {
    key.style.setProperty("--c", `var(--${key.dataset.c})`);
  }
  at("theme").addEventListener("click", () => {
    set("theme", theme() === "dark" ? "light" : "dark");
    apply();
  });
  dark.addEventListener("change", apply);
  apply();
}
