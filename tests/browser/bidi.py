# SPDX-License-Identifier: BSD-3-Clause
"""As much of WebDriver BiDi as a smoke test in Firefox needs. Debian has no geckodriver, and
Firefox speaks BiDi without one: on a WebSocket of its own, of which this is the client's side."""

import base64
import json
import os
import re
import shutil
import socket
import struct
import subprocess
import tempfile
import threading
import time

PROFILE = """
user_pref("webgl.force-enabled", true);
user_pref("browser.shell.checkDefaultBrowser", false);
user_pref("datareporting.policy.dataSubmissionEnabled", false);
user_pref("app.update.enabled", false);
user_pref("network.captive-portal-service.enabled", false);
user_pref("network.connectivity-service.enabled", false);
"""


class Socket:
    """A WebSocket that carries text."""

    def __init__(self, host, port, path, patience):
        self.socket = socket.create_connection((host, port), patience)
        self.pending = b""
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET {path} HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\n"
                             f"Connection: Upgrade\r\nSec-WebSocket-Key: {key}\r\n"
                             "Sec-WebSocket-Version: 13\r\n\r\n").encode())
        while b"\r\n\r\n" not in self.pending:
            self._more()
        head, self.pending = self.pending.split(b"\r\n\r\n", 1)
        if b" 101 " not in head.split(b"\r\n", 1)[0]:
            raise ConnectionError(head.decode(errors="replace"))

    def close(self):
        self.socket.close()

    def _more(self):
        data = self.socket.recv(65536)
        if not data:
            raise ConnectionError("the browser has closed the line")
        self.pending += data

    def _take(self, count):
        while len(self.pending) < count:
            self._more()
        data, self.pending = self.pending[:count], self.pending[count:]
        return data

    def _send(self, kind, data):
        size = len(data)
        head = bytes([0x80 | kind])
        if size < 126:
            head += bytes([0x80 | size])
        elif size < 65536:
            head += bytes([0x80 | 126]) + struct.pack(">H", size)
        else:
            head += bytes([0x80 | 127]) + struct.pack(">Q", size)
        mask = os.urandom(4)
        masked = bytes(byte ^ mask[k % 4] for k, byte in enumerate(data))
        self.socket.sendall(head + mask + masked)

    def send(self, text):
        self._send(1, text.encode())

    def receive(self):
        """The next text; answers pings."""
        text = b""
        while True:
            first, second = self._take(2)
            size = second & 0x7F
            if size == 126:
                size = struct.unpack(">H", self._take(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self._take(8))[0]
            data = self._take(size)
            if first & 0x0F == 8:
                raise ConnectionError("the browser has closed the line")
            if first & 0x0F == 9:
                self._send(10, data)
            elif first & 0x0F in (0, 1):
                text += data
                if first & 0x80:
                    return text.decode()


class Screen:
    """A screen that nobody sees: a headless Firefox has no WebGL where no graphics card draws."""

    def __init__(self):
        reads, writes = os.pipe()
        self.process = subprocess.Popen(
            ["Xvfb", "-displayfd", str(writes), "-screen", "0", "1440x900x24", "-nolisten", "tcp"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
            pass_fds=(writes,))
        os.close(writes)
        with os.fdopen(reads) as file:
            self.name = f":{file.readline().strip()}"

    def close(self):
        self.process.terminate()
        self.process.wait(10)


class Firefox:
    """A Firefox with a profile of its own, and one tab: on a screen of Xvfb, or else headless."""

    def __init__(self, program, patience=60):
        self.screen = Screen() if shutil.which("Xvfb") else None
        self.process = self.socket = None
        self.reader = threading.Thread()
        self.folder = tempfile.mkdtemp()
        with open(os.path.join(self.folder, "user.js"), "w", encoding="utf-8") as file:
            file.write(PROFILE)
        try:
            self._start(program, patience)
        except Exception:
            self.close()
            raise

    def _start(self, program, patience):
        environment = {**os.environ, "HOME": self.folder}
        if self.screen:
            environment["DISPLAY"] = self.screen.name
        self.process = subprocess.Popen(
            [program, *([] if self.screen else ["--headless"]), "--no-remote",
             "--profile", self.folder, "--remote-debugging-port", "0", "--width", "1280",
             "--height", "800", "about:blank"],
            stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
            env=environment)
        for line in self.process.stderr:
            found = re.search(r"BiDi listening on ws://([\d.]+):(\d+)", line)
            if found:
                break
        else:
            raise RuntimeError(f"{program} ended with {self.process.wait()}")
        # What it says from here on is read by nobody, and must not fill the pipe.
        self.reader = threading.Thread(target=self.process.stderr.read, daemon=True)
        self.reader.start()
        self.socket = Socket(found.group(1), int(found.group(2)), "/session", patience)
        self.number = 0
        self.errors = []  # of the console
        self.command("session.new", capabilities={})
        self.command("session.subscribe", events=["log.entryAdded"])
        self.tab = self.command("browsingContext.getTree")["contexts"][0]["context"]

    def close(self):
        if self.socket:
            self.socket.close()
        if self.process:
            self.process.terminate()
            self.process.wait(20)
            if self.reader.ident:
                self.reader.join(10)
            self.process.stderr.close()
        if self.screen:
            self.screen.close()
        shutil.rmtree(self.folder, ignore_errors=True)

    def command(self, method, **params):
        """Its result. Events that come before it are heard."""
        self.number += 1
        self.socket.send(json.dumps({"id": self.number, "method": method, "params": params}))
        while True:
            message = json.loads(self.socket.receive())
            if message.get("method") == "log.entryAdded":
                entry = message["params"]
                if entry["level"] == "error":
                    self.errors.append(entry.get("text"))
            if message.get("id") == self.number:
                if message["type"] == "error":
                    raise RuntimeError(f"{method}: {message['message']}")
                return message["result"]

    def open(self, url):
        self.command("browsingContext.navigate", context=self.tab, url=url, wait="complete")

    def ask(self, expression):
        """The value of an expression of JavaScript."""
        result = self.command("script.evaluate", expression=f"JSON.stringify({expression})",
                              target={"context": self.tab}, awaitPromise=True)
        if result["type"] != "success":
            raise RuntimeError(result["exceptionDetails"]["text"])
        return json.loads(result["result"].get("value", "null"))

    def until(self, expression, holds, what, patience):
        end = time.monotonic() + patience
        while True:
            value = self.ask(expression)
            if holds(value):
                return value
            if time.monotonic() > end:
                raise AssertionError(f"not within {patience} s: {what}; {value}")
            time.sleep(0.1)

    def keys(self, *actions):
        """As keys({"type": "keyDown", "value": "r"})."""
        self.command("input.performActions", context=self.tab,
                     actions=[{"type": "key", "id": "keyboard", "actions": list(actions)}])
