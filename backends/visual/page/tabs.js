// SPDX-License-Identifier: BSD-3-Clause
// The pages of the readings: one is seen at a time. Arrow keys go from tab to tab.

import { set, settings } from "./settings.js";
import { at } from "./words.js";

const tabs = () => [...at("tabs").children];

export const shownTab = () => settings.tab;

// Shows a page by its name: now, bodies, joints, charts, events.
export function showTab(name) {
  set("tab", tabs().some((tab) => tab.dataset.tab === name) ? name : "now");
  for (const tab of tabs()) {
    const chosen = tab.dataset.tab === settings.tab;
    tab.setAttribute("aria-selected", String(chosen));
    tab.tabIndex = chosen ? 0 : -1;
    at(`pane-${tab.dataset.tab}`).hidden = !chosen;
  }
}

// `changed()` hears that another page is seen.
export function startTabs(changed) {
  for (const tab of tabs()) {
    tab.addEventListener("click", () => {
      showTab(tab.dataset.tab);
      changed();
    });
  }
  at("tabs").addEventListener("keydown", (event) => {
    const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    const all = tabs();
    const next = all[(all.indexOf(event.target) + step + all.length) % all.length];
    next.focus();
    next.click();
  });
  showTab(settings.tab);
}
