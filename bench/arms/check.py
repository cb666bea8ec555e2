#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the arms of this folder: check.py ROBOT_INFO, the path of that program.

Each file must load, and at its ready pose the tool must be where the table says, pointing down, with
every joint well inside its limits. Exits with 1 otherwise.
"""

import math
import pathlib
import subprocess
import sys
import xml.etree.ElementTree as xml

here = pathlib.Path(__file__).resolve().parent

# File, joints beside the arm that are held, frame of the tool, ready pose [deg], place of the tool there [mm].
arms = [
    ("ur3", [], "tool0", [0, -90, 90, -90, -90, 0], (298.6, 112.35, 313.65)),
    ("ur5", [], "tool0", [0, -90, 90, -90, -90, 0], (486.9, 109.15, 431.859)),
    ("ur10", [], "tool0", [0, -90, 90, -90, -90, 0], (688.0, 163.941, 647.1)),
    ("panda", ["panda_finger_joint1", "panda_finger_joint2"], "panda_hand_tcp",
     [0, -45, 0, -135, 0, 90, 45], (306.891, 0, 486.882)),
    ("kinova_gen3", [], "end_effector_link", [0, 15, 180, -130, 0, -35, 90],
     (289.21, 1.35, 266.269)),
    ("z1", ["jointGripper"], "tool0", [0, 80, -60, 70, 0, 0], (163.571, 0, 256.985)),
    ("xarm7", [], "link_eef", [0, -20, 0, 70, 0, 90, 0], (367.622, 0, 540.786)),
    ("iiwa14", [], "iiwa_link_ee_kuka", [0, 30, 0, -90, 0, 60, 0], (556.41, 0, 397.731)),
]
least_margin = 15.0  # [deg] from every limit
tolerance = 0.01  # [mm]


def numbers(element, key):
    text = "0 0 0" if element is None else element.get(key, "0 0 0")
    return [float(word) for word in text.split()]


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(4)]


def about(axis, angle):
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    v = 1 - c
    return [[x * x * v + c, x * y * v - z * s, x * z * v + y * s, 0],
            [y * x * v + z * s, y * y * v + c, y * z * v - x * s, 0],
            [z * x * v - y * s, z * y * v + x * s, z * z * v + c, 0],
            [0, 0, 0, 1]]


def origin(joint):
    element = joint.find("origin")
    roll, pitch, yaw = numbers(element, "rpy")
    pose = times(times(about((0, 0, 1), yaw), about((0, 1, 0), pitch)), about((1, 0, 0), roll))
    for row, value in zip(pose, numbers(element, "xyz")):
        row[3] = value
    return pose


def forward(robot, held, ready, tip):
    """Pose of the tip, and the least distance of a joint from its limits [deg]."""
    joints = {joint.find("child").get("link"): joint for joint in robot.findall("joint")}
    chain = []
    while tip in joints:
        chain.insert(0, joints[tip])
        tip = joints[tip].find("parent").get("link")
    moving = [j for j in chain if j.get("type") != "fixed" and j.get("name") not in held]
    angles = {joint.get("name"): angle for joint, angle in zip(moving, ready, strict=True)}
    pose = about((0, 0, 1), 0)
    margin = math.inf
    for joint in chain:
        pose = times(pose, origin(joint))
        if joint.get("name") not in angles:
            continue
        angle = angles[joint.get("name")]
        pose = times(pose, about(numbers(joint.find("axis"), "xyz"), math.radians(angle)))
        limit = joint.find("limit")
        if limit.get("lower") is not None:
            margin = min(margin, angle - math.degrees(float(limit.get("lower"))),
                         math.degrees(float(limit.get("upper"))) - angle)
    return pose, margin


def faults(robot_info, name, held, tip, ready, place):
    path = here / f"{name}.urdf"
    command = [robot_info, str(path), "--tip", tip]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode != 0:
        yield run.stderr.strip() or f"robot_info exits with {run.returncode}"
    pose, margin = forward(xml.parse(path).getroot(), held, ready, tip)
    off = math.dist(place, [1000 * pose[i][3] for i in range(3)])
    if off > tolerance:
        yield f"the tool is {off:.3f} mm from its place"
    if pose[2][2] > -0.999999:
        yield "the tool does not point down"
    if margin < least_margin:
        yield f"a joint is {margin:.1f} deg from its limit"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    listed = {arm[0] for arm in arms}
    failed = [f"{path.name}: not in the table" for path in sorted(here.glob("*.urdf"))
              if path.stem not in listed]
    for arm in arms:
        failed += [f"{arm[0]}: {fault}" for fault in faults(sys.argv[1], *arm)]
    print("\n".join(failed) or f"{len(arms)} arms load, and stand ready as stated")
    sys.exit(1 if failed else 0)


main()
