#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Stands in for spacenavd: plays a slow circle of a six-axis mouse on a socket.

    examples/fake_spacenavd.py /tmp/spnav.sock &
    SPNAV_SOCKET=/tmp/spnav.sock teleop ...

Any number of programs may listen. Ends by Ctrl-C, or after --seconds, with the mouse at rest.
"""

import argparse
import math
import os
import select
import socket
import struct
import sys
import time


def packet(kind, *values):
    """An event of protocol version 0: eight int32 of the machine's own byte order."""
    return struct.pack("=8i", kind, *values, *[0] * (7 - len(values)))


def motion(x, y, z, period_ms):
    return packet(0, x, y, z, 0, 0, 0, period_ms)


def listen(path):
    server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    if os.path.exists(path):
        if server.connect_ex(path) == 0:
            sys.exit(f"{path}: somebody listens there already")
        os.unlink(path)
        server = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    server.bind(path)
    server.listen(8)
    server.setblocking(False)
    return server


class Clients:
    def __init__(self, server, greeting):
        self.server = server
        self.greeting = greeting
        self.sockets = []

    def accept(self):
        while select.select([self.server], [], [], 0)[0]:
            client, _ = self.server.accept()
            client.setblocking(False)
            self.sockets.append(client)
            print(f"{len(self.sockets)} listening", flush=True)
            if self.greeting:
                self.send(self.greeting, [client])

    def send(self, data, to=None):
        for client in list(to or self.sockets):
            try:
                client.send(data)
            except BlockingIOError:
                pass  # like the daemon: a client that does not read loses events
            except OSError:
                self.sockets.remove(client)
                client.close()
                print(f"{len(self.sockets)} listening", flush=True)


def play(clients, args):
    """The circle: x to the right and z forward, one period after the other."""
    begin = time.monotonic()
    step = 1.0 / args.hz
    ticks = 0
    while not args.seconds or ticks * step < args.seconds:
        clients.accept()
        phase = 2.0 * math.pi * ticks * step / args.period
        x = round(args.counts * math.sin(phase))
        z = round(args.counts * math.cos(phase))
        clients.send(motion(x, 0, z, round(1000 * step)))
        ticks += 1
        time.sleep(max(0.0, begin + ticks * step - time.monotonic()))


def arguments():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("path", help="of the socket; it is made, and removed at the end")
    parser.add_argument("--counts", type=int, default=120, help="deflection; full is about 350")
    parser.add_argument("--period", type=float, default=8.0, help="of the circle [s]")
    parser.add_argument("--hz", type=float, default=60.0, help="events per second")
    parser.add_argument("--seconds", type=float, default=0.0, help="to play; 0: until Ctrl-C")
    parser.add_argument("--press", type=int, metavar="BUTTON",
                        help="a button that is down all the time, for a clutch")
    args = parser.parse_args()
    if not (args.period > 0.0 and 1.0 <= args.hz <= 1000.0 and abs(args.counts) <= 100000):
        parser.error("needs --period > 0, --hz from 1 to 1000, --counts within 100000")
    return args


def main():
    args = arguments()
    server = listen(args.path)
    greeting = b"" if args.press is None else packet(1, args.press)
    clients = Clients(server, greeting)
    try:
        play(clients, args)
    except KeyboardInterrupt:
        pass
    finally:
        if args.press is not None:
            clients.send(packet(2, args.press))
        clients.send(motion(0, 0, 0, 0))
        server.close()
        os.unlink(args.path)


if __name__ == "__main__":
    main()
