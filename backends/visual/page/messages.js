// SPDX-License-Identifier: BSD-3-Clause
// What is said on top of the scene: banners as long as something holds, toasts that go by
// themselves.

import { at } from "./words.js";

const banners = new Map();
const TOAST_MS = 4000;

// Shows `text` under this name, or nothing when it is empty. `note`: it is no fault.
export function banner(name, text, note = false) {
  let element = banners.get(name);
  if (!text) {
    element?.remove();
    banners.delete(name);
    return;
  }
  if (!element) {
    element = at("banners").appendChild(document.createElement("div"));
    element.className = note ? "note" : "";
    banners.set(name, element);
  }
  if (element.textContent !== text) element.textContent = text;
}

export function toast(text) {
  const element = at("toasts").appendChild(document.createElement("div"));
  element.textContent = text;
  setTimeout(() => element.remove(), TOAST_MS);
}
