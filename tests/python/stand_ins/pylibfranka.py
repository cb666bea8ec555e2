# SPDX-License-Identifier: BSD-3-Clause
"""Stand-in for pylibfranka, with the names and signatures of what the example uses, and a simulated
arm in place of the robot: joints as in the maker's table, masses invented. Time is simulated."""

import copy
import enum

import numpy as np

A = (0.0, 0.0, 0.0, 0.0825, -0.0825, 0.0, 0.088, 0.0)  # [m]
D = (0.333, 0.0, 0.316, 0.0, 0.384, 0.0, 0.0, 0.107)  # [m]
ALPHA = (0.0, -np.pi / 2, np.pi / 2, np.pi / 2, -np.pi / 2, np.pi / 2, np.pi / 2, 0.0)
MASSES = (4.0, 4.0, 3.0, 3.0, 3.0, 2.0, 1.5)  # [kg] a point on each link


def frames(q):
    at, found = np.eye(4), []
    for a, d, alpha, angle in zip(A, D, ALPHA, [*q, 0.0]):
        ca, sa, c, s = np.cos(alpha), np.sin(alpha), np.cos(angle), np.sin(angle)
        at = at @ [[c, -s, 0, a], [s * ca, c * ca, -sa, -sa * d], [s * sa, c * sa, ca, ca * d],
                   [0, 0, 0, 1]]
        found.append(at)
    return found


def jacobian(X, link, p):
    J = np.zeros((6, 7))
    for i in range(link + 1):
        axis = X[i][:3, 2]
        J[:3, i], J[3:, i] = np.cross(axis, p - X[i][:3, 3]), axis
    return J


def inertia(q):
    X, M = frames(q), 0.1 * np.eye(7)  # rotors
    for link, mass in enumerate(MASSES):
        J = jacobian(X, link, X[link][:3, 3])[:3]
        M += mass * J.T @ J
    return M


class RobotMode(enum.Enum):
    Other, Idle, Move, Guiding, Reflex, UserStopped, AutomaticErrorRecovery = range(7)


class RealtimeConfig(enum.Enum):
    kEnforce, kIgnore = range(2)


class ControlException(RuntimeError):
    pass


class Duration:
    def __init__(self, seconds):
        self._seconds = seconds

    def to_sec(self):
        return self._seconds


class RobotState:
    def __init__(self):
        self.q = [0.0, -np.pi / 4, 0.0, -3 * np.pi / 4, 0.0, np.pi / 2, np.pi / 4]
        self.dq, self.tau_J_d = [0.0] * 7, [0.0] * 7
        self.F_T_EE = list(np.eye(4).ravel())
        self.robot_mode, self.time = RobotMode.Idle, Duration(1.0)

    @property
    def O_T_EE(self):
        return list((frames(self.q)[7] @ np.reshape(self.F_T_EE, (4, 4)).T).T.ravel())


class Torques:
    def __init__(self, tau_J, /):
        if len(tau_J) != 7:
            raise TypeError("incompatible constructor arguments")
        self.tau_J, self.motion_finished = list(tau_J), False


class Model:
    def mass(self, state, /):
        return list(inertia(state.q).ravel())

    def zero_jacobian(self, state, /):
        X = frames(state.q)
        p = np.reshape(state.O_T_EE, (4, 4))[3, :3]
        return list(jacobian(X, 6, p).T.ravel())


class ActiveControlBase:
    def __init__(self, robot):
        self._robot, self._has_begun = robot, False

    def readOnce(self):
        return copy.deepcopy(self._robot.state), Duration(1e-3 if self._has_begun else 0.0)

    def writeOnce(self, command, /):
        self._has_begun = True
        self._robot.obey(command)


class Robot:
    made = None  # the last one, for the test

    def __init__(self, robot_ip_address, realtime_config=RealtimeConfig.kEnforce):
        self.state = RobotState()
        self.fastest_change = 0.0  # [N m/s] of a torque
        Robot.made = self

    def load_model(self):
        return Model()

    def read_once(self):
        return copy.deepcopy(self.state)

    def set_collision_behavior(self, lower_torque_thresholds, upper_torque_thresholds,
                               lower_force_thresholds, upper_force_thresholds):
        pass

    def start_torque_control(self):
        self.state.robot_mode = RobotMode.Move
        return ActiveControlBase(self)

    def stop(self):
        self.state.robot_mode, self.state.dq = RobotMode.Idle, [0.0] * 7

    def obey(self, command):
        s = self.state
        change = 1e3 * np.abs(np.subtract(command.tau_J, s.tau_J_d)).max()
        self.fastest_change = max(self.fastest_change, change)
        if not change <= 1000.0:
            self.stop()
            raise ControlException("controller_torque_discontinuity")
        s.tau_J_d = command.tau_J
        s.dq = list(s.dq + 1e-3 * np.linalg.solve(inertia(s.q), s.tau_J_d))
        s.q = list(np.add(s.q, 1e-3 * np.array(s.dq)))
        s.time = Duration(s.time.to_sec() + 1e-3)
        if command.motion_finished:
            self.stop()
