// SPDX-License-Identifier: BSD-3-Clause
// The keys, and what one sees, in an overlay.

import { at } from "./words.js";

const GROUPS = [
  ["Drive the arm (asks for the controls)", [
    ["W S", "away from me, towards me"],
    ["A D", "to the left, to the right"],
    ["R F", "up, down (also E Q)"],
    ["I K", "tip forwards, backwards"],
    ["J L", "turn left, right"],
    ["U O", "roll left, right"],
    ["M N", "lever: push, pull"],
    ["H", "the other hand, where there are two"],
    ["Shift", "held: slowly"],
    ["C", "take or release the controls"],
  ]],
  ["Time", [
    ["Space", "pause, resume"],
    [".", "one tick"],
    [">", "ten ticks"],
    ["Home", "restart with the script"],
  ]],
  ["Mouse", [
    ["drag", "orbit; right button shifts"],
    ["click", "look at a body closely"],
    ["wheel", "closer, farther"],
    ["axis", "click on an end: look from there"],
    ["drag the ring", "lead the tool, once you drive"],
    ["Shift drag", "the same, from anywhere"],
    ["drag a box", "move it; with Alt up and down"],
    ["Delete", "take a box away"],
  ]],
  ["Fingers", [
    ["left stick", "along"],
    ["right stick", "up, down, round; or tip, roll"],
    ["one finger", "orbit; on the ring: lead the tool"],
    ["two fingers", "closer, farther, shift"],
  ]],
  ["Headset", [
    ["squeeze", "hold the tool: it follows the hand"],
    ["trigger", "press a key of the panel, drag a box"],
    ["both triggers", "draw the scene larger, smaller, round"],
  ]],
  ["Camera and page", [
    ["1 2 3 4", "home, front, side, top"],
    ["5", "follow the tool"],
    ["T", "light or dark"],
    ["?", "this page"],
  ]],
];

const WHAT = "An obstacle begins to push when a part of the arm comes within its range, harder " +
  "the nearer it is. The orange arrow is that push; the name beside it is what pushes. A " +
  "thread joins the two points that are nearest. The blue arrow is what pulls the tool towards " +
  "where the operator wants it. The walls exist in the model alone.";

function element(tag, text, parent) {
  const made = parent.appendChild(document.createElement(tag));
  if (text) made.textContent = text;
  return made;
}

export function startHelp() {
  const body = at("help-body");
  element("p", WHAT, body).className = "wide";
  for (const [title, keys] of GROUPS) {
    const group = element("section", "", body);
    element("h3", title, group);
    const list = element("dl", "", group);
    for (const [key, meaning] of keys) {
      const term = element("dt", "", list);
      const one = /drag|click|wheel|stick|finger|trigger/.test(key) ? [key] : key.split(" ");
      for (const cap of one) element("kbd", cap, term);
      element("dd", meaning, list);
    }
  }
  at("help-open").addEventListener("click", toggleHelp);
}

export function toggleHelp() {
  const dialog = at("help");
  if (dialog.open) dialog.close();
  else dialog.showModal();
}
