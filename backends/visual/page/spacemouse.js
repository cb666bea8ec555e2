// SPDX-License-Identifier: BSD-3-Clause
// A SpaceMouse as a device, through WebHID: six axes, the first button engages and disengages it.

import { shaped } from "./gamepad.js";
import { at, write } from "./words.js";

const VENDORS = [0x256f, 0x046d];  // 3Dconnexion, and Logitech, which made the older ones
const MULTI_AXIS = { usagePage: 0x01, usage: 0x08 };
const FULL = 350;  // counts at full deflection
const SILENT_MS = 300;  // a deflected one reports all the time: one that does not is at rest

export class SpaceMouse {
  name = "SpaceMouse";
  #device = null;
  #moves = [0, 0, 0];  // its own axes: right, towards the user, down
  #turns = [0, 0, 0];
  #heard = 0;
  #engaged = true;
  #pressed = false;

  constructor() {
    const button = at("spacemouse-connect");
    button.hidden = !navigator.hid;
    if (!navigator.hid) {
      write(at("spacemouse-name"), "SpaceMouse: this browser has no WebHID");
      return;
    }
    button.addEventListener("click", () => this.#ask());
    navigator.hid.addEventListener("disconnect", ({ device }) => {
      if (device === this.#device) this.#use(null);
    });
    // One that was allowed before needs no question.
    navigator.hid.getDevices().then((devices) => this.#open(devices)).catch(() => {});
  }

  async #ask() {
    const filters = VENDORS.map((vendorId) => ({ vendorId, ...MULTI_AXIS }));
    try {
      await this.#open(await navigator.hid.requestDevice({ filters }));
    } catch (error) {
      write(at("spacemouse-name"), `SpaceMouse: ${error.message}`);
    }
  }

  async #open(devices) {
    const device = devices.find(({ vendorId }) => VENDORS.includes(vendorId));
    if (!device) return;
    if (!device.opened) await device.open();
    device.addEventListener("inputreport", (event) => this.#report(event.reportId, event.data));
    this.#use(device);
  }

  #use(device) {
    this.#device = device;
    this.#rest();
    this.#show();
  }

  #show() {
    const clutch = this.#engaged ? "" : ", disengaged";
    write(at("spacemouse-name"),
          `SpaceMouse: ${this.#device ? this.#device.productName + clutch : "not connected"}`);
  }

  #rest() {
    this.#moves = [0, 0, 0];
    this.#turns = [0, 0, 0];
  }

  #report(id, data) {
    const three = (from) => [0, 2, 4].map((k) => data.getInt16(from + k, true) / FULL);
    if (id === 1 && data.byteLength >= 6) {
      this.#moves = three(0);
      if (data.byteLength >= 12) this.#turns = three(6);  // newer ones send both in one
      this.#heard = performance.now();
    } else if (id === 2 && data.byteLength >= 6) {
      this.#turns = three(0);
      this.#heard = performance.now();
    } else if (id === 3 && data.byteLength >= 1) {
      const pressed = (data.getUint8(0) & 1) !== 0;
      if (pressed && !this.#pressed) this.#engaged = !this.#engaged;
      this.#pressed = pressed;
      this.#show();
    }
  }

  poll(now) {
    if (!this.#device) return null;
    if (now - this.#heard > SILENT_MS) this.#rest();
    const own = ([right, back, down]) => [-back, -right, -down].map(shaped);
    return { linear: own(this.#moves), angular: own(this.#turns), clutch: this.#engaged };
  }
}
