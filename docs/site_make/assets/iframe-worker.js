// SPDX-License-Identifier: BSD-3-Clause
// A page that is opened as a file may not start a worker. This one runs its script in a hidden
// frame instead, so that the search works without a server.
if (location.protocol === "file:") {
  window.Worker = class extends EventTarget {
    constructor(url) {
      super();
      this.queue = [];
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      document.body.appendChild(this.frame);
      const inside = this.frame.contentWindow;
      addEventListener("message", (event) => {
        if (event.source !== inside) return;
        const copy = new MessageEvent("message", { data: event.data });
        this.dispatchEvent(copy);
        if (this.onmessage) this.onmessage(copy);
      });
      const page = inside.document;
      page.open();
      page.write(
        "<script>" +
          "postMessage = (data) => parent.dispatchEvent(" +
          "new MessageEvent('message', { data, source: window }));" +
          "importScripts = (...urls) => urls.reduce((before, url) => before.then(() =>" +
          "new Promise((done) => { const s = document.createElement('script'); s.src = url;" +
          "s.onload = done; document.body.appendChild(s); })), Promise.resolve());" +
          "<" + "/script><script src='" + url + "'><" + "/script>"
      );
      page.close();
      this.frame.onload = () => {
        this.loaded = true;
        this.queue.splice(0).forEach((data) => this.postMessage(data));
      };
    }
    postMessage(data) {
      if (!this.loaded) return void this.queue.push(data);
      const inside = this.frame.contentWindow;
      inside.dispatchEvent(new MessageEvent("message", { data }));
    }
    terminate() {
      this.frame.remove();
    }
  };
}
