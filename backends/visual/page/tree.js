// SPDX-License-Identifier: BSD-3-Clause
// The bodies of the scene as a list: to hide and show them, and to choose one to look at closely.

import { at, write } from "./words.js";

const MOST = 200;  // rows: more are found by their name
const GROUPS = [["tool", "Tool"], ["link", "Links"], ["obstacle", "Obstacles"]];

export class Tree {
  #bodies = [];
  #chosen = null;

  // `choose(body)` hears which one is looked at, `highlight(body)` which one is pointed at, or that
  // none is; `hide(bodies, yes)` hides and shows, `isHidden(body)` says whether it is.
  constructor({ choose, highlight, hide, isHidden }) {
    Object.assign(this, { choose, highlight, hide, isHidden });
    at("tree-find").addEventListener("input", () => this.#list());
    at("tree-all").addEventListener("click", () => {
      hide(this.#bodies, false);
      this.#list();
    });
  }

  scene(bodies) {
    this.#bodies = bodies;
    at("tree-find").value = "";
    this.#list();
  }

  // The one that is looked at.
  mark(body) {
    this.#chosen = body;
    for (const button of at("tree").querySelectorAll("button")) {
      button.setAttribute("aria-pressed", String(button.dataset.id === body?.id));
    }
  }

  #list() {
    const wanted = at("tree-find").value.trim().toLowerCase();
    const found = this.#bodies.filter(({ name }) => name.toLowerCase().includes(wanted));
    const left = found.length - MOST;
    const shown = found.slice(0, MOST);
    at("tree").replaceChildren(...GROUPS.flatMap(([kind, title]) => {
      const rows = shown.filter((body) => body.kind === kind).map((body) => this.#row(body));
      if (rows.length === 0) return [];
      const heading = document.createElement("h3");
      heading.textContent = title;
      const list = document.createElement("ul");
      list.append(...rows);
      return [heading, list];
    }));
    write(at("tree-left"), left > 0 ? `${left} more: type a part of the name`
                                    : found.length === 0 ? "none of that name" : "");
    this.mark(this.#chosen);
  }

  #row(body) {
    const row = document.createElement("li");
    const box = row.appendChild(document.createElement("label"))
      .appendChild(document.createElement("input"));
    box.type = "checkbox";
    box.checked = !this.isHidden(body);
    box.setAttribute("aria-label", `show ${body.name}`);
    box.addEventListener("change", () => this.hide([body], !box.checked));
    const button = row.appendChild(document.createElement("button"));
    button.type = "button";
    button.dataset.id = body.id;
    button.textContent = body.name;
    if (body.parts.length > 1) {
      button.title = `${body.parts.length} convex parts`;
      row.appendChild(document.createElement("small")).textContent = String(body.parts.length);
    }
    button.addEventListener("click", () => this.choose(body));
    for (const kind of ["pointerenter", "focus"]) {
      button.addEventListener(kind, () => this.highlight(body));
    }
    for (const kind of ["pointerleave", "blur"]) {
      button.addEventListener(kind, () => this.highlight(null));
    }
    return row;
  }
}
