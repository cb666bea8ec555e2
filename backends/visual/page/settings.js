// SPDX-License-Identifier: BSD-3-Clause
// What the user chose, kept in the browser where it lets us keep something.

const KEY = "repel.settings";

const DEFAULTS = {
  theme: "",  // "": as the system has it
  threads: true,
  forces: true,
  labels: true,
  directions: false,
  trail: false,
  fixtures: true,
  shadows: true,
  robot: "looks",
  zones: "near",
  levels: "none",
  level: 1,
  forceScale: 0,  // [m/N]; 0: as the scene asks for
  legend: innerWidth > 1100,
  tab: "now",  // of the readings
  charts: [],  // by chart: the names of its signals
  toured: false,  // the tour was offered
  driveSpeed: 0.6,  // of the largest that the arm allows
  deadBand: 0.08,  // of a device's range
  deviceScale: 1,
  xrScale: 0,  // power of ten: motion of the tool per motion of a hand in a headset
  clutchMode: "always",
  rumble: true,
};

function stored() {
  try {
    return JSON.parse(localStorage.getItem(KEY)) ?? {};
  } catch {
    return {};  // nothing there, or not allowed to look
  }
}

// Of what was stored only what still exists, with the type it should have.
function merged(kept) {
  const all = { ...DEFAULTS };
  for (const key of Object.keys(DEFAULTS)) {
    if (typeof kept[key] === typeof DEFAULTS[key]) all[key] = kept[key];
  }
  return all;
}

export const settings = merged(stored());

export function set(key, value) {
  settings[key] = value;
  try {
    localStorage.setItem(KEY, JSON.stringify(settings));
  } catch {
    // It holds until the page is closed.
  }
}

// Joins an input of the page to a setting. `changed` hears of every change, and of the start.
export function bind(id, key, changed = () => {}) {
  const input = document.getElementById(id);
  const box = input.type === "checkbox";
  const number = typeof DEFAULTS[key] === "number";
  if (box) input.checked = settings[key];
  else input.value = settings[key];
  input.addEventListener("input", () => {
    set(key, box ? input.checked : number ? Number(input.value) : input.value);
    changed(settings[key]);
  });
  changed(settings[key]);
}
