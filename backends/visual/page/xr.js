// SPDX-License-Identifier: BSD-3-Clause
// A headset, or a phone, as a master: its session and what each of its frames does. A squeeze holds
// the tool, a ray presses what the panel has and drags boxes, two hands that select draw the scene
// larger or smaller.

import { Quaternion, Raycaster, Vector3 } from "./vendor/three.min.js";
import { factorOf, factorText } from "./hand.js";
import { toast } from "./messages.js";
import { bind, settings } from "./settings.js";
import { state } from "./state.js";
import { at, finite, fixed, mm, norm, write } from "./words.js";
import { Clutch } from "./xr_clutch.js";
import { Feel } from "./xr_feel.js";
import { XrHand } from "./xr_hand.js";
import { scaleInput, XrPanel } from "./xr_panel.js";
import { Room } from "./xr_room.js";

const EYE = { near: 0.05, far: 200 };  // [m] in the room
const LATENCIES = 256;  // of which the median and the 99 % are told
const SHOWN_MS = 500;

export class Headset {
  mode = null;  // "vr" or "ar" while somebody is in it
  #session = null;
  #hands = new Map();  // by the source of input
  #starts = [];  // [what, source] that began since the last frame
  #placed = false;
  #before = null;  // the camera as it was
  #latencies = [];  // from the pose to the command [ms], the newest last
  #shownAt = 0;
  #ray = new Raycaster();
  #point = new Vector3();
  #turn = new Quaternion();
  feel = new Feel();

