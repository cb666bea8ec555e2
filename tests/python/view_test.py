# SPDX-License-Identifier: BSD-3-Clause
"""The live view of a cell that a program ticks."""

import base64
import contextlib
import json
import os
import re
import socket
import threading
import time
import urllib.request

import numpy as np
import pytest

import repel
from gantry import gantry_cell
from world_test import moved

if not hasattr(repel._repel, "LiveView"):
    pytest.skip("built without the live view", allow_module_level=True)


class Page:
    """A page as far as the tests need one: a WebSocket that says and hears JSON."""

    def __init__(self, url):
        self.place = re.fullmatch(r"http://(127\.0\.0\.1):(\d+)/", url)
        host, port = self.place[1], int(self.place[2])
        self.socket = socket.create_connection((host, port), timeout=10)
        self.stream = self.socket.makefile("rb")
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(f"GET /live HTTP/1.1\r\nHost: {host}:{port}\r\nOrigin: "
                            f"http://{host}:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n"
                            .encode())
        assert b" 101 " in self.stream.readline()
        while self.stream.readline().strip():
            pass

    def say(self, **message):
        text = json.dumps(message).encode()
        length = bytes([0x80 | len(text)]) if len(text) < 126 else \
            bytes([0x80 | 126]) + len(text).to_bytes(2, "big")
        self.socket.sendall(b"\x81" + length + bytes(4) + text)  # a mask of zeros

    def hear(self, kind):
        """The next message of that type."""
        text = b""
        while True:
            first, length = self.stream.read(2)
            if length > 125:
                length = int.from_bytes(self.stream.read(2 if length == 126 else 8), "big")
            part = self.stream.read(length)
            if first & 15 > 1:
                continue  # a ping
            text += part
            if first & 128 and json.loads(text)["type"] == kind:
                return json.loads(text)
            text = b"" if first & 128 else text

    def close(self):
        self.stream.close()
        self.socket.close()


@contextlib.contextmanager
def running(**options):
    """A gantry that is ticked beside the test, and its view. Yields both, and what was commanded."""
    spare = repel.Loose("spare", repel.Shape.sphere(0.01), room=0.3)
    cell, asked, adds, over = gantry_cell(loose=[spare]), [], [], threading.Event()

    def loop():
        q, v = np.zeros(3), np.zeros(3)
        while not over.is_set():
            command = view.command()
            if command is not None:
                asked.append(command)
            tick = cell.step(q, v, command or repel.Command())
            view.publish(compute=1e-4)
            v = v + 0.001 / 4.0 * (tick.torques - 300.0 * v - [0, 0, 4.0 * 9.81])
            q = q + 0.001 * v
            while adds and not over.is_set():
                cell.add(adds.pop(), moved(0, 0.5, 0))
            time.sleep(0.001)

    with repel.LiveView(cell, "gantry", port=0, **options) as view:
        thread = threading.Thread(target=loop)
        thread.start()
        try:
            yield Page(view.url), asked, adds
        finally:
            over.set()
            thread.join()


def test_a_page_sees_the_cell_and_the_new_shapes_of_its_parts():
    with running() as (page, asked, adds):
        scene = page.hear("scene")
        assert "gantry" in json.dumps(scene) and "wall" in json.dumps(scene)
        frames = [page.hear("frame") for _ in range(3)]
        assert frames[0]["tick"] < frames[2]["tick"] and frames[0]["running"]
        adds.append(repel.Shape.box([0.1, 0.1, 0.1]))
        assert page.hear("parts")
        page.say(type="take")
        assert "pages look on only" in page.hear("refused")["why"]
        assert asked == []
        page.close()


def test_a_page_drives_where_it_may():
    with running(pages_drive=True) as (page, asked, _):
        page.say(type="take")
        while not asked:
            page.say(type="servo_cv", linear=[0.1, 0, 0], angular=[0, 0, 0], frame="world",
                     clutch=True)
            page.hear("frame")
        while page.hear("frame")["arms"][0]["v"][0] < 0.02:
            page.say(type="servo_cv", linear=[0.1, 0, 0], angular=[0, 0, 0], frame="world",
                     clutch=True)
        assert max(command.linear[0] for command in asked) == pytest.approx(0.1)
        page.close()


def test_the_page_itself_is_in_the_package():
    view = repel.LiveView(gantry_cell(), port=0)
    with urllib.request.urlopen(view.url, timeout=10) as answer:
        assert b"<html" in answer.read()
    view.close()
    view.close()
    for ask in (view.command, lambda: view.url):
        with pytest.raises(repel.SetupError, match="the live view is closed"):
            ask()


def test_what_cannot_be_served_is_refused():
    cell = gantry_cell()
    with repel.LiveView(cell, port=0) as view:
        with pytest.raises(repel.SetupError, match="publish comes after a tick"):
            view.publish()
        with pytest.raises(repel.SetupError, match="127.0.0.1"):
            repel.LiveView(cell, port=int(view.url.rsplit(":", 1)[1].strip("/")))
    with pytest.raises(repel.SetupError, match="secret"):
        repel.LiveView(cell, address="0.0.0.0", port=0)
    with pytest.raises(repel.SetupError, match="port is 70000; allowed: 0 to 65535"):
        repel.LiveView(cell, port=70000)
    cell.step(np.zeros(3), np.zeros(3), repel.Command())
    with repel.LiveView(cell, port=0) as view:
        with pytest.raises(repel.SetupError, match="late is -1 s; allowed"):
            view.publish(late=-1.0)
