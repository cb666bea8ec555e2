#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""draw.py SCENE.yaml LOG.csv PICTURE.svg: a scene from the side and from above: its obstacles, the
way of each tool with a number where a phase of the script ends, and the arms at the start (pale)
and where they were pushed hardest. What can come and go is yellow, dashed if it comes later; what
only a camera sees is violet, virtual fixtures that attract are dashed and green."""

import csv
import math
import os
import re
import sys
import xml.etree.ElementTree as xml
from types import SimpleNamespace

import yaml

UNITS = {"m": 1, "cm": 0.01, "mm": 0.001, "rad": 1, "deg": math.pi / 180, "s": 1, "ms": 0.001}
ROUND = [2 * math.pi * i / 24 for i in range(24)]
HEIGHT, GAP, MARGIN = 430, 40, 30  # of a panel, between panels, around all [px]
MOST_WIDTH = 480  # of a panel [px]
WAYS = ("#c1121f", "#7b2cbf")  # colours of the tools' ways
VIEWS = (("from the side", 0, 2), ("from above", 0, 1))


def value(words):
    """The numbers of `0.4 0.15 0.05 m`."""
    *numbers, unit = str(words).split()
    return [float(number) * UNITS[unit] for number in numbers]


# --- Poses: a rotation by rows and a translation.


def rotation(axis, angle):
    """About a unit axis (Rodrigues)."""
    x, y, z = axis
    c, s, t = math.cos(angle), math.sin(angle), 1 - math.cos(angle)
    return [[c + t * x * x, t * x * y - s * z, t * x * z + s * y],
            [t * x * y + s * z, c + t * y * y, t * y * z - s * x],
            [t * x * z - s * y, t * y * z + s * x, c + t * z * z]]


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def turned(matrix, vector):
    return [sum(row[k] * vector[k] for k in range(3)) for row in matrix]


def moved(pose, point):
    return [a + b for a, b in zip(turned(pose[0], point), pose[1])]


def chained(a, b):
    return product(a[0], b[0]), moved(a, b[1])


def pose_of(position, rpy):
    x, y, z = (rotation(axis, angle)
               for axis, angle in zip(([1, 0, 0], [0, 1, 0], [0, 0, 1]), rpy))
    return product(z, product(y, x)), list(position)


def pose_in(entry):
    """Of a part or a robot in a scene file."""
    return pose_of(value(entry.get("position", "0 0 0 m")), value(entry.get("rpy", "0 0 0 rad")))


# --- Shapes: points whose convex hull is what is seen, and a radius around them.


def shape_of(part):
    kind = part["shape"]
    half = value(part["length"])[0] / 2 if "length" in part else 0.0
    radius = value(part["radius"])[0] if "radius" in part else 0.0
    if kind == "box":
        return box(value(part["size"])), 0.0
    if kind == "hull":
        return [value(point) for point in part["points"]], 0.0
    if kind in ("sphere", "capsule"):
        return [[0, 0, -half], [0, 0, half]], radius
    if kind == "cone":
        return [*rim(radius, -half), [0, 0, half]], 0.0
    return rim(radius, -half) + rim(radius, half), 0.0


def box(size):
    x, y, z = (edge / 2 for edge in size)
    return [[i * x, j * y, k * z] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]


def rim(radius, height):
    return [[radius * math.cos(a), radius * math.sin(a), height] for a in ROUND]


def outline(points, radius, pose, across, up):
    """What a shape covers in a view: the convex hull of its points there (Andrew)."""
    seen = [moved(pose, point) for point in points]
    seen = [(p[across], p[up]) for p in seen]
    if radius > 0.0:
        seen = [(x + radius * math.cos(a), y + radius * math.sin(a)) for x, y in seen for a in ROUND]
    seen = sorted(set(seen))

    def half(ordered):
        chain = []
        for p in ordered:
            while len(chain) > 1 and (
                    (chain[-1][0] - chain[-2][0]) * (p[1] - chain[-2][1]) <=
                    (chain[-1][1] - chain[-2][1]) * (p[0] - chain[-2][0])):
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(seen) + half(reversed(seen))


# --- The arm: its links where the joints put them.


def numbers(element, name, default):
    words = element.get(name) if element is not None else None
    return [float(word) for word in words.split()] if words else default


def origin_of(element):
    origin = element.find("origin")
    return pose_of(numbers(origin, "xyz", [0, 0, 0]), numbers(origin, "rpy", [0, 0, 0]))


def link_shapes(link):
    """Boxes, cylinders and spheres of a link; the robots here have no others."""
    for collision in link.findall("collision"):
        solid = collision.find("geometry")[0]
        size = [float(word) for name in ("size", "radius", "length") if solid.get(name)
                for word in solid.get(name).split()]
        if solid.tag == "box":
            yield box(size), 0.0, origin_of(collision)
        elif solid.tag == "sphere":
            yield [[0, 0, 0]], size[0], origin_of(collision)
        else:
            yield rim(size[0], -size[1] / 2) + rim(size[0], size[1] / 2), 0.0, origin_of(collision)


def arm_shapes(arm, joints):
    """Every part of an arm and its tool, as points, radius and pose in the world."""
    pose = pose_in(arm.entry["robot"].get("base", {}))
    children = {joint.find("parent").get("link"): joint for joint in arm.urdf.findall("joint")}
    links = {link.get("name"): link for link in arm.urdf.findall("link")}
    name = (set(links) - {j.find("child").get("link") for j in children.values()}).pop()
    joints = list(joints)
    while True:
        for points, radius, X_LP in link_shapes(links[name]):
            yield points, radius, chained(pose, X_LP)
        joint = children.get(name)
        if joint is None or name == arm.entry["robot"].get("tip_link"):
            break
        pose = chained(pose, origin_of(joint))
        if joint.get("type") != "fixed":
            pose = chained(pose, motion_of(joint, joints.pop(0)))
        name = joint.find("child").get("link")
    pose = chained(pose, pose_in(arm.entry["robot"].get("tool_frame", {})))
    for part in arm.entry["tool"]:
        points, radius = shape_of(part)
        yield points, radius, chained(pose, pose_in(part))


def motion_of(joint, position):
    axis = numbers(joint.find("axis"), "xyz", [1, 0, 0])
    if joint.get("type") == "prismatic":
        return rotation([0, 0, 1], 0), [a * position for a in axis]
    return rotation(axis, position), [0, 0, 0]


# --- What a run was: the scene and its log.


def arms_of(scene, folder):
    """The arm of the scene and its partners, with the prefix of their columns in the log."""
    for entry, prefix in [(scene, "")] + [(p, p["name"] + "/") for p in scene.get("partners", [])]:
        urdf = xml.parse(os.path.join(folder, entry["robot"]["urdf"])).getroot()
        yield SimpleNamespace(entry=entry, prefix=prefix, urdf=urdf)


def joints_at(arm, row):
    pattern = re.compile(re.escape(arm.prefix) + r"q\d+_(m|rad)$")
    return [float(row[name]) for name in row if pattern.match(name)]


def phases_of(entry, log):
    """Number, phase, and its ticks, of those phases of a script that the log saw."""
    rate = 1 / (float(log[1]["time_s"]) - float(log[0]["time_s"]))
    end = 0.0
    for number, phase in enumerate(entry.get("script", []), 1):
        begin, end = end, end + value(phase["duration"])[0]
        ticks = log[round(begin * rate):round(end * rate)]
        if ticks:
            yield number, phase, ticks


def is_of_link(pair, arms):
    """Whether what stands first in a pair is a link, and no part of a tool nor held by one."""
    first = pair.split(" - ")[0]
    held = {part["name"] for part in arms[0].entry.get("loose", [])}
    tools = {arm.prefix + part["name"] for arm in arms for part in arm.entry["tool"]}
    return first not in tools | held


def hardest_tick(log, arms):
    """Where a link was pushed hardest; if none was, where the tool was."""
    def push(row):
        force = float(row["hardest_n"] or 0)
        return force > 1 and is_of_link(row["hardest_pair"], arms), force

    return max(log, key=push)


# --- The picture.


class Panel:
    """One view: metres to pixels."""

    def __init__(self, left, scale, across, up, low, high):
        self.left, self.scale, self.axes, self.low, self.high = left, scale, (across, up), low, high

    def at(self, x, y):
        return (self.left + (x - self.low[0]) * self.scale,
                MARGIN + (self.high[1] - y) * self.scale)

    def area(self, shape, style):
        path = " ".join("%.1f,%.1f" % self.at(*p) for p in outline(*shape, *self.axes))
        return f"<polygon points='{path}' {style}/>"

    def way(self, points, style):
        path = " ".join("%.1f,%.1f" % self.at(*p) for p in points)
        return f"<polyline points='{path}' fill='none' {style}/>"


def words(x, y, content, style=""):
    return f"<text x='{x:.1f}' y='{y:.1f}' {style}>{content}</text>"


def with_parts(entries, folder):
    """The entries of a scene with the convex parts of its meshes in place of these."""
    for entry in entries:
        if entry["shape"] != "mesh":
            yield entry
            continue
        named = entry.get("parts", "auto")
        name = entry["file"] + ".parts.yaml" if named == "auto" else named
        path = os.path.join(folder, name)
        with open(path, encoding="utf-8") as file:
            parts = yaml.safe_load(file)["parts"]
        for number, part in enumerate(parts, 1):
            yield {**entry, "name": f"{entry['name']}/{number}", "shape": "hull", **part}


def obstacles_of(scene):
    """Each with its shape, its style, and where it goes if it moves."""
    for part in scene.get("loose", []):
        style = "fill='#e9c46a' fill-opacity='0.4' stroke='#9c6644' stroke-width='0.8'"
        dashes = "" if part.get("at_start", True) else " stroke-dasharray='2 2'"
        yield part, (*shape_of(part), pose_in(part)), style + dashes
    for part in scene.get("hidden", []):
        yield from with_way(part, "fill='#9d4edd' fill-opacity='0.18' stroke='#7b2cbf' "
                                  "stroke-width='0.8'")
    only = [{"name": "camera", **scene["camera"]}] if "camera" in scene else []
    for each in only + scene.get("cameras", []):
        camera = {"name": each["name"], "position": each["position"]}
        yield camera, (box([0.05, 0.05, 0.05]), 0.0, pose_in(camera)), "fill='#333' fill-opacity='0.3'"
    for part in scene["obstacles"]:
        law = scene.get("laws", {}).get(part.get("law", "default"), {})
        colour = "#2a9d8f" if law.get("passable") else "#457b9d"
        style = f"fill='{colour}' fill-opacity='0.13' stroke='{colour}' stroke-width='0.8'"
        yield from with_way(part, style)


def with_way(part, style):
    """A part where it starts and, if it moves, where it goes."""
    pose = pose_in(part)
    yield part, (*shape_of(part), pose), style
    if "motion" in part:
        there = [a + b for a, b in zip(pose[1], value(part["motion"]["along"]))]
        yield None, (*shape_of(part), (pose[0], there)), style + " stroke-dasharray='4 3'"


def fixtures_of(scene):
    """The course of each virtual fixture as points: a path, or a piece of an axis or a cone."""
    for module in scene.get("network", []):
        for fixture in module.get("fixtures", []):
            pose, reach = pose_in(fixture), 0.08
            if "points" in fixture:
                yield [value(point) for point in fixture["points"]]
            elif fixture["shape"] == "cone":
                side = reach * math.tan(value(fixture["half_angle"])[0])
                for x, y in ((side, 0), (0, side)):
                    yield [moved(pose, p) for p in ([-x, -y, reach], [0, 0, 0], [x, y, reach])]
            elif fixture["shape"] in ("line", "axis", "tube"):
                yield [moved(pose, [0, 0, z]) for z in (-reach, reach)]


def names_of(panel, scene):
    """The name of each obstacle at its top or a little below, of each numbered row once; none where
    others leave no room for it."""
    taken = {}
    for part, shape, _ in obstacles_of(scene):
        name = re.sub(r"[_/]\d+$", "", part["name"]) if part else None
        if name is None or name in taken:
            continue
        seen = outline(*shape, *panel.axes)
        x = (min(p[0] for p in seen) + max(p[0] for p in seen)) / 2
        px, py = panel.at(x, max(p[1] for p in seen))
        for y in (py + 9, py + 18, py + 27):
            if all(abs(px - qx) >= 2.6 * (len(name) + len(other)) or abs(y - qy) >= 9
                   for other, (qx, qy) in taken.items()):
                taken[name] = px, y
                break
    for name, (x, y) in taken.items():
        yield words(x, y, name.replace("_", " "), "fill='#1d3557' text-anchor='middle'")


def way_of(arm, panel, log, colour):
    def at(row):
        point = [float(row[f"{arm.prefix}{axis}_m"]) for axis in "xyz"]
        return [point[axis] for axis in panel.axes]

    yield panel.way([at(row) for row in log[::20]], f"stroke='{colour}' stroke-width='1.3'")
    for number, _, ticks in phases_of(arm.entry, log):
        x, y = panel.at(*at(ticks[-1]))
        yield f"<circle cx='{x:.1f}' cy='{y:.1f}' r='2' fill='{colour}'/>"
        yield words(x + 3, y - 3, number, f"fill='{colour}' font-weight='bold'")


def view(panel, scene, arms, log):
    for arm in arms:
        for row, style in ((log[0], "fill='#ddd' fill-opacity='0.3' stroke='#ccc'"),
                           (hardest_tick(log, arms), "fill='#f4a261' fill-opacity='0.25' "
                                                     "stroke='#b5651d' stroke-width='0.7'")):
            for shape in arm_shapes(arm, joints_at(arm, row)):
                yield panel.area(shape, style)
    for _, shape, style in obstacles_of(scene):
        yield panel.area(shape, style)
    yield from names_of(panel, scene)
    for points in fixtures_of(scene):
        yield panel.way([[p[axis] for axis in panel.axes] for p in points],
                        "stroke='#2a9d8f' stroke-width='1.6' stroke-dasharray='4 2'")
    for arm, colour in zip(arms, WAYS):
        yield from way_of(arm, panel, log, colour)


def extent(scene, arms, log, axis):
    shapes = [shape for _, shape, _ in obstacles_of(scene)]
    for arm in arms:
        for row in (log[0], hardest_tick(log, arms)):
            shapes += arm_shapes(arm, joints_at(arm, row))
    reach = [moved(pose, p)[axis] + side * radius
             for points, radius, pose in shapes for p in points for side in (-1, 1)]
    return min(reach), max(reach)


def ruler(x, y, scale):
    """A bar of a round length."""
    length = 1.0 if scale < 150 else 0.2
    yield f"<path d='M{x} {y}h{length * scale:.1f}' stroke='#000' stroke-width='2'/>"
    yield words(x, y - 4, f"{length:g} m")


def picture(scene, arms, log):
    low, high = zip(*(extent(scene, arms, log, axis) for axis in range(3)))
    spans = [b - a for a, b in zip(low, high)]
    scale = min(HEIGHT / max(spans[1], spans[2]), MOST_WIDTH / spans[0])
    width = 2 * MARGIN + GAP + 2 * spans[0] * scale
    height = 2 * MARGIN + max(spans[1], spans[2]) * scale + 20
    yield (f"<svg xmlns='http://www.w3.org/2000/svg' width='{width:.0f}' height='{height:.0f}' "
           "font-family='sans-serif' font-size='9'>")
    yield "<rect width='100%' height='100%' fill='white'/>"
    for i, (title, across, up) in enumerate(VIEWS):
        left = MARGIN + i * (spans[0] * scale + GAP)
        panel = Panel(left, scale, across, up, (low[across], low[up]), (high[across], high[up]))
        yield words(left, 15, title, "font-weight='bold' font-size='12'")
        yield from view(panel, scene, arms, log)
    yield from ruler(MARGIN, height - 12, scale)
    row = hardest_tick(log, arms)
    if float(row["hardest_n"] or 0) > 0:
        yield words(MARGIN + 120, height - 12,
                    f"arm pale: at the start; orange: after {float(row['time_s']):.1f} s, "
                    f"{row['hardest_pair']} {float(row['hardest_n']):.0f} N", "font-size='11'")
    yield "</svg>"


def read_run(scene_path, log_path):
    """Scene, arms and rows of the log."""
    with open(scene_path, encoding="utf-8") as file:
        scene = yaml.safe_load(file)
    folder = os.path.dirname(scene_path)
    scene["obstacles"] = list(with_parts(scene["obstacles"], folder))
    scene["tool"] = list(with_parts(scene["tool"], folder))
    scene["hidden"] = list(with_parts(scene.get("hidden", []), folder))
    with open(log_path, encoding="utf-8") as file:
        log = list(csv.DictReader(file))
    return scene, list(arms_of(scene, os.path.dirname(scene_path))), log


def main():
    if len(sys.argv) != 4 or "--help" in sys.argv:
        print(__doc__)
        sys.exit(0 if "--help" in sys.argv else 2)
    lines = picture(*read_run(sys.argv[1], sys.argv[2]))
    with open(sys.argv[3], "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
