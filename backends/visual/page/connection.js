// The WebSocket to the program: hands each message to whoever wants its type, and comes back by
// itself when the program does.

import * as wire from "./wire.js";

const READ = { scene: wire.scene, frame: wire.frame, timing: wire.timing,
               operator: wire.operator, refused: wire.refused };
const LONGEST_WAIT_MS = 5000;

export class Connection {
  #handlers = new Map();
  #socket = null;
  #wait = 250;
  #onState;

  // `onState(connected)` is told of every change.
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
    const scheme = location.protocol === "https:" ? "wss:" : "ws:";
    const socket = new WebSocket(`${scheme}//${location.host}/live`);
    this.#socket = socket;
    socket.onopen = () => {
      this.#wait = 250;
      this.#onState(true);
    };
    socket.onmessage = (event) => this.#dispatch(event.data);
    socket.onclose = () => {
      this.#onState(false);
      setTimeout(() => this.open(), this.#wait);
      this.#wait = Math.min(2 * this.#wait, LONGEST_WAIT_MS);
    };
  }

  // Whether it was sent. A page whose messages queue up must not drive with old ones.
  send(message) {
    if (!this.connected || this.#socket.bufferedAmount > 4096) return false;
    this.#socket.send(JSON.stringify(message));
    return true;
  }

  #dispatch(text) {
    let message;
    try {
      message = JSON.parse(text);
    } catch {
      return;  // not of this protocol
    }
    const handler = this.#handlers.get(message?.type);
    if (handler) handler(READ[message.type](message));
  }
}
