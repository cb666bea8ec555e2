# SPDX-License-Identifier: BSD-3-Clause
"""Stand-in for rtde_control of ur_rtde, with a simulated arm: six joints that follow the commands
of servoJ after a dead time of four periods, with a lag. Time is simulated."""

import datetime

import numpy as np


class Simulated:
    def __init__(self):
        self.q = np.array([0.0, -np.pi / 2, np.pi / 2, -np.pi / 2, -np.pi / 2, 0.0])
        self.v, self.time, self.under_way = np.zeros(6), 100.0, []
        self.is_servoing = False

    def move(self, period, lag):
        self.time += period
        if len(self.under_way) > 4:
            way = (1.0 - np.exp(-period / lag)) * (self.under_way.pop(0) - self.q)
            self.q, self.v = self.q + way, way / period


ROBOT = Simulated()


class RTDEControlInterface:
    def __init__(self, hostname, frequency=-1.0):
        self._period, self._lag = 1.0 / frequency, 0.03

    def initPeriod(self):
        return datetime.timedelta()

    def waitPeriod(self, start, /):
        ROBOT.move(self._period, self._lag)

    def servoJ(self, q, speed, acceleration, time, lookahead_time, gain, /):
        assert len(q) == 6 and 0.03 <= lookahead_time <= 0.2 and 100 <= gain <= 2000
        self._lag, ROBOT.is_servoing = lookahead_time, True
        ROBOT.under_way.append(np.array(q))
        return True

    def servoStop(self, a=10.0):
        ROBOT.is_servoing = False
        return True
