#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""draw.py SCENE.yaml LOG.csv PICTURE.svg: a scene from the side and from above: its obstacles, the
way of each tool with a number where a phase of the script ends, and the arms at the start (pale)
and where they were pushed hardest. What can come and go is yellow, dashed if it comes later; what
only a camera sees is violet, virtual fixtures that attract are dashed and green.

Needs python3-yaml, python3-matplotlib and python3-scipy."""

import argparse
import csv
import math
import os
import pathlib
import re
import sys
import xml.etree.ElementTree as xml
from types import SimpleNamespace

import yaml

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import chart  # noqa: E402  after the folder where it is; with it come numpy and scipy
import numpy as np  # noqa: E402
from matplotlib.colors import to_rgba  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.patches import Polygon  # noqa: E402
from scipy.spatial import ConvexHull  # noqa: E402
from scipy.spatial.transform import Rotation  # noqa: E402

UNITS = {"m": 1, "cm": 0.01, "mm": 0.001, "rad": 1, "deg": math.pi / 180, "s": 1, "ms": 0.001}
ROUND = np.array([(math.cos(a), math.sin(a)) for a in np.arange(24) * math.pi / 12])
HEIGHT, GAP, MARGIN = 322, 30, 22  # of a panel, between panels, around all [pt]
MOST_WIDTH = 360  # of a panel [pt]
WAYS = ("#c1121f", "#7b2cbf")  # colours of the tools' ways
VIEWS = (("from the side", 0, 2), ("from above", 0, 1))


def value(words):
    """The numbers of `0.4 0.15 0.05 m`."""
    *numbers, unit = str(words).split()
    return [float(number) * UNITS[unit] for number in numbers]


# --- Poses: homogeneous matrices.


def pose_of(position, rotation):
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = rotation.as_matrix(), position
    return pose


def moved(pose, points):
    return np.asarray(points) @ pose[:3, :3].T + pose[:3, 3]


def pose_in(entry):
    """Of a part or a robot in a scene file."""
    return pose_of(value(entry.get("position", "0 0 0 m")),
                   Rotation.from_euler("xyz", value(entry.get("rpy", "0 0 0 rad"))))


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
    if kind == "ellipsoid":
        rings = [rim(np.sin(turn), np.cos(turn)) for turn in np.linspace(0.0, np.pi, 13)]
        return np.concatenate(rings) * np.asarray(value(part["size"])) / 2, 0.0
    if kind == "cone":
        return [*rim(radius, -half), [0, 0, half]], 0.0
    return rim(radius, -half) + rim(radius, half), 0.0


def box(size):
    x, y, z = (edge / 2 for edge in size)
    return [[i * x, j * y, k * z] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)]


def rim(radius, height):
    return [[radius * x, radius * y, height] for x, y in ROUND]


def outline(points, radius, pose, axes):
    """What a shape covers in a view: the convex hull of its points there."""
    seen = moved(pose, points)[:, axes]
    if radius > 0.0:
        seen = (seen[:, None] + radius * ROUND).reshape(-1, 2)
    return seen[ConvexHull(seen).vertices]


# --- The arm: its links where the joints put them.


def numbers(element, name, default):
    words = element.get(name) if element is not None else None
    return [float(word) for word in words.split()] if words else default


def origin_of(element):
    origin = element.find("origin")
    return pose_of(numbers(origin, "xyz", [0, 0, 0]),
                   Rotation.from_euler("xyz", numbers(origin, "rpy", [0, 0, 0])))


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
            yield points, radius, pose @ X_LP
        joint = children.get(name)
        if joint is None or name == arm.entry["robot"].get("tip_link"):
            break
        pose = pose @ origin_of(joint)
        if joint.get("type") != "fixed":
            pose = pose @ motion_of(joint, joints.pop(0))
        name = joint.find("child").get("link")
    pose = pose @ pose_in(arm.entry["robot"].get("tool_frame", {}))
    for part in arm.entry["tool"]:
        points, radius = shape_of(part)
        yield points, radius, pose @ pose_in(part)


def motion_of(joint, position):
    motion = position * np.array(numbers(joint.find("axis"), "xyz", [1, 0, 0]))
    if joint.get("type") == "prismatic":
        return pose_of(motion, Rotation.identity())
    return pose_of((0, 0, 0), Rotation.from_rotvec(motion))


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


def style_of(colour, opacity, edge=None, width=0.6, dashes="-"):
    """Of what is filled."""
    return {"facecolor": to_rgba(colour, opacity), "edgecolor": edge or colour, "linewidth": width,
            "linestyle": dashes, "clip_on": False}


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
        dashes = "-" if part.get("at_start", True) else (0, (2, 2))
        yield part, (*shape_of(part), pose_in(part)), style_of("#e9c46a", 0.4, "#9c6644",
                                                               dashes=dashes)
    for part in scene.get("hidden", []):
        yield from with_way(part, style_of("#9d4edd", 0.18, "#7b2cbf"))
    only = [{"name": "camera", **scene["camera"]}] if "camera" in scene else []
    for each in only + scene.get("cameras", []):
        camera = {"name": each["name"], "position": each["position"]}
        yield camera, (box([0.05, 0.05, 0.05]), 0.0, pose_in(camera)), style_of("#333333", 0.3,
                                                                                "none")
    for part in scene["obstacles"]:
        law = scene.get("laws", {}).get(part.get("law", "default"), {})
        yield from with_way(part, style_of("#2a9d8f" if law.get("passable") else "#457b9d", 0.13))


def with_way(part, style):
    """A part where it starts and, if it moves, where it goes."""
    pose = pose_in(part)
    yield part, (*shape_of(part), pose), style
    if "motion" in part:
        there = pose.copy()
        there[:3, 3] += value(part["motion"]["along"])
        yield None, (*shape_of(part), there), {**style, "linestyle": (0, (4, 3))}


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
                    yield moved(pose, ([-x, -y, reach], [0, 0, 0], [x, y, reach]))
            elif fixture["shape"] in ("line", "axis", "tube"):
                yield moved(pose, ([0, 0, -reach], [0, 0, reach]))


def write_names(panel, scene, axes, scale):
    """The name of each obstacle at its top or a little below, of each numbered row once; none where
    others leave no room for it."""
    taken = {}  # [pt]
    for part, shape, _ in obstacles_of(scene):
        name = re.sub(r"[_/]\d+$", "", part["name"]) if part else None
        if name is None or name in taken:
            continue
        low, high = np.min(seen := outline(*shape, axes), axis=0), np.max(seen, axis=0)
        x = scale * (low[0] + high[0]) / 2
        for y in scale * high[1] - np.array((7, 14, 21)):
            if all(abs(x - qx) >= 2.2 * (len(name) + len(other)) or abs(y - qy) >= 7
                   for other, (qx, qy) in taken.items()):
                taken[name] = x, y
                break
    for name, (x, y) in taken.items():
        panel.text(x / scale, y / scale, name.replace("_", " "), color="#1d3557", ha="center",
                   fontsize=7)


def draw_way(panel, arm, axes, log, colour):
    def at(row):
        return np.array([float(row[f"{arm.prefix}{axis}_m"]) for axis in "xyz"])[axes]

    panel.plot(*np.transpose([at(row) for row in log[::20]]), color=colour, linewidth=1)
    for number, _, ticks in phases_of(arm.entry, log):
        panel.plot(*at(ticks[-1]), "o", color=colour, markersize=3)
        panel.annotate(number, at(ticks[-1]), (2, 2), textcoords="offset points", color=colour,
                       weight="bold", fontsize=7)


def draw_view(panel, scene, arms, log, axes, scale):
    for arm in arms:
        for row, style in ((log[0], style_of("#dddddd", 0.3, "#cccccc")),
                           (hardest_tick(log, arms), style_of("#f4a261", 0.25, "#b5651d"))):
            for shape in arm_shapes(arm, joints_at(arm, row)):
                panel.add_patch(Polygon(outline(*shape, axes), **style))
    for _, shape, style in obstacles_of(scene):
        panel.add_patch(Polygon(outline(*shape, axes), **style))
    write_names(panel, scene, axes, scale)
    for points in fixtures_of(scene):
        panel.plot(*np.asarray(points)[:, axes].T, color="#2a9d8f", linewidth=1.2,
                   dashes=(4, 2))
    for arm, colour in zip(arms, WAYS):
        draw_way(panel, arm, axes, log, colour)


def extent(scene, arms, log):
    """The lowest and the highest corner of all that is drawn."""
    shapes = [shape for _, shape, _ in obstacles_of(scene)]
    for arm in arms:
        for row in (log[0], hardest_tick(log, arms)):
            shapes += arm_shapes(arm, joints_at(arm, row))
    reach = np.concatenate([moved(pose, points) + side * radius
                            for points, radius, pose in shapes for side in (-1, 1)])
    return reach.min(axis=0), reach.max(axis=0)


def picture(scene, arms, log, path):
    low, high = extent(scene, arms, log)
    spans = high - low
    scale = min(HEIGHT / max(spans[1:]), MOST_WIDTH / spans[0])  # [pt/m]
    width = 2 * MARGIN + GAP + 2 * spans[0] * scale
    height = 2 * MARGIN + max(spans[1:]) * scale + 15
    figure = chart.pyplot.figure(figsize=(width / 72, height / 72))
    for i, (title, *axes) in enumerate(VIEWS):
        across, up = spans[axes] * scale
        panel = figure.add_axes(((MARGIN + i * (across + GAP)) / width,
                                 1 - (MARGIN + up) / height, across / width, up / height))
        panel.set(title=title, xlim=(low[axes[0]], high[axes[0]]),
                  ylim=(low[axes[1]], high[axes[1]]))
        panel.set_axis_off()
        draw_view(panel, scene, arms, log, axes, scale)
    length = 1.0 if scale < 112 else 0.2
    figure.add_artist(Line2D(np.array((MARGIN, MARGIN + length * scale)) / width,
                             (9 / height, 9 / height), color=chart.BLACK, linewidth=1.5))
    figure.text(MARGIN / width, 12 / height, f"{length:g} m")
    row = hardest_tick(log, arms)
    if float(row["hardest_n"] or 0) > 0:
        figure.text((MARGIN + 90) / width, 9 / height,
                    f"arm pale: at the start; orange: after {float(row['time_s']):.1f} s, "
                    f"{row['hardest_pair']} {float(row['hardest_n']):.0f} N")
    chart.save(figure, path, scene["name"].replace("_", " "),
               "The scene from the side and from above: its obstacles, the arms at the start and "
               "where they were pushed hardest, and the way of each tool.")


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
    parser = argparse.ArgumentParser(description=__doc__)
    for name in ("scene", "log", "picture"):
        parser.add_argument(name)
    arguments = parser.parse_args()
    picture(*read_run(arguments.scene, arguments.log), arguments.picture)


if __name__ == "__main__":
    main()
