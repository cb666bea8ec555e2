#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Compares the measures of overlap in the loop: compare.py TELEOP [--write FOLDER] [--quick].

TELEOP is the path of that program. By every measure it runs three scenes of the repository, and
four tools that are pressed into a table which is too soft for them: what the forces are, how rough,
how deep the tools go, and the time of a tick as a multiple of that by the default measure, in the
same run of this script.
Then the same tools enter a table without a force, straight down: which depth is measured at which
true depth, and from which on. Prints the tables; with --write they become measures.md of that
folder, and the depths measures.json, for bench/draw. --quick leaves out the repetitions that
the times need.
"""

import argparse
import csv
import json
import os
import pathlib
import platform
import subprocess
import tempfile

here = pathlib.Path(__file__).resolve().parent
root = here.parent.parent

settings = {
    "deepest point": ["--measure", "deepest_point"],
    "reduction, 2 levels": ["--measure", "reduction", "--levels", "2"],
    "reduction, 8 levels": ["--measure", "reduction", "--levels", "8"],
    "reduction, 32 levels": ["--measure", "reduction", "--levels", "32"],
    "exact": ["--measure", "exact"],
}
default = next(iter(settings))
no_patch = "deepest point, no patch"  # the force acts at one point, as it does by the reduction

# Shape, height of its origin above its lowest point [mm].
tools = {
    "plate": ("shape: box, size: 80 60 40 mm", 20.0),
    "edge": ("shape: box, size: 80 60 40 mm, rpy: 45 0 0 deg", 35.3553),
    "corner": ("shape: box, size: 60 60 60 mm, rpy: 45 35.2644 0 deg", 51.9615),
    "cone": ("shape: cone, radius: 10 mm, length: 100 mm", 50.0),
}
repository = ("anderson_4x8", "plates", "peg_fixture")
height = 504.3057  # [mm] of the tool frame at the start

scene = """name: {name}
rate: 400 Hz
robot:
  urdf: {root}/robots/puma560.urdf
  start: 0 45 -180 0 -45 0 deg
  tool_frame: {{position: 0 0 100 mm}}
  links: []
tool:
  - {{name: {name}, {shape}}}
laws: {{default: {law}}}
obstacles:
  - {{name: table, shape: box, size: 600 800 120 mm, position: 600 -150 {middle:.4f} mm}}
script:
{script}"""

press = """  - {name: down, device: spaceball, duration: 2 s, linear: 0 0 -30 mm/s}
  - {name: slide, device: spaceball, duration: 2 s, linear: 30 0 0 mm/s}
  - {name: turn, device: spaceball, duration: 2 s, angular: 5 5 5 deg/s}
  - {name: up, device: spaceball, duration: 2 s, linear: 0 0 60 mm/s}