  // `take()` asks for the controls. `paint(now)` draws all but the picture, and that too.
  // `changed()` hears when somebody enters or leaves.
  constructor(stage, { boxes, heading, paint, changed }) {
    Object.assign(this, { stage, boxes, heading, paint, changed });
    const letGo = (why) => this.#hasLet(why);
    this.clutches = [new Clutch(letGo), new Clutch(letGo)];  // of the right hand, and the left
    this.room = new Room(stage.rig);
    this.panel = new XrPanel(stage.rig, () => [
      ...Object.entries({ life: "Its size", table: "Table" }).map(([size, text]) => (
        { text, on: this.room.size === size, press: () => this.#resize(size) })),
      { text: "Leave", press: () => this.#session?.end() },
    ]);
    for (const mode of ["vr", "ar"]) {
      at(`enter-${mode}`).addEventListener("click", () => this.enter(mode));
    }
    bind("xr-scale", "xrScale", (power) => write(at("xr-scale-out"), factorText(factorOf(power))));
    navigator.xr?.addEventListener("devicechange", () => this.#offer());
    this.#offer();
    document.addEventListener("visibilitychange", () => {
      if (document.hidden) this.letGo("the page was hidden");
    });
  }

  // The controls that the hands drive with.
  drives(controls) {
    this.controls = controls;
  }

  async #offer() {
    for (const mode of ["vr", "ar"]) {
      const can = await navigator.xr?.isSessionSupported(`immersive-${mode}`).catch(() => false);
      at(`enter-${mode}`).hidden = can !== true;
      if (can) at("headset-name").hidden = false;
    }
  }

  async enter(mode) {
    if (this.#session) return;
    try {
      const session = await navigator.xr.requestSession(`immersive-${mode}`, {
        requiredFeatures: ["local-floor"], optionalFeatures: ["hand-tracking"] });
      this.#session = session;
      this.mode = mode;
      this.#listen(session);
      this.#enterStage();
      await this.stage.renderer.xr.setSession(session);
    } catch (error) {
      toast(`Not entered: ${error.message}`);
      if (this.#session) this.#session.end().catch(() => this.#left());
    }
  }

  #listen(session) {
    for (const kind of ["select", "squeeze"]) {
      // Where the hand is then, the next frame says; what ends, ends at once.
      session.addEventListener(`${kind}start`, ({ inputSource }) => {
        this.#starts.push([kind, inputSource]);
      });
      session.addEventListener(`${kind}end`, ({ inputSource }) => this.#ends(kind, inputSource));
    }
    session.addEventListener("inputsourceschange", ({ removed }) => {
      for (const source of removed) this.#forget(source);
    });
    session.addEventListener("visibilitychange", () => {
      if (session.visibilityState !== "visible") this.letGo("the headset shows something else");
    });
    session.addEventListener("end", () => {
      this.letGo("the headset was left");
      setTimeout(() => this.#left());  // after the renderer has
    });
  }

  // The near and far of a headset are in the room.
  #enterStage() {
    const { camera, renderer } = this.stage;
    this.#before = { position: camera.position.clone(), quaternion: camera.quaternion.clone(),
                     lens: { near: camera.near, far: camera.far, fov: camera.fov } };
    this.entering = this.heading().ahead;
    Object.assign(camera, EYE);
    this.stage.surround(this.mode === "vr");
    renderer.xr.setAnimationLoop((now, frame) => frame && this.#frame(now, frame));
    this.#placed = false;
    this.changed();
  }

  #left() {
    for (const source of [...this.#hands.keys()]) this.#forget(source);
    this.#session = this.mode = null;
    this.#starts.length = 0;
    this.room.leave();
    this.panel.leave();
    const { camera } = this.stage;
    camera.position.copy(this.#before.position);
    camera.quaternion.copy(this.#before.quaternion);
    camera.scale.setScalar(1);
    Object.assign(camera, this.#before.lens);
    this.stage.surround(false);
    this.stage.restore();
    this.changed();
  }

  // Every hand lets go, and the rates are zero at once.
  letGo(why) {
    for (const clutch of this.clutches) clutch.open(why);
  }

  #hasLet(why) {
    this.feel.rest();
    this.controls.beat();
    if (why) toast(`The hand was let go: ${why}`);
  }

  #handOf(source) {
    if (!this.#hands.has(source)) {
      const clutch = this.clutches[source.handedness === "left" ? 1 : 0];
      this.#hands.set(source, new XrHand(source, clutch, this.stage.rig));
    }
    return this.#hands.get(source);
  }

  #forget(source) {
    const hand = this.#hands.get(source);
    if (!hand) return;
    if (hand.holds) hand.clutch.open(hand.onScreen ? "" : "it is not seen any more");
    hand.leave();
    this.#hands.delete(source);
    this.#starts = this.#starts.filter((each) => each[1] !== source);
  }

  #frame(now, frame) {
    const space = this.stage.renderer.xr.getReferenceSpace();
    const viewer = frame.getViewerPose(space) ?? null;
    if (viewer && !this.#placed) this.#place(viewer.transform);
    for (const source of this.#session?.inputSources ?? []) {
      this.#handOf(source).read(frame, space, viewer);
    }
    for (const [kind, source] of this.#starts.splice(0)) this.#begins(kind, source);
    for (const hand of this.#hands.values()) this.#lead(hand, now);
    this.#pinch();
    if (!document.hidden && this.controls.beat() && this.held) this.#measure(now);
    this.#sense(now);
    this.#show(now);
    this.paint(now);
  }

  #pinch() {
    const both = [...this.#hands.values()].filter((hand) => hand.pinches && hand.tracked);
    if (both.length === 2) this.room.pinch(...both.map(({ grip }) => grip.position));
    else this.room.letPinch();
  }

  #place({ position: p, orientation: q }) {
    const viewer = { position: new Vector3(p.x, p.y, p.z),
                     quaternion: new Quaternion(q.x, q.y, q.z, q.w) };
    if (!this.stage.sphere) return;
    this.room.place(viewer, this.entering, this.stage.sphere, this.stage.lowest);
    this.panel.place(viewer);
    this.#placed = true;
  }

  #resize(size) {
    this.letGo("the scene was placed anew");
    this.room.size = size;
    this.#placed = false;
  }

  #begins(kind, source) {
    const hand = this.#hands.get(source);
    if (!hand?.tracked || document.hidden) return;
    if (kind === "squeeze") return this.#hold(hand);
    const met = this.panel.meets(hand.ray);
    if (met) return met.key?.press();
    hand.selects = true;
    const other = [...this.#hands.values()].find((each) => each !== hand && each.selects);
    if (other) {
      for (const each of [hand, other]) this.#pinches(each);
      return;
    }
    if (this.#grab(hand)) return;
    if (!hand.squeezes) this.#hold(hand);
  }

  // What it had in its hand it has no more: it draws the scene.
  #pinches(hand) {
    hand.drags = null;
    if (hand.holds) hand.clutch.open();
    hand.pinches = true;
  }

  // In a network with two hands each moves its own; otherwise the first to squeeze has the tool.
  #hold(hand) {
    const two = state.scene?.arms[0]?.hands > 1;
    if (hand.clutch.held || (!two && this.held)) return;
    this.clutches.forEach((clutch, k) => {
      clutch.hand = two ? ["first", "second"][k] : undefined;
    });
    hand.clutch.close(hand);
    this.controls.take();
  }

  #ends(kind, source) {
    this.#starts = this.#starts.filter((each) => each[0] !== kind || each[1] !== source);
    const hand = this.#hands.get(source);
    if (!hand) return;
    if (hand.holds && (kind === "squeeze" || !hand.squeezes)) hand.clutch.open();
    if (kind !== "select") return;
    if (hand.drags) this.boxes.lead(hand.drags.part, hand.drags.at, true);
    hand.selects = hand.pinches = false;
    hand.drags = null;
  }

  get held() {
    return this.clutches.some((clutch) => clutch.held);
  }

  // Takes a box into the hand, if the ray meets one.
  #grab(hand) {
    const { ray } = this.#ray;
    this.room.toScene(hand.ray.position, ray.origin);
    ray.direction.set(0, 0, -1).applyQuaternion(this.room.turnToScene(hand.ray.quaternion,
                                                                      this.#turn));
    const box = this.boxes.along(this.#ray);
    if (!box) return false;
    const place = this.stage.rig.worldToLocal(box.position).sub(hand.grip.position)
      .applyQuaternion(this.#turn.copy(hand.grip.quaternion).invert());
    hand.drags = { part: box.part, place, at: new Vector3() };
    return true;
  }

  #lead(hand, now) {
    const { clutch, grip, drags } = hand;
    if (hand.holds && !hand.tracked) clutch.open("it is not tracked");
    if (!hand.tracked) return;
    if (drags) {
      this.#point.copy(drags.place).applyQuaternion(grip.quaternion).add(grip.position);
      this.boxes.lead(drags.part, this.room.toScene(this.#point, drags.at));
    }
    if (!hand.holds) return;
    const scale = scaleInput() === at("xr-scale") ? factorOf(settings.xrScale) : 1;
    clutch.move({ room: grip.position, scene: this.room.toScene(grip.position, this.#point),
                  turn: this.room.turnToScene(grip.quaternion, this.#turn) },
                now, scale, this.controls.ours);
  }

  #measure(now) {
    this.#latencies.push(Math.max(0, performance.now() - now));
    if (this.#latencies.length > LATENCIES) this.#latencies.shift();
  }

  // From the frame of a pose to the command that it became [ms]; null before there was one.
  get latency() {
    const sorted = [...this.#latencies].sort((a, b) => a - b);
    const of = (share) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
    return sorted.length > 0 ? { p50: of(0.5), p99: of(0.99), max: sorted.at(-1) } : null;
  }

  #sense(now) {
    const holding = [...this.#hands.values()].filter((hand) => hand.holds);
    const force = this.controls.ours ? norm(state.frame?.arms[0]?.force) : 0;
    this.feel.feel(holding.map(({ source }) => source), force, now);
  }

  #show(now) {
    for (const hand of this.#hands.values()) hand.draw(this.panel.meets(hand.ray)?.far);
    const force = norm(state.frame?.arms[0]?.force);
    const why = this.clutches.map((clutch) => clutch.why).find(Boolean);
    this.panel.update([
      `${at("who").textContent}${this.held ? ", in your hand" : ""}`,
      `force ${fixed(force, 1)} N, nearest ${mm(state.frame?.pairs[0]?.d)} mm`,
      why ? `Let go: ${why}` : this.#inWords(),
    ], now);
    if (now - this.#shownAt < SHOWN_MS) return;
    this.#shownAt = now;
    write(at("headset-name"), `Headset: ${this.mode === "vr" ? "VR" : "AR"}, ${this.#inWords()}`);
  }

  #inWords() {
    const { p50, p99 } = this.latency ?? {};
    return finite(p50) ? `pose to command ${fixed(p50, 1)} ms, 99 %: ${fixed(p99, 1)} ms`
                       : "squeeze to hold the tool";
  }

  // For tests and the console.
  get told() {
    return {
      mode: this.mode,
      held: this.clutches.map((clutch) => clutch.held),
      why: this.clutches.map((clutch) => clutch.why),
      hands: [...this.#hands.values()].map(({ source, tracked }) => [source.handedness, tracked]),
      scale: this.room.scale,
      pulses: this.feel.pulses,
      strength: this.feel.strength,
    };
  }
}
