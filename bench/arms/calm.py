#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tries the default network on arms that people have: calm.py TELEOP [--write FILE] [--quick].

TELEOP is the path of that program. Every arm moves freely, goes down to a floor, slides into a
corner, turns there, and is pushed by the lever, at several tick rates, then with 0.6 and 1.7 times
the inertia of its model, and once without the prediction of its motion. Scenes have nothing but
robot, tool, obstacles and script. Prints one line for each run. Exits with 1 if a run with the
prediction has a fault, gains 2 J by sampling or is at a limit of speed or torque in more than 2 % of
its ticks.
"""

import argparse
import json
import math
import os
import pathlib
import platform
import subprocess
import sys
import tempfile

here = pathlib.Path(__file__).resolve().parent
root = here.parent.parent

# Arm, start [deg].
arms = [
    ("ur3", "0 -90 90 -90 -90 0"),
    ("ur5", "0 -90 90 -90 -90 0"),
    ("ur10", "0 -90 90 -90 -90 0"),
    ("panda", "0 -45 0 -135 0 90 45"),
    ("kinova_gen3", "0 15 180 -130 0 -35 90"),
    ("z1", "0 80 -60 70 0 0"),
    ("xarm7", "0 -20 0 70 0 90 0"),
    ("iiwa14", "0 30 0 -90 0 60 0"),
    ("puma560", "0 45 -180 0 -45 0"),
    ("puma560_armstrong", "0 -135 0 0 -45 0"),
]
limits = {"torque_limit", "speed_limit", "torque_rate"}
demands = limits | {"saturated", "joint_limit", "tool_speed"}  # no faults
ball, gap = 0.03, 0.06  # [m] radius; from ball to floor at the start

scene = """name: {name}
rate: 400 Hz
robot:
  urdf: {urdf}
  start: {start} deg
  tool_frame: {{position: 0 0 80 mm}}
tool:
  - {{name: ball, shape: sphere, radius: 30 mm}}
obstacles:{obstacles}
script:
  - {{name: free, device: spaceball, duration: 1 s, linear: 40 0 20 mm/s}}
  - {{name: back, device: spaceball, duration: 1 s, linear: -40 0 -20 mm/s}}
  - {{name: floor, device: spaceball, duration: 2 s, linear: 0 0 -60 mm/s}}
  - {{name: corner, device: spaceball, duration: 2 s, linear: 40 0 -20 mm/s}}
  - {{name: turn, device: spaceball, duration: 1 s, angular: 10 10 10 deg/s}}
  - {{name: lever, device: torque_arm, duration: 2 s, direction: 0 0 -1, lever: 30 deg/s}}
