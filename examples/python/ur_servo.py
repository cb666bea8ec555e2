# SPDX-License-Identifier: BSD-3-Clause
"""A UR5e by ur_rtde: servoJ takes it to a wall that is in the model alone."""

from __future__ import annotations

import sys

import numpy as np
from rtde_control import RTDEControlInterface
from rtde_receive import RTDEReceiveInterface

import repel

RATE = 500.0  # [Hz]
RESPONSE = 0.04  # [s] from a commanded rate to the rate of the arm, as measured
MOST_RATE = 0.5  # [rad/s] of a joint; a blocked arm is sent ahead by this within its response
LOOKAHEAD, GAIN = 0.03, 300.0  # of servoJ
# Denavit-Hartenberg parameters of the maker [m], [rad]; efforts of its robot description [N m].
D = (0.1625, 0.0, 0.0, 0.1333, 0.0997, 0.0996)
A = (0.0, -0.425, -0.3922, 0.0, 0.0, 0.0)
ALPHA = (np.pi / 2, 0.0, 0.0, np.pi / 2, -np.pi / 2, 0.0)
EFFORT = (150.0, 150.0, 150.0, 28.0, 28.0, 28.0)


def ur5e(start: list[float]) -> repel.Arm:
    """The tool frame is the flange."""
    links, X = [], np.eye(4)
    for i, (d, a, alpha, effort) in enumerate(zip(D, A, ALPHA, EFFORT)):
        reach = np.pi if i == 2 else 2 * np.pi
        links.append(repel.Link(f"joint {i + 1}", X_PJ=X, lower=-reach, upper=reach,
                                velocity_limit=MOST_RATE, effort_limit=effort))
        c, s = np.cos(alpha), np.sin(alpha)
        X = np.array([[1, 0, 0, a], [0, c, -s, 0], [0, s, c, d], [0, 0, 0, 1]])
    return repel.Arm(links, X_LT=X, start=start, has_brakes=True,
                     parts=[repel.Part("ball", repel.Shape.sphere(0.05))],
                     admittance=repel.Admittance(response=RESPONSE, acceleration=10.0,
                                                 inertia=[2.0, 2.0, 1.0, 0.2, 0.2, 0.2]))


def main(address: str, seconds: float) -> None:
    control, receive = RTDEControlInterface(address, RATE), RTDEReceiveInterface(address, RATE)
    wall = repel.Obstacle("wall", repel.Shape.box([0.1, 0.5, 0.5]),
                          ([-0.7, -0.13, 0.5], [1, 0, 0, 0]))
    cell = repel.Cell(rate_hz=RATE, arms=[ur5e(receive.getActualQ())], obstacles=[wall])
    hand = repel.Command(linear=[-0.1, 0, 0])  # of your master: 100 mm/s towards the wall
    said = 0
    try:
        while True:
            start = control.initPeriod()
            now = round(1e9 * receive.getTimestamp())
            tick = cell.step(receive.getActualQ(), receive.getActualQd(), hand, now)
            if tick.brakes or receive.isProtectiveStopped() or receive.isEmergencyStopped():
                raise RuntimeError(f"the arm stops: {', '.join(tick.status)}")
            assert tick.positions is not None
            control.servoJ(list(tick.positions), 0.0, 0.0, 1.0 / RATE, LOOKAHEAD, GAIN)
            if tick.time >= said:
                print(f"{tick.time:.1f} s: {1e3 * tick.nearest:.1f} mm from the wall, "
                      f"{tick.peak_force:.1f} N")
                said += 1
            if tick.time > seconds:
                return
            control.waitPeriod(start)
    finally:
        control.servoStop()


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 60.0)
