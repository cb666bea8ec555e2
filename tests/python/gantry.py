# SPDX-License-Identifier: BSD-3-Clause
"""The gantry of examples/03_own_controller.cpp: three rails, 4 kg on each, and a wall."""

import numpy as np

import repel


class Gantry:
    def __init__(self):
        self.p = np.zeros(3)

    def update(self, q):
        self.p = np.array(q)

    def X_WT(self):
        X = np.eye(4)
        X[:3, 3] = self.p
        return X

    def tool_jacobian(self):
        return np.eye(6, 3)

    def gravity_torques(self):
        return np.array([0.0, 0.0, 4.0 * 9.81])


def gantry_cell(kinematics=None, loose=(), limits=None, **change):
    rails = [repel.Link(f"rail {axis}", type="prismatic", lower=-1.0, upper=1.0,
                        viscous_friction=300.0, rotor_inertia=4.0) for axis in "xyz"]
    arm = repel.Arm(**{"links": rails, "kinematics": kinematics or Gantry(),
                       "parts": [repel.Part("ball", repel.Shape.sphere(0.05))], **change})
    wall = repel.Obstacle("wall", repel.Shape.box([0.1, 1.0, 1.0]), ([0.35, 0, 0], [1, 0, 0, 0]))
    return repel.Cell(rate_hz=1000.0, arms=[arm], obstacles=[wall], loose=loose, limits=limits)
