// SPDX-License-Identifier: BSD-3-Clause
// What a program that others can reach asks for. It comes behind the address, as #secret=..., which
// a browser tells nobody; this tab keeps it, and it is taken out of the address again.

import { at, write } from "./words.js";

const KEY = "repel.secret";
let known = "";

function plain(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;  // a stray percent sign
  }
}

function keep(secret) {
  known = secret;
  try {
    sessionStorage.setItem(KEY, secret);
  } catch {
    // It is known until the page is closed.
  }
}

// Whether there was one behind the address.
function fromAddress() {
  const parts = location.hash.slice(1).split("&");
  const found = parts.find((part) => part.startsWith("secret="));
  if (found === undefined) return false;
  keep(plain(found.slice("secret=".length)));
  const rest = parts.filter((part) => part !== found).join("&");
  history.replaceState(null, "", location.pathname + location.search + (rest ? `#${rest}` : ""));
  return true;
}

export const secret = () => known;

// `changed()` is told when there is another one.
export function startSecret(changed) {
  try {
    known = sessionStorage.getItem(KEY) ?? "";
  } catch {
    // Not allowed to look: it is asked for.
  }
  fromAddress();
  addEventListener("hashchange", () => fromAddress() && changed());
  at("secret-form").addEventListener("submit", (event) => {
    event.preventDefault();
    keep(at("secret").value.trim());
    at("secret").value = "";
    changed();
  });
}

// Asks for it, or no more; `why` says what is wrong with the last one.
export function askForSecret(yes, why = "") {
  at("secret-form").hidden = !yes;
  write(at("secret-why"), why);
  if (yes) at("secret").focus();
}