"""
sink = "  - {name: down, device: spaceball, duration: 3 s, linear: 0 0 -20 mm/s}\n"
deepest_sink = 40.0  # [mm]
felt = 0.01          # [mm] what counts as measured at all; a tick sinks by 0.05


def scene_of(tool, gap, law, script):
    """A table `gap` [mm] below the tool."""
    shape, origin = tools[tool]
    return scene.format(name=tool, root=root, shape=shape, law=law, script=script,
                        middle=height - origin - gap - 60.0)


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, pathlib.Path(folder)

    def run(self, file, *options):
        """The report, and the log as text."""
        report, log = self.folder / "report.json", self.folder / "log.csv"
        done = subprocess.run([self.path, "run", file, "--fast", "--report", report, "--log", log,
                               *options], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise SystemExit(f"compare.py: {file}: {done.stderr.strip()}")
        return json.loads(report.read_text()), log.read_text()

    def scene(self, text, name="scene"):
        file = self.folder / f"{name}.yaml"
        file.write_text(text)
        return file


def forces(log):
    """The columns of a log that differ if any force or torque does."""
    return [[value for name, value in row.items()
             if name.startswith(("virtual_", "coupling_", "tau"))]
            for row in csv.DictReader(log.splitlines())]


def row_of(name, same, report, times, default_times):
    walls = report["chatter"]["walls"]
    ratio = [min(time[k] for time in times) / min(time[k] for time in default_times)
             for k in ("p50", "p99")]
    return (f"| {name} | {'yes' if same else 'no'} | {report['peak_force_n']:.1f} "
            f"| {walls['force_rms_n']:.4f} | {walls['force_jump_n']:.2f} "
            f"| {walls['torque_rms_nm']:.4f} | {walls['torque_jump_nm']:.3f} "
            f"| {max(0.0, -1e3 * report['nearest_m']):.1f} | {1e3 * report['deepest_m']:.1f} "
            f"| {ratio[0]:.2f} | {ratio[1]:.2f} |")


def compared(program, scenes, repetitions, *options):
    """A table of a scene, a file for each setting. The runs take turns, so that all see the same
    machine."""
    reports, logs, times = {}, {}, {name: [] for name in scenes}
    for _ in range(repetitions):
        for name, file in scenes.items():
            reports[name], logs[name] = program.run(file, *settings.get(name, []), *options)
            times[name].append(reports[name]["compute_us"])
    usual = forces(logs[default])
    return ["| measure | same forces | largest force, N | above 30 Hz, N rms | jump, N "
            "| torque above 30 Hz, N m rms | jump, N m | deepest measured, mm | proven, mm "
            "| tick, p50 | p99 |",
            "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|"] + [
                row_of(name, forces(logs[name]) == usual, reports[name], times[name],
                       times[default]) for name in scenes]


def sunk(program, tool, measure):
    """(true depth, measured depth) [mm] of a tool that enters the table straight down."""
    gap = 2.0
    law = "{range: 1 mm, surface_force: 0 N}"
    file = program.scene(scene_of(tool, gap, law, sink))
    _, log = program.run(file, "--seconds", "3", "--backend", "ideal", *measure)
    rows = list(csv.DictReader(log.splitlines()))
    start = float(rows[0]["z_m"])
    points = [(1e3 * (start - float(row["z_m"])) - gap, -1e3 * float(row["nearest_m"]))
              for row in rows if row["nearest_m"]]
    return [point for point in points if 0.0 <= point[0] <= deepest_sink]


def dead_zone(curve):
    return next((true for true, measured in curve if measured > felt), deepest_sink)


def widest_step(curve):
    """[mm] the longest way behind the dead zone on which the measured depth stays the same."""
    widest, begin = 0.0, None
    for (a, depth), (b, deeper) in zip(curve, curve[1:]):
        if depth <= felt or deeper - depth > 0.02 * (b - a):
            begin = None
            continue
        begin = a if begin is None else begin
        widest = max(widest, b - begin)
    return widest


def depth_at(curve, true):
    return min(curve, key=lambda point: abs(point[0] - true))[1]


def dead_zones(curves):
    yield ("| tool | measure | dead zone, mm | widest step, mm | measured at 10 mm | at 20 mm "
           "| at 40 mm |")
    yield "|---|---|---:|---:|---:|---:|---:|"
    for (tool, name), curve in curves.items():
        depths = " | ".join(f"{depth_at(curve, true):.1f}" for true in (10.0, 20.0, 40.0))
        yield (f"| {tool} | {name} | {dead_zone(curve):.1f} | {widest_step(curve):.1f} "
               f"| {depths} |")


def drawn(curves):
    """What bench/draw draws: every fourth point [mm], to a micrometre."""
    return {"curves": [{"tool": tool, "measure": name,
                        "true [mm]": [round(true, 3) for true, _ in curve[::4]],
                        "measured [mm]": [round(max(0.0, depth), 3) for _, depth in curve[::4]]}
                       for (tool, name), curve in curves.items()]}


def heading():
    said = subprocess.run(["git", "-C", root, "rev-parse", "--short", "HEAD"],
                          capture_output=True, text=True, check=False).stdout.strip()
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8")
                if line.startswith("model name")), platform.machine())
    return ["# The measures of overlap, in the loop", "",
            "`bench/measures/compare.py build/release/bin/teleop --write bench/results`,",
            f"{cpu}, {os.cpu_count()} processors, commit {said or 'unknown'};",
            "[benchmarks.md](../../docs/benchmarks.md#measures-in-the-loop) says how to read it. "
            "Only the", "times depend on the machine.", ""]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("teleop", help="path of the program")
    parser.add_argument("--write", metavar="FOLDER", help="write measures.md and measures.json")
    parser.add_argument("--quick", action="store_true", help="one run of each")
    arguments = parser.parse_args()
    repetitions = 1 if arguments.quick else 5
    lines = []

    def say(*more):
        lines.extend(more)
        print(*more, sep="\n", flush=True)

    with tempfile.TemporaryDirectory() as folder:
        program = Program(arguments.teleop, folder)
        for name in repository:
            file = root / "scenes" / f"{name}.yaml"
            say(f"## {name}", "",
                *compared(program, dict.fromkeys(settings, file), repetitions), "")
        for tool in tools:
            law = "range: 5 mm, surface_force: 5 N"
            soft = program.scene(scene_of(tool, 10.0, f"{{{law}}}", press))
            scenes = dict.fromkeys(settings, soft)
            scenes[no_patch] = program.scene(
                scene_of(tool, 10.0, f"{{{law}, tilt: 0 deg}}", press), "no_patch")
            say(f"## {tool}, pressed into a soft table", "",
                *compared(program, scenes, repetitions, "--seconds", "8"), "")
        curves = {(tool, name): sunk(program, tool, measure)
                  for tool in tools for name, measure in settings.items()}
        say("## Depth measured, and dead zone", "", *dead_zones(curves))
    if arguments.write:
        target = pathlib.Path(arguments.write)
        (target / "measures.md").write_text("\n".join(
            heading() + lines + ["", "![measured against true depth](measures.svg)"]) + "\n")
        (target / "measures.json").write_text(json.dumps(drawn(curves)) + "\n")
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
