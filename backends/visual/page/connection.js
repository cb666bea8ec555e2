// SPDX-License-Identifier: BSD-3-Clause
// The WebSocket to the program: hands each message to whoever wants its type, and comes back by
// itself when the program does. Presents the secret where the program asks for one.

import { secret } from "./secret.js";
import * as wire from "./wire.js";

const READ = { scene: wire.scene, part: wire.shape, parts: wire.shapes, frame: wire.frame,
               depth: wire.depth, timing: wire.timing, operator: wire.operator,
               refused: wire.refused };
const LONGEST_WAIT_MS = 5000;
const NO_SECRET = 4401;
const TOO_MANY_SECRETS = 4429;

export class Connection {
  #handlers = new Map();
  #socket = null;
  #wait = 250;
  #retry = 0;
  resting = false;
  #onState;

  // `onState(connected, missing)` is told of every change; `missing` is what the program wants:
  // "secret", "patience" or nothing.
  constructor(onState) {
    this.#onState = onState;
  }

  // `handler` gets the message as wire.js reads it.
  on(type, handler) {
    this.#handlers.set(type, handler);
  }

  get connected() {
    return this.#socket?.readyState === WebSocket.OPEN;
  }

  open() {
    clearTimeout(this.#retry);
    this.resting = false;
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(`${scheme}//${location.host}/live`);
    this.#socket = socket;
    socket.onmessage = (event) => {
      if (socket === this.#socket) this.#dispatch(event.data);
    };
    socket.onclose = ({ code }) => {
      if (socket !== this.#socket) return;
      if (code === NO_SECRET) return this.#onState(false, "secret");  // until there is another
      this.#onState(false, code === TOO_MANY_SECRETS ? "patience" : "");
      this.#retry = setTimeout(() => this.open(), this.#wait);
      this.#wait = Math.min(2 * this.#wait, LONGEST_WAIT_MS);
    };
  }

  // At once, on a new line.
  reopen() {
    this.#socket?.close();
    this.open();
  }

  // Lets the line go until it is opened again: nobody looks.
  rest() {
    clearTimeout(this.#retry);
    const socket = this.#socket;
    this.#socket = null;
    socket?.close();
    this.resting = true;
  }

  // Whether it was sent. A page whose messages queue up must not drive with old ones.
  send(message) {
    if (!this.connected || this.#socket.bufferedAmount > 4096) return false;
    this.#socket.send(JSON.stringify(message));
    return true;
  }

  // Without one to present it does not guess: those who guess have to wait.
  #present() {
    if (secret()) return this.send({ type: "secret", secret: secret() });
    this.#socket.close();
    this.#socket = null;
    this.#onState(false, "secret");
  }

  #dispatch(text) {
    let message;
    try {
      message = JSON.parse(text);
    } catch {
      return;  // not of this protocol
    }
    if (message?.type === "secret") return this.#present();
    if (message?.type === "scene") {
      this.#wait = 250;
      this.#onState(true);
    }
    const handler = this.#handlers.get(message?.type);
    if (handler) handler(READ[message.type](message));
  }
}
