#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Stands in for the Haply Inverse Service: an Inverse3 that a simulated hand leads in a circle.

    examples/fake_inverse.py &
    teleop SCENE --device haply

The handle has a mass and gives way to the force that the program sends; the hand draws it to the
circle by a spring. One program at a time. Ends by Ctrl-C, or after --seconds.
Its WebSocket is by hand, so that the example needs nothing but Python.
"""

import argparse
import base64
import hashlib
import json
import math
import socket
import struct
import time

ACCEPT_GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"  # RFC 6455, section 1.3


class Gone(Exception):
    """The program has closed the connection."""


class WebSocket:
    """The server's end of a connection: whole text messages, as RFC 6455 frames them."""

    def __init__(self, connection):
        self.connection = connection
        self.stream = connection.makefile("rb")
        key = b""
        while (line := self.stream.readline().strip()):
            name, _, value = line.partition(b":")
            if name.lower() == b"sec-websocket-key":
                key = value.strip()
        if not key:
            raise Gone
        accept = base64.b64encode(hashlib.sha1(key + ACCEPT_GUID).digest())
        connection.sendall(b"HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\n"
                           b"Connection: Upgrade\r\nSec-WebSocket-Accept: " + accept + b"\r\n\r\n")

    def take(self, count):
        data = self.stream.read(count)
        if len(data) < count:
            raise Gone
        return data

    def receive(self):
        """The next text message; answers pings."""
        text = b""
        while True:
            first, second = self.take(2)
            size = second & 0x7F
            if size == 126:
                size = struct.unpack(">H", self.take(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self.take(8))[0]
            if size > 65536 or not second & 0x80:
                raise Gone  # no command is so long, and a client masks what it sends
            mask = self.take(4)
            data = bytes(b ^ mask[i % 4] for i, b in enumerate(self.take(size)))
            kind = first & 0x0F
            if kind == 8:
                raise Gone
            if kind == 9:
                self.send(data, kind=10)
            if kind in (0, 1, 2):
                text += data
                if first & 0x80:
                    return text

    def send(self, data, kind=1):
        size = struct.pack("B", len(data)) if len(data) < 126 else struct.pack(">BH", 126, len(data))
        self.connection.sendall(bytes([0x80 | kind]) + size + data)


class Handle:
    """A point mass in the hand. Axes of the device: x right, y away from the operator, z up."""

    def __init__(self, args):
        self.args = args
        self.center = [0.0, -0.12, 0.15]
        self.position = list(self.center)
        self.velocity = [0.0, 0.0, 0.0]
        self.force = [0.0, 0.0, 0.0]
        self.begin = self.last = time.monotonic()

    def wanted(self):
        phase = 2.0 * math.pi * (self.last - self.begin) / self.args.period
        x = self.args.radius * math.sin(phase)
        z = self.args.radius * (math.cos(phase) - 1.0)  # down, and up again
        return [self.center[0] + x, self.center[1], self.center[2] + z]

    def advance(self):
        """The force of the last command has acted until now."""
        now = time.monotonic()
        passed = min(now - self.last, 0.05)
        self.last = now
        steps = max(1, round(passed / 5e-4))
        step = passed / steps
        for _ in range(steps):
            for i, wanted in enumerate(self.wanted()):
                hand = 200.0 * (wanted - self.position[i]) - 8.0 * self.velocity[i]
                self.velocity[i] += step / 0.1 * (hand + self.force[i])
                self.position[i] += step * self.velocity[i]

    def obey(self, message):
        for device in message.get("inverse3", []):
            values = device.get("commands", {}).get("set_cursor_force", {}).get("values")
            if values:
                self.force = [float(values[axis]) for axis in "xyz"]

    def state(self):
        def vector(v):
            return dict(zip("xyz", v))

        update = {"inverse3": [{
            "device_id": "FAKE", "status": {"calibrated": True},
            "state": {"cursor_position": vector(self.position),
                      "cursor_velocity": vector(self.velocity),
                      "current_cursor_force": vector(self.force)}}]}
        if self.args.grip:
            # Down after a while: what is down from the start does not count as a press.
            down = self.args.press if self.last - self.begin > 1.0 else None
            buttons = {name: name == down for name in "abc"}
            update["wireless_verse_grip"] = [{
                "device_id": "FAKE_GRIP",
                "state": {"orientation": {"w": 1.0, "x": 0.0, "y": 0.0, "z": 0.0},
                          "buttons": buttons}}]
        return json.dumps(update).encode()


def attend(connection, handle, end):
    """One answer to each message, after a greeting."""
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    client = WebSocket(connection)
    client.send(handle.state())
    shown = time.monotonic()
    while time.monotonic() < end:
        message = json.loads(client.receive())
        handle.advance()
        handle.obey(message)
        client.send(handle.state())
        if handle.last - shown > 0.5:
            shown = handle.last
            print("force [N]  " + "  ".join(f"{f:+.2f}" for f in handle.force), flush=True)


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--port", type=int, default=10001)
    parser.add_argument("--radius", type=float, default=0.03, help="of the circle [m]")
    parser.add_argument("--period", type=float, default=8.0, help="of the circle [s]")
    parser.add_argument("--seconds", type=float, default=0.0, help="to run; 0: until Ctrl-C")
    parser.add_argument("--grip", action="store_true", help="there is a VerseGrip, which is still")
    parser.add_argument("--press", choices="abc", help="a button of it, down after a second, for a clutch")
    args = parser.parse_args()
    if not (args.period > 0.0 and 0.0 <= args.radius <= 0.1):
        parser.error("needs --period > 0, --radius from 0 to 0.1")
    return args


def main():
    args = arguments()
    end = time.monotonic() + args.seconds if args.seconds else math.inf
    with socket.create_server(("127.0.0.1", args.port)) as server:
        server.settimeout(0.5)
        print(f"listening on ws://127.0.0.1:{args.port}", flush=True)
        try:
            while time.monotonic() < end:
                try:
                    connection, _ = server.accept()
                except TimeoutError:
                    continue
                connection.settimeout(1.0)
                print("a program has come", flush=True)
                try:
                    with connection:
                        attend(connection, Handle(args), end)
                except (Gone, OSError, ValueError):
                    pass
                print("it has gone", flush=True)
        except KeyboardInterrupt:
            pass


if __name__ == "__main__":
    main()
