#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""plot_distance.py RESULTS.json PLOT.svg: time against error of every library, tolerance by
tolerance."""

import math

import chart

COLOURS = {"repel": "#c1121f", "bullet": "#7f7f7f", "coal": "#2a6f97", "fcl": "#e09f3e",
           "mujoco": "#588157", "opengjk": "#8b5e34", "dgd": "#8e6bbf"}
WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 360, 320, 60, 40, 50
LOWEST = 1e-17  # an error of exactly 0 is drawn here


def curves(runs):
    """{task: {library: [(median ns, worst relative error)]}}, the loosest tolerance first; a
    library whose tolerance is fixed has one point."""
    tasks = {task: {} for task in ("box", "8v", "32v")}
    for run in sorted(runs, key=lambda run: -run["tolerance"]):
        first, second, third, *_ = run["name"].split("/")
        point = (run["p50_ns"], max(run["worst_relative_error"], LOWEST))
        if first == "error":
            tasks[second].setdefault(third, []).append(point)
        elif first in tasks and second == "cold" and run["tolerance"] == 0:
            tasks[first][third] = [point]
    return tasks


def height_of(error):
    return TOP + (HEIGHT - TOP - BOTTOM) * -math.log10(error) / 17


def axes(panel, task):
    yield from panel.title(f"{task}, cold")
    for digits in range(0, 18, 4):
        yield from panel.level(height_of(10.0**-digits), f"1e-{digits}" if digits else "1")
    yield from panel.times()
    yield chart.text(panel.left, HEIGHT - 12, "median time [ns] against worst relative error")


def curve(panel, library, points):
    colour = COLOURS.get(library, "#000")
    places = [(panel.x(time), height_of(error)) for time, error in points]
    path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in places)
    yield f"<path d='{path}' fill='none' stroke='{colour}'/>"
    for x, y in places:
        yield f"<circle cx='{x:.1f}' cy='{y:.1f}' r='3' fill='{colour}'/>"


def panels(tasks):
    times = [time for task in tasks.values() for line in task.values() for time, _ in line]
    for i, (task, lines) in enumerate(tasks.items()):
        left = WIDTH * i
        panel = chart.Panel(left + LEFT, left + WIDTH - 20, TOP, HEIGHT - BOTTOM, times)
        yield from axes(panel, task)
        for library, points in lines.items():
            yield from curve(panel, library, points)


def draw(runs):
    tasks = curves(runs)
    libraries = sorted({library for task in tasks.values() for library in task})
    return chart.picture(WIDTH * len(tasks) + 110, HEIGHT, libraries, COLOURS, panels(tasks))


if __name__ == "__main__":
    chart.main(__doc__, draw)
