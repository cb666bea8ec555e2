# SPDX-License-Identifier: BSD-3-Clause
"""Stand-in for rtde_receive of ur_rtde: what the arm of rtde_control reports."""

from rtde_control import ROBOT


class RTDEReceiveInterface:
    def __init__(self, hostname, frequency=-1.0):
        pass

    def getActualQ(self):
        return list(ROBOT.q)

    def getActualQd(self):
        return list(ROBOT.v)

    def getTimestamp(self):
        return ROBOT.time

    def isProtectiveStopped(self):
        return False

    def isEmergencyStopped(self):
        return False
