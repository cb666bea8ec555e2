# SPDX-License-Identifier: BSD-3-Clause
"""Your own arm, simulated in Python: a gantry whose tool is driven into a wall at 1 kHz."""

import numpy as np

import repel

MASS, FRICTION, WEIGHT = 4.0, 300.0, np.array([0.0, 0.0, 4.0 * 9.81])  # [kg], [N s/m], [N]


class Gantry:
    """Three rails along x, y and z."""

    def update(self, q):
        self.p = np.array(q)

    def X_WT(self):
        X = np.eye(4)
        X[:3, 3] = self.p
        return X

    def tool_jacobian(self):
        return np.eye(6, 3)

    def gravity_torques(self):
        return WEIGHT


rails = [repel.Link(f"rail {axis}", type="prismatic", lower=-1.0, upper=1.0, rotor_inertia=MASS,
                    viscous_friction=FRICTION) for axis in "xyz"]
arm = repel.Arm(rails, kinematics=Gantry(), parts=[repel.Part("ball", repel.Shape.sphere(0.05))])
wall = repel.Obstacle("wall", repel.Shape.box([0.1, 1.0, 1.0]), ([0.35, 0, 0], [1, 0, 0, 0]))
cell = repel.Cell(rate_hz=1000.0, arms=[arm], obstacles=[wall])  # every check runs here

q, v = np.zeros(3), np.zeros(3)  # what your drives report [m], [m/s]
hand = repel.Command(linear=[0.1, 0.0, 0.0])  # and your master: 100 mm/s towards the wall
for k in range(4001):
    tick = cell.step(q, v, hand)
    v = v + cell.period / MASS * (tick.torques - FRICTION * v - WEIGHT)  # in place of your drives
    q = q + cell.period * v
    if k % 500 == 0:
        print(f"x {q[0]:.3f} m, wall {tick.peak_force:.1f} N, {', '.join(tick.status) or 'ok'}")