"""


def urdf_of(arm):
    own = here / f"{arm}.urdf"
    return own if own.exists() else root / "robots" / f"{arm}.urdf"


def obstacles(tool):
    if tool is None:
        return " []"
    x, y, z = tool
    return "".join(
        f"\n  - {{name: {name}, shape: box, size: {sx} {sy} {sz} m, position: {px:.4f} {py:.4f} "
        f"{pz:.4f} m}}"
        for name, sx, sy, sz, px, py, pz in (
            ("floor", 0.2, 0.2, 0.05, x, y, z - ball - gap - 0.025),
            ("wall", 0.05, 0.2, 0.05, x + ball + 0.03 + 0.025, y, z - ball - gap + 0.025)))


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, pathlib.Path(folder)

    def run(self, text, seconds, *options):
        """The exit code, the report and the columns of the log."""
        file, report, log = (self.folder / name for name in ("s.yaml", "r.json", "l.csv"))
        file.write_text(text)
        for old in (report, log):
            old.unlink(missing_ok=True)
        done = subprocess.run(
            [self.path, "run", file, "--fast", "--tool-alone", "--seconds", str(seconds),
             "--report", report, "--log", log, *options], capture_output=True, text=True, check=False)
        if not report.exists():
            sys.exit(f"calm.py: {done.stderr.strip()}")
        head, *lines = log.read_text().splitlines()
        names = head.split(",")
        rows = [line.split(",") for line in lines]
        return done.returncode, json.loads(report.read_text()), {
            name: [row[i] for row in rows] for i, name in enumerate(names)}


def chatter(force, rate):
    """Root mean square [N] of what is above 30 Hz: the difference from the mean over 1/30 s."""
    half = max(1, round(rate / 60))
    sums = [0.0]
    for x in force:
        sums.append(sums[-1] + x)
    rest = [force[i] - (sums[i + half + 1] - sums[i - half]) / (2 * half + 1)
            for i in range(half, len(force) - half)]
    return math.sqrt(sum(x * x for x in rest) / max(1, len(rest)))


def measure(program, text, rate, *options):
    code, report, log = program.run(text, 9, "--rate", str(rate), *options)
    ticks = report["ticks"]
    energy = next(m["sampling_energy_j"] for m in report["modules"] if m["name"] == "puma_joints")
    status = report["status_ticks"]
    joints = [key for key in log if key[0] == "q" and key[1].isdigit()]
    speed = max(abs(float(b) - float(a)) * rate for key in joints
                for a, b in zip(log[key], log[key][1:]))
    force = [math.hypot(*(float(log[f"virtual_f{axis}_n"][i]) for axis in "xyz"))
             for i in range(len(log["tick"]))]
    return {"exit": code, "energy_j": energy, "speed_rad_s": speed, "force_n": max(force),
            "deepest_mm": 1e3 * report["deepest_m"], "chatter_n": chatter(force, rate),
            "limit": sum(status.get(name, 0) for name in limits) / ticks,
            "fault": sum(n for name, n in status.items() if name not in demands) / ticks}


def heading(script="calm.py", page="arms.md", title="# Arms that people have"):
    """The lines above the table: how it was made, and where."""
    said = subprocess.run(["git", "-C", root, "rev-parse", "--short", "HEAD"],
                          capture_output=True, text=True, check=False).stdout.strip()
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8")
                if line.startswith("model name")), platform.machine())
    gxx = subprocess.run(["g++", "-dumpfullversion"], capture_output=True, text=True,
                         check=False).stdout.strip()
    return [title, "",
            f"`bench/arms/{script} build/release/bin/teleop --write bench/results/{page}`,",
            f"{cpu}, {os.cpu_count()} processors, g++ {gxx}, commit {said or 'unknown'}. The runs do",
            "not depend on the clock.", ""]


def is_calm(row):
    return (row["exit"] == 0 and row["fault"] == 0 and row["energy_j"] < 2.0
            and row["limit"] <= 0.02)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("teleop", help="path of the program")
    parser.add_argument("--write", metavar="FILE", help="write the table as Markdown")
    parser.add_argument("--quick", action="store_true", help="400 Hz alone")
    arguments = parser.parse_args()
    rates = [400] if arguments.quick else [100, 200, 400, 1000, 4000]
    lines = ["| arm | rate, Hz | inertia | prediction | by sampling, J | joint speed, rad/s "
             "| wall force, N | above 30 Hz, N rms | at a limit | faults | exit |",
             "|---|---|---|---|---|---|---|---|---|---|---|"]
    restless = 0
    with tempfile.TemporaryDirectory() as folder:
        program = Program(arguments.teleop, folder)
        for arm, start in arms:
            def text(tool, arm=arm, start=start):
                return scene.format(name=arm, urdf=urdf_of(arm), start=start,
                                    obstacles=obstacles(tool))
            _, _, log = program.run(text(None), 0.1)
            tool = [float(log[key][0]) for key in ("x_m", "y_m", "z_m")]
            cases = [(rate, 1.0, True) for rate in rates]
            cases += [(400, 0.6, True), (400, 1.7, True), (400, 1.0, False)]
            for rate, inertia, predicts in cases:
                options = ["--plant-inertia", str(inertia)] + ([] if predicts
                                                               else ["--no-prediction"])
                row = measure(program, text(tool), rate, *options)
                restless += predicts and not is_calm(row)
                lines.append(
                    f"| {arm} | {rate} | {inertia} | {'yes' if predicts else 'no'} "
                    f"| {row['energy_j']:.2g} | {row['speed_rad_s']:.3g} | {row['force_n']:.1f} "
                    f"| {row['chatter_n']:.2g} | {100 * row['limit']:.1f} % "
                    f"| {100 * row['fault']:.1f} % | {row['exit']} |")
                print(lines[-1], flush=True)
    print(f"{restless} runs with the prediction are not calm")
    if arguments.write:
        pathlib.Path(arguments.write).write_text("\n".join(heading() + lines) + "\n")
    return 1 if restless else 0


if __name__ == "__main__":
    sys.exit(main())
