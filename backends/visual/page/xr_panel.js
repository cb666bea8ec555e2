// SPDX-License-Identifier: BSD-3-Clause
// A panel that stands in the room of the headset: what is to be read, and what a ray can press. It
// says and presses what the page has, so each switch has one owner.

import {
  CanvasTexture, DoubleSide, Group, Mesh, MeshBasicMaterial, Plane, PlaneGeometry, Vector3,
} from "./vendor/three.min.js";
import { state } from "./state.js";
import { colour } from "./theme.js";
import { at } from "./words.js";
import { Ribbon } from "./xr_ribbon.js";

const WIDE = 0.4;  // [m]
const PIXELS = 640;  // along that
const LINE = 34;  // [px]
const KEY = 58;
const MARGIN = 16;
const DRAW_MS = 100;
const RIBBON = 0.09;  // [m] high
const PLACE = { ahead: 0.55, aside: -0.42, below: 0.2 };  // [m], from the eyes

// Between a hand and the tool: the scale of the network where the hand moves a master with six axes,
// and otherwise that of the page.
export const scaleInput = () => at(state.frame?.arms[0]?.grip_n ? "hand-scale" : "xr-scale");

const toggles = (name) => [...document.querySelectorAll(`#${name} input`)].map((box) => ({
  text: box.parentElement.textContent.trim(), on: box.checked, press: () => box.click(),
}));
// As the keyboard presses it.
const button = (name, text = at(name).textContent.trim()) => (
  { text, press: () => at(name).dispatchEvent(new MouseEvent("click", { bubbles: true })) });

function nudge(input, steps) {
  input.value = Number(input.value) + steps * 2 * Number(input.step);
  input.dispatchEvent(new Event("input"));
}

export class XrPanel {
  #rows = [];  // of keys, each with its place on the canvas
  #drawn = "";
  #drawnAt = 0;
  #texture = null;
  #plane = new Plane();
  #hit = new Vector3();
  #normal = new Vector3();

  // `own()`: the keys of the headset itself, as { text, on, press }.
  constructor(rig, own) {
    this.own = own;
    this.canvas = document.createElement("canvas");
    this.material = new MeshBasicMaterial({ side: DoubleSide, transparent: true });
    this.mesh = new Mesh(new PlaneGeometry(1, 1), this.material);
    this.ribbon = new Ribbon(WIDE, RIBBON);
    this.group = new Group();
    this.group.add(this.mesh, this.ribbon.mesh);
    this.group.visible = false;
    rig.add(this.group);
  }

