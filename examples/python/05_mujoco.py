# SPDX-License-Identifier: BSD-3-Clause
"""An arm of seven joints in MuJoCo, driven at 1 kHz among five geoms that it does not touch."""

import pathlib
import time

import mujoco
import numpy as np

import repel
import repel.mujoco

model = mujoco.MjModel.from_xml_path(str(pathlib.Path(__file__).with_suffix(".xml")))
data = mujoco.MjData(model)
mujoco.mj_resetDataKeyframe(model, data, 0)
sim = repel.mujoco.attach(model, data, site="tool")  # every check runs here
kinematics = repel.ArmKinematics(sim.arm)

contacts, force, apart, spent = 0, 0.0, 0.0, []
for way in [0.1, 0, 0], [0, 0.1, 0], [0, 0, -0.1], [-0.1, 0, 0], [0, -0.1, 0], [0.1, 0, -0.1]:
    hand = repel.Command(linear=way)  # what your master reports [m/s]
    for _ in range(2000):
        start = time.perf_counter()
        tick = sim.tick(hand)
        spent.append(time.perf_counter() - start)
        mujoco.mj_step(model, data)  # sim.step(hand) is both
        contacts, force = contacts + data.ncon, max(force, tick.peak_force)
    mujoco.mj_kinematics(model, data)
    kinematics.update(data.qpos)
    for part in sim.arm.parts:
        X_WP = kinematics.X_WL(part.link) @ part.X_FP
        for wall in sim.obstacles:
            pair = model.geom(part.name).id, model.geom(wall.name).id
            theirs = mujoco.mj_geomDistance(model, data, *pair, 10.0, None)
            ours = repel.separation(part.shape, X_WP, wall.shape, wall.X_WP).distance
            apart = max(apart, abs(ours - theirs))
print(f"{contacts} contacts, walls of up to {force:.0f} N")
print(f"{1e6 * np.median(spent):.0f} us for a tick; distances within {apart:.0e} m of MuJoCo's")
