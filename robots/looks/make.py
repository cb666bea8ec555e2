#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""make.py [--check]: writes the meshes that the robots look like into this folder, as OBJ in
metres, or says which of them are others.

Each is in the frame of its link in puma560.urdf or long_reach.urdf, one file for each colour of a
link. Bodies may pass through each other. Only the standard library is needed, and coordinates are
rounded, so that every machine writes the same bytes.
"""

import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
ARC = math.pi / 8  # of a rounding, between two points
CHAMFER = 0.005  # radius up to which an edge is cut off straight


# --- Outlines: points in a plane.


def rounded(corners, closed=False):
    """A line through corners `(x, y)`, of which `(x, y, radius)` are rounded."""
    line = []
    for i, (x, y, *radius) in enumerate(corners):
        inside = closed or 0 < i < len(corners) - 1
        if not radius or not inside:
            line.append((x, y))
            continue
        before, after = corners[i - 1], corners[(i + 1) % len(corners)]
        start, end = (math.atan2(p[1] - y, p[0] - x) for p in (before, after))
        turn = math.remainder(end - start, 2 * math.pi)
        half = turn / 2
        reach = radius[0] / math.sin(abs(half))
        middle = (x + reach * math.cos(start + half), y + reach * math.sin(start + half))
        sweep = math.copysign(math.pi, turn) - turn
        first = start - math.copysign(math.pi / 2, turn)
        steps = 1 if radius[0] <= CHAMFER else math.ceil(abs(sweep) / ARC)
        line += [(middle[0] + radius[0] * math.cos(first - sweep * k / steps),
                  middle[1] + radius[0] * math.sin(first - sweep * k / steps))
                 for k in range(steps + 1)]
    return line


def inset(outline, distance):
    """A closed outline, counter-clockwise, moved inwards."""
    moved = []
    for i, (x, y) in enumerate(outline):
        (ax, ay), (bx, by) = outline[i - 1], outline[(i + 1) % len(outline)]
        inwards = math.atan2(x - ax, ay - y)  # of the side before; `half` a turn to the one behind
        half = math.remainder(math.atan2(bx - x, y - by) - inwards, 2 * math.pi) / 2
        reach = distance / math.cos(half)
        moved.append((x + reach * math.cos(inwards + half), y + reach * math.sin(inwards + half)))
    return moved


# --- Bodies: lists of triangles, counter-clockwise seen from outside.


def skin(rings):
    """Around closed rings of equally many points, and over both ends."""
    triangles = []
    for low, high in zip(rings, rings[1:]):
        for i in range(len(low)):
            a, b, c, d = low[i - 1], low[i], high[i], high[i - 1]
            triangles += [(a, b, c), (a, c, d)]
    first, last = rings[0], rings[-1]
    for i in range(2, len(first)):
        triangles += [(first[0], first[i], first[i - 1]), (last[0], last[i - 1], last[i])]
    return triangles


def turned(profile, sides=40):
    """Around the z axis: a line of `(radius, z)` from the lower end to the upper one."""
    angles = [2 * math.pi * i / sides for i in range(sides)]
    return skin([[(r * math.cos(a), r * math.sin(a), z) for a in angles]
                 for r, z in rounded(profile)])


def plate(corners, low, high, bevel):
    """Between two heights, with an outline in the x-y plane and rounded edges."""
    outline = rounded(corners, closed=True)
    edge = rounded([(bevel, low), (0, low, bevel), (0, high, bevel), (bevel, high)])
    return skin([[(x, y, z) for x, y in inset(outline, distance)] for distance, z in edge])


def disc(radius, low, high, bevel, sides=40):
    return turned([(0, low), (radius, low, bevel), (radius, high, bevel), (0, high)], sides)


def mapped(body, f):
    return [tuple(f(*p) for p in triangle) for triangle in body]


def at(x, y, z, body):
    return mapped(body, lambda a, b, c: (a + x, b + y, c + z))


def along_y(body):
    """Turned about the x axis: what was up points along y, what was along y points down."""
    return mapped(body, lambda x, y, z: (x, z, -y))


def obj(bodies):
    """The text of a file. Points in one place are one vertex; what has no extent is left out."""
    vertices, faces = {}, []
    for triangle in sum(bodies, []):
        rows = ["v " + " ".join(f"{round(c, 5) + 0.0:.5g}" for c in p) for p in triangle]
        corners = [vertices.setdefault(row, len(vertices) + 1) for row in rows]
        if len(set(corners)) == 3:
            faces.append("f {} {} {}".format(*corners))
    return "\n".join(["# SPDX-" "License-Identifier: BSD-3-Clause", *vertices, *faces, ""])


# --- The robots: the bodies of each file.


def puma560():
    """Of Unimation, from its published dimensions: a2 0.4318, a3 0.0203, d3 0.15005, d4 0.4318,
    flange 0.05334, height of the shoulder 0.672; the rest as its housings are known."""
    bolts = [at(0.158 * math.cos(a), 0.158 * math.sin(a), 0, disc(0.009, 0.03, 0.037, 0.002, 12))
             for a in (math.pi * (2 * k + 1) / 8 for k in range(8))]
    sockets = [(-0.145, -0.045, 0.012), (-0.08, -0.045), (-0.08, 0.045), (-0.145, 0.045, 0.012)]
    panel = [(-0.1495, -0.034), (-0.1415, -0.034), (-0.1415, 0.034), (-0.1495, 0.034)]
    arm = [(-0.229, -0.136, 0.05), (-0.01, -0.144, 0.3), (0.509, -0.073, 0.08),
           (0.509, 0.073, 0.08), (-0.01, 0.144, 0.3), (-0.229, 0.136, 0.05)]
    cover = [(-0.201, -0.108, 0.03), (-0.01, -0.116, 0.3), (0.36, -0.065, 0.02),
             (0.36, 0.065, 0.02), (-0.01, 0.116, 0.3), (-0.201, 0.108, 0.03)]
    forearm = [(-0.058, -0.079, 0.03), (0.0985, -0.079, 0.03), (0.1, 0.05, 0.2),
               (0.0625, 0.36, 0.01), (-0.0219, 0.36, 0.01), (-0.0595, 0.05, 0.2)]
    cheek = [(-0.036, -0.4678, 0.0355), (0.036, -0.4678, 0.0355),
             (0.036, -0.37, 0.01), (-0.036, -0.37, 0.01)]

    def thinner(x, y, z):  # towards the wrist
        return x, y, 0.15005 + (z - 0.15005) * (1 - 0.5 * max(0.0, y - 0.05))

    return {
        "base": [  # foot and column
            turned([(0.18, 0), (0.18, 0.03, 0.005), (0.13, 0.03, 0.01), (0.118, 0.12, 0.06),
                    (0.092, 0.15, 0.06), (0.09, 0.548)], 48),
            plate(sockets, 0.025, 0.105, 0.008)],
        "base_dark": [
            *bolts, plate(panel, 0.045, 0.093, 0.002),
            turned([(0.09, 0.544), (0.094, 0.544, 0.002), (0.094, 0.559, 0.002), (0.08, 0.559)],
                   48)],
        "link_1": [  # neck, and the drum along the axis of joint 2
            turned([(0.09, -0.111), (0.09, -0.058, 0.02), (0.04, -0.05)], 48),
            along_y(turned([(0.078, -0.178), (0.08, -0.176), (0.08, 0.09, 0.022), (0.03, 0.09)],
                           48))],
        "link_1_dark": [
            along_y(turned([(0.084, -0.1905, 0.003), (0.084, -0.172, 0.003), (0.078, -0.172)],
                           48)),
            along_y(disc(0.05, 0.086, 0.093, 0.003))],
        "link_2": [plate(arm, 0.1915, 0.2915, 0.014)],
        "link_2_cover": [plate(cover, 0.285, 0.2945, 0.002)],
        "link_2_dark": [  # caps on the axes of joints 2 and 3, and the hub of joint 3
            disc(0.06, 0.29, 0.2985, 0.003), at(0.4318, 0, 0, disc(0.045, 0.285, 0.2965, 0.003)),
            at(0.4318, 0, 0, disc(0.055, 0.187, 0.195, 0.002))],
        "link_3": [mapped(plate(forearm, 0.1095, 0.19, 0.012), thinner)],
        "link_3_dark": [disc(0.045, 0.1045, 0.112, 0.003)],
        "link_4": [  # collar behind the wrist, and the fork of joint 5
            turned([(0.03, 0.357), (0.044, 0.357, 0.003), (0.044, 0.388, 0.008), (0.02, 0.388)]),
            along_y(plate(cheek, -0.047, -0.034, 0.003)),
            along_y(plate(cheek, 0.034, 0.047, 0.003))],
        "link_5": [
            turned([(0.024, -0.033), (0.037, -0.033, 0.012), (0.037, 0.033, 0.012),
                    (0.024, 0.033)]),
            along_y(turned([(0.03, 0.01), (0.03, 0.032), (0.026, 0.038)]))],
        "link_6": [turned([(0.022, 0.03), (0.022, 0.0435)])],
        "flange": [disc(0.025, -0.01, 0, 0.001)],
    }


def long_reach():
    """Tubes between knuckles."""
    def knuckle(radius, half):
        return along_y(disc(radius, -half, half, 0.012))

    return {
        "mast": [turned([(0.098, -5), (0.098, -0.06), (0.104, -0.05), (0.104, -0.002, 0.002),
                         (0.06, -0.002)])],
        "head": [turned([(0.08, 0.002), (0.11, 0.002, 0.008), (0.11, 0.13, 0.03), (0.07, 0.2)])],
        "boom": [turned([(0.078, 0.05), (0.078, 0.14, 0.02), (0.07, 0.17, 0.02), (0.07, 1.34, 0.02),
                         (0.075, 1.37, 0.02), (0.075, 1.45)])],
        "boom_dark": [knuckle(0.088, 0.085)],
        "forearm": [turned([(0.06, 0.04), (0.06, 0.12, 0.02), (0.052, 0.15, 0.02),
                            (0.052, 1.1, 0.02), (0.06, 1.13, 0.02), (0.06, 1.198, 0.004),
                            (0.03, 1.198)])],
        "forearm_dark": [knuckle(0.08, 0.075)],
        "wrist": [turned([(0.04, 0.002), (0.06, 0.002, 0.004), (0.06, 0.07, 0.02), (0.04, 0.11)])],
        "hand": [turned([(0.045, 0), (0.045, 0.03, 0.01), (0.05, 0.04, 0.01), (0.05, 0.12, 0.006),
                         (0.02, 0.12)])],
        "hand_dark": [knuckle(0.05, 0.055)],
    }


def main():
    files = {HERE / f"{robot.__name__}_{name}.obj": obj(bodies)
             for robot in (puma560, long_reach) for name, bodies in robot().items()}
    if sys.argv[1:] == ["--check"]:
        there = set(HERE.glob("*.obj"))
        stale = [path for path in there | files.keys()
                 if path not in there or path.read_text(encoding="ascii") != files.get(path)]
        sys.exit(f"not what {__file__} writes: {', '.join(sorted(map(str, stale)))}"
                 if stale else 0)
    for path, text in files.items():
        path.write_text(text, encoding="ascii")


if __name__ == "__main__":
    main()
