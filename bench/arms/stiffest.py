#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Finds the stiffest wall that the default network holds on arms that people have:
stiffest.py TELEOP [--write FILE].

TELEOP is the path of that program. A ball presses on a floor and slides along it. By bisection, with
the same damping, the largest stiffness whose force stays calm (less than 1 N rms above 30 Hz, less
than 2 J by sampling, no fault), with the prediction of the arm's motion and without; beside them
what the check at set-up allows, B / (T / 2), and what it allowed before there was a prediction, by
the friction of the joints alone (Colgate and Schenkel 1997).
"""

import argparse
import math
import pathlib
import sys
import tempfile

import calm

damping, surface = 100.0, 20.0  # [N s/m], [N] at the surface; the ball presses harder
least, most = 1e3, 1e7  # [N/m]

press = """script:
  - {{name: press, device: spaceball, duration: 2 s, linear: 0 0 -60 mm/s}}
  - {{name: slide, device: spaceball, duration: 2 s, linear: 40 0 -20 mm/s}}
laws:
  wall: {{range: {range:.9g} m, surface_force: {surface} N, damping: {damping} N s/m}}
network:
  - {{module: torque_arm}}
  - {{module: multiplex}}
  - {{module: spaceball}}
  - {{module: relief}}
  - {{module: kbb2}}
  - {{module: obstacle, gain_check: warning}}
  - {{module: puma_kin}}
  - {{module: arm_obstacle}}
  - {{module: limits}}
  - {{module: puma_joints}}
"""


def scene(arm, start, tool, stiffness):
    """The slope of the law is 2 F / r from its surface on."""
    text = calm.scene.format(name=arm, urdf=calm.urdf_of(arm), start=start,
                             obstacles=calm.obstacles(tool).replace("shape:", "law: wall, shape:"))
    text = text[:text.index("script:")]
    return text + press.format(range=2.0 * surface / stiffness, surface=surface, damping=damping)


def holds(program, text, rate, *options):
    row = calm.measure(program, text, rate, *options)
    return calm.is_calm(row) and row["chatter_n"] < 1.0 and row["force_n"] > 1.5 * surface


def stiffest(program, arm, start, tool, rate, *options):
    """[N/m], to 10 %; None when not even the least holds."""
    low, high = least, most
    if not holds(program, scene(arm, start, tool, low), rate, *options):
        return None
    while high / low > 1.1:
        middle = math.sqrt(low * high)
        if holds(program, scene(arm, start, tool, middle), rate, *options):
            low = middle
        else:
            high = middle
    return low


def shown(stiffness):
    return "none" if stiffness is None else f"{stiffness / 1e3:.3g}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("teleop", help="path of the program")
    parser.add_argument("--write", metavar="FILE", help="write the table as Markdown")
    arguments = parser.parse_args()
    rate = 400
    lines = [f"Stiffness in kN/m, to 10 %, at {rate} Hz with {damping:g} N s/m of damping in the wall.", "",
             "| arm | with the prediction | allowed | without it | allowed by friction alone |",
             "|---|---|---|---|---|"]
    with tempfile.TemporaryDirectory() as folder:
        program = calm.Program(arguments.teleop, folder)
        for arm, start in calm.arms:
            free = calm.scene.format(name=arm, urdf=calm.urdf_of(arm), start=start, obstacles=" []")
            _, report, log = program.run(free, 0.1)
            tool = [float(log[key][0]) for key in ("x_m", "y_m", "z_m")]
            new = stiffest(program, arm, start, tool, rate)
            old = stiffest(program, arm, start, tool, rate, "--no-prediction")
            friction = max(0.0, report["device_damping_n_s_per_m"] - damping) * 2.0 * rate
            lines.append(f"| {arm} | {shown(new)} | {shown(damping * 2.0 * rate)} | {shown(old)} "
                         f"| {shown(friction)} |")
            print(lines[-1], flush=True)
    if arguments.write:
        head = calm.heading("stiffest.py", "walls.md", "# The stiffest walls")
        pathlib.Path(arguments.write).write_text("\n".join(head + lines) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
