#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""plot_engines.py RESULTS.json PLOT.svg: error of a motion against the run time of a step, engine
by engine, in more and more sub-steps."""

import json
import sys

import chart
from plot_telepresence import WIDTH, Axes, decades, picture

COLOURS = {"bullet": "#7f7f7f", "ode": "#2a6f97", "reference": "#c1121f"}
BELOW = 13  # where the sub-steps of bullet stand, whose curve runs beside that of ode
LEAST_ERROR = 1e-10  # [mrad]; the truth is hardly better known


def curve(axes, rows, colour, drop):
    """What is wrong has earned no time and no point."""
    points = [(r["step [us]"], r["error [mrad]"], r["sub-steps"]) for r in rows if r["step [us]"]]
    yield from axes.curve([point[:2] for point in points], colour)
    for time, error, substeps in points:
        x, y = axes.x(time), axes.y(error)
        yield f"<circle cx='{x:.1f}' cy='{y:.1f}' r='3' fill='{colour}'/>"
        yield chart.text(x + 5, y + drop, substeps, f"fill='{colour}' font-size='9'")


def draw(rows):
    panels = []
    for arm in dict.fromkeys(row["arm"] for row in rows):
        ours = [row for row in rows if row["arm"] == arm]
        axes = Axes(WIDTH * len(panels), decades(0.3, 1000, (1, 3)), decades(LEAST_ERROR, 10))
        panel = list(axes.lines(f"{arm}: error of a second of motion [mrad]",
                                "time of a step of 2.5 ms [us]; at the points: sub-steps"))
        for engine, colour in COLOURS.items():
            drop = BELOW if engine == "bullet" else -4
            panel += curve(axes, [row for row in ours if row["engine"] == engine], colour, drop)
        panels.append(panel)
    return picture(panels, COLOURS)


def main():
    if len(sys.argv) != 3 or "--help" in sys.argv:
        print(__doc__)
        sys.exit(0 if "--help" in sys.argv else 2)
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = json.load(file)["parts"]["sweep"]["rows"]
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write("\n".join(draw(rows)) + "\n")


if __name__ == "__main__":
    main()
