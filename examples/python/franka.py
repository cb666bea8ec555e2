# SPDX-License-Identifier: BSD-3-Clause
"""An arm of Franka Robotics by pylibfranka, its tool driven into a wall that is in the model alone.

Python cannot promise 1 kHz: this is for trying things out. C++ is examples/adapters/torque_callback.
"""

from __future__ import annotations

import sys

import numpy as np
from pylibfranka import Model, RealtimeConfig, Robot, RobotMode, RobotState, Torques

import repel

# Modified Denavit-Hartenberg parameters of the maker: joints 1 to 7, then the flange.
A = (0.0, 0.0, 0.0, 0.0825, -0.0825, 0.0, 0.088, 0.0)  # [m]
D = (0.333, 0.0, 0.316, 0.0, 0.384, 0.0, 0.0, 0.107)  # [m]
ALPHA = (0.0, -np.pi / 2, np.pi / 2, np.pi / 2, -np.pi / 2, np.pi / 2, np.pi / 2, 0.0)
# Limits of the first arm (FER): lower and upper [rad], rate [rad/s], torque [N m].
LIMITS = ((-2.8973, 2.8973, 2.175, 87.0), (-1.7628, 1.7628, 2.175, 87.0),
          (-2.8973, 2.8973, 2.175, 87.0), (-3.0718, -0.0698, 2.175, 87.0),
          (-2.8973, 2.8973, 2.61, 12.0), (-0.0175, 3.7525, 2.61, 12.0),
          (-2.8973, 2.8973, 2.61, 12.0))


class Franka:
    """Poses from the table; Jacobian and inertia from the model of the robot."""

    def __init__(self, model: Model, state: RobotState) -> None:
        self.model, self.state = model, state
        self.X_FT = np.reshape(state.F_T_EE, (4, 4)).T

    def update(self, q: np.ndarray) -> None:
        self.state.q = list(q)

    def X_WT(self) -> np.ndarray:
        X = np.eye(4)
        for a, d, alpha, angle in zip(A, D, ALPHA, [*self.state.q, 0.0]):
            ca, sa, c, s = np.cos(alpha), np.sin(alpha), np.cos(angle), np.sin(angle)
            X = X @ np.array([[c, -s, 0, a], [s * ca, c * ca, -sa, -sa * d],
                              [s * sa, c * sa, ca, ca * d], [0, 0, 0, 1]])
        return X @ self.X_FT

    def tool_jacobian(self) -> np.ndarray:
        return np.reshape(self.model.zero_jacobian(self.state), (7, 6)).T  # it comes by columns

    def mass_matrix(self) -> np.ndarray:
        return np.reshape(self.model.mass(self.state), (7, 7))

    def gravity_torques(self) -> np.ndarray:
        return np.zeros(7)  # the robot holds its own weight


def main(address: str, seconds: float) -> None:
    robot = Robot(address, RealtimeConfig.kIgnore)
    state = robot.read_once()
    kinematics = Franka(robot.load_model(), robot.read_once())
    assert np.allclose(kinematics.X_WT(), np.reshape(state.O_T_EE, (4, 4)).T, atol=1e-3)
    joints = [repel.Link(f"joint {i + 1}", lower=lower, upper=upper, velocity_limit=rate,
                         effort_limit=torque)
              for i, (lower, upper, rate, torque) in enumerate(LIMITS)]
    arm = repel.Arm(joints, kinematics=kinematics, start=state.q, has_brakes=True,
                    parts=[repel.Part("ball", repel.Shape.sphere(0.05))])
    wall = repel.Obstacle("wall", repel.Shape.box([0.1, 0.5, 0.5]), ([0.55, 0, 0.5], [1, 0, 0, 0]))
    cell = repel.Cell(rate_hz=1000.0, arms=[arm], obstacles=[wall])
    hand = repel.Command(linear=[0.1, 0, 0])  # of your master: 100 mm/s towards the wall

    torques, most, said = np.zeros(7), 0.999, 0  # [N m] in a period: the robot aborts above 1
    control = robot.start_torque_control()
    try:
        while True:
            state, _ = control.readOnce()
            now = round(1e9 * state.time.to_sec())
            tick = cell.step(state.q, state.dq, hand, now)
            if tick.brakes or state.robot_mode != RobotMode.Move:
                raise RuntimeError(f"the arm stops: {', '.join(tick.status)}")
            torques = torques + np.clip(tick.torques - torques, -most, most)
            command = Torques(list(torques))
            command.motion_finished = bool(tick.time > seconds)
            control.writeOnce(command)
            if tick.time >= said:
                print(f"{tick.time:.1f} s: x {cell.X_WT()[0, 3]:.3f} m, "
                      f"wall {tick.peak_force:.1f} N")
                said += 1
            if command.motion_finished:
                return
    finally:
        robot.stop()


if __name__ == "__main__":
    main(sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 60.0)