  // Beside the scene, facing the viewer.
  place({ position, quaternion }) {
    const ahead = this.#normal.set(0, 0, -1).applyQuaternion(quaternion).setY(0).normalize();
    const aside = new Vector3(-ahead.z, 0, ahead.x);
    this.group.position.copy(position).addScaledVector(ahead, PLACE.ahead)
      .addScaledVector(aside, PLACE.aside);
    this.group.position.y -= PLACE.below;
    const towards = new Vector3().subVectors(position, this.group.position).setY(0).normalize();
    this.group.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), towards);
    this.group.visible = true;
  }

  leave() {
    this.group.visible = false;
  }

  #keys() {
    const scale = scaleInput();
    const rows = [["take", "pause"].filter((name) => !at(name).hidden).map((name) => button(name)),
                  [{ text: "\u2212", press: () => nudge(scale, -1) },
                   { text: `scale ${at(`${scale.id}-out`).textContent}` },
                   { text: "+", press: () => nudge(scale, 1) }]];
    const fixtures = toggles("fixture-boxes");
    for (let k = 0; k < fixtures.length; k += 3) rows.push(fixtures.slice(k, k + 3));
    const compliant = toggles("compliant-boxes");
    if (compliant.length > 0) rows.push([{ text: "gives way" }, ...compliant]);
    if (!at("boxes").hidden) rows.push([button("add-box"), button("remove-box", "Remove box")]);
    rows.push(this.own());
    return rows;
  }

  // `lines`: what is to be read above the keys.
  update(lines, now) {
    if (!this.group.visible || now - this.#drawnAt < DRAW_MS) return;
    this.#drawnAt = now;
    this.ribbon.update();
    const rows = this.#keys();
    const content = JSON.stringify([lines, rows, state.operator?.you, colour("ink")]);
    if (content !== this.#drawn) this.#draw(lines, rows);
    this.#drawn = content;
  }

  #draw(lines, rows) {
    const high = 2 * MARGIN + lines.length * LINE + rows.length * KEY;
    this.#resize(high);
    const pen = this.canvas.getContext("2d");
    pen.fillStyle = colour("card");
    pen.fillRect(0, 0, PIXELS, high);
    pen.textBaseline = "middle";
    pen.fillStyle = colour("ink");
    pen.textAlign = "left";
    pen.font = "24px system-ui, sans-serif";
    lines.forEach((line, k) => {
      pen.fillText(line, MARGIN, MARGIN + (k + 0.5) * LINE, PIXELS - 2 * MARGIN);
    });
    this.#rows = rows.map((keys, k) => {
      const y = MARGIN + lines.length * LINE + k * KEY;
      const wide = (PIXELS - 2 * MARGIN) / keys.length;
      return keys.map((key, i) => ({ ...key, x: MARGIN + i * wide, y, wide }));
    });
    pen.textAlign = "center";
    for (const key of this.#rows.flat()) this.#key(pen, key);
    this.#texture.needsUpdate = true;
  }

  #key(pen, { text, on, press, x, y, wide }) {
    if (press) {
      pen.fillStyle = colour(on ? "accent" : "page");
      pen.strokeStyle = colour("dim");
      pen.beginPath();
      pen.roundRect(x + 3, y + 3, wide - 6, KEY - 6, 8);
      pen.fill();
      pen.stroke();
    }
    pen.fillStyle = colour(on ? "on-accent" : "ink");
    pen.fillText(text, x + wide / 2, y + KEY / 2, wide - 14);
  }

  // A texture keeps the size that it was made with.
  #resize(high) {
    if (this.#texture && this.canvas.height === high) return;
    Object.assign(this.canvas, { width: PIXELS, height: high });
    this.#texture?.dispose();
    this.#texture = this.material.map = new CanvasTexture(this.canvas);
    this.#texture.colorSpace = "srgb";
    this.material.needsUpdate = true;
    const tall = (WIDE * high) / PIXELS;
    this.mesh.scale.set(WIDE, tall, 1);
    this.ribbon.mesh.position.y = tall / 2 + 0.01;
  }

  // What a ray in the room meets on the panel: how far away [m], and the key there, if any; null
  // beside it.
  meets({ position, quaternion }) {
    if (!this.group.visible || !this.#texture) return null;
    const along = new Vector3(0, 0, -1).applyQuaternion(quaternion);
    this.#normal.set(0, 0, 1).applyQuaternion(this.group.quaternion);
    this.#plane.setFromNormalAndCoplanarPoint(this.#normal, this.group.position);
    const slant = along.dot(this.#normal);
    const far = -this.#plane.distanceToPoint(position) / slant;
    if (!(far > 0) || !Number.isFinite(far)) return null;
    const p = this.#hit.copy(position).addScaledVector(along, far).sub(this.group.position)
      .applyQuaternion(this.group.quaternion.clone().invert());
    const x = (p.x / WIDE + 0.5) * PIXELS;
    const y = (0.5 - p.y / this.mesh.scale.y) * this.canvas.height;
    if (x < 0 || x > PIXELS || y < 0 || y > this.canvas.height) return null;
    const key = this.#rows.flat().find((each) => x >= each.x && x < each.x + each.wide &&
                                                 y >= each.y && y < each.y + KEY);
    return { far, key: key?.press ? key : null };
  }

  // The middle of the key with that text, in the room; null: there is none.
  whereIs(text) {
    const key = this.#rows.flat().find((each) => each.text === text && each.press);
    if (!key) return null;
    const x = ((key.x + key.wide / 2) / PIXELS - 0.5) * WIDE;
    const y = (0.5 - (key.y + KEY / 2) / this.canvas.height) * this.mesh.scale.y;
    return new Vector3(x, y, 0).applyQuaternion(this.group.quaternion).add(this.group.position)
      .toArray();
  }
}
