// SPDX-License-Identifier: BSD-3-Clause
// On a small screen, and where one points with a finger: the readings are folded away behind a
// button, what is needed while driving lies on the scene, and what is not goes to the readings.

import { toast } from "./messages.js";
import { at } from "./words.js";

const FOLDED = matchMedia("(max-width: 900px), (pointer: coarse)");

// What stands elsewhere while the page is folded: at the end or the beginning of what.
const MOVES = [["numbers", "append", "top"], ["drive-body", "prepend", "panel"],
               ["legend", "append", "panel"], ["takeaway", "append", "show-menu-body"],
               ["tour", "append", "top"]];

const homes = new Map();

function fold() {
  const folded = FOLDED.matches;
  document.documentElement.classList.toggle("folded", folded);
  for (const [name, adds, place] of MOVES) {
    const element = at(name);
    if (!homes.has(name)) {
      homes.set(name, document.createComment(name));
      element.before(homes.get(name));
    }
    if (folded) at(place)[adds](element);
    else homes.get(name).after(element);
  }
  open(false);
}

function open(yes) {
  document.documentElement.classList.toggle("opened", yes);
  at("panel-open").setAttribute("aria-expanded", String(yes));
}

// Shows the readings where they are folded away.
export const showReadings = () => FOLDED.matches && open(true);

export const drawerOpen = () => at("panel-open").getAttribute("aria-expanded") === "true";

export function startDrawer() {
  at("panel-open").addEventListener("click", () => open(!drawerOpen()));
  addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !drawerOpen() || at("help").open) return;
    open(false);
    at("panel-open").focus();
  });
  // What is cut off there has no pointer to rest on it.
  at("status").addEventListener("click", () => FOLDED.matches && toast(at("status").title));
  FOLDED.addEventListener("change", fold);
  fold();
}
