#!/usr/bin/env python3
"""plot.py RESULTS.json PLOT.svg: time against error of every library, tolerance by tolerance."""

import json
import math
import sys

COLOURS = {"repel": "#c1121f", "bullet": "#7f7f7f", "coal": "#2a6f97", "fcl": "#e09f3e",
           "mujoco": "#588157"}
WIDTH, HEIGHT, LEFT, BOTTOM = 360, 320, 60, 50
LOWEST = 1e-17  # an error of exactly 0 is drawn here


def read(path):
    """{task: {library: [(median ns, worst relative error)]}}, the loosest tolerance first; a
    library whose tolerance is fixed has one point."""
    with open(path, encoding="utf-8") as file:
        runs = json.load(file)["benchmarks"]
    tasks = {task: {} for task in ("box", "8v", "32v")}
    for run in sorted(runs, key=lambda run: -run["tolerance"]):
        first, second, third, *_ = run["name"].split("/")
        point = (run["p50_ns"], max(run["worst_relative_error"], LOWEST))
        if first == "error":
            tasks[second].setdefault(third, []).append(point)
        elif first in tasks and second == "cold" and run["tolerance"] == 0:
            tasks[first][third] = [point]
    return tasks


class Panel:
    """One task: logarithmic axes, the same for all tasks."""

    def __init__(self, left, times):
        self.left = left + LEFT
        self.low, self.high = math.log10(min(times) / 1.2), math.log10(max(times) * 1.2)

    def x(self, time):
        share = (math.log10(time) - self.low) / (self.high - self.low)
        return self.left + share * (WIDTH - LEFT - 20)

    def y(self, error):
        return 40 + (HEIGHT - 40 - BOTTOM) * -math.log10(error) / 17

    def axes(self, task):
        right = self.left + WIDTH - LEFT - 20
        yield text(self.left, 25, f"{task}, cold", "font-weight='bold'")
        for digits in range(0, 18, 4):
            y = self.y(10.0**-digits)
            yield f"<path d='M{self.left} {y:.1f}H{right}' stroke='#ddd'/>"
            yield text(self.left - 5, y + 4, f"1e-{digits}" if digits else "1",
                       "text-anchor='end'")
        for time in (100, 200, 500, 1000, 2000, 5000, 10000):
            if self.low < math.log10(time) < self.high:
                x = self.x(time)
                yield f"<path d='M{x:.1f} 40V{HEIGHT - BOTTOM}' stroke='#ddd'/>"
                yield text(x, HEIGHT - BOTTOM + 15, time, "text-anchor='middle'")
        yield text(self.left, HEIGHT - 12, "median time [ns] against worst relative error")


def text(x, y, words, style=""):
    return f"<text x='{x:.1f}' y='{y:.1f}' {style}>{words}</text>"


def curve(panel, library, points):
    colour = COLOURS.get(library, "#000")
    places = [(panel.x(time), panel.y(error)) for time, error in points]
    path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in places)
    yield f"<path d='{path}' fill='none' stroke='{colour}'/>"
    for x, y in places:
        yield f"<circle cx='{x:.1f}' cy='{y:.1f}' r='3' fill='{colour}'/>"


def draw(tasks):
    times = [time for task in tasks.values() for line in task.values() for time, _ in line]
    libraries = sorted({library for task in tasks.values() for library in task})
    width = WIDTH * len(tasks) + 90
    yield (f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{HEIGHT}' "
           "font-family='sans-serif' font-size='11'>")
    yield "<rect width='100%' height='100%' fill='white'/>"
    for i, (task, lines) in enumerate(tasks.items()):
        panel = Panel(WIDTH * i, times)
        yield from panel.axes(task)
        for library, points in lines.items():
            yield from curve(panel, library, points)
    for i, library in enumerate(libraries):
        style = f"fill='{COLOURS.get(library, '#000')}' font-weight='bold'"
        yield text(width - 80, 50 + 18 * i, library, style)
    yield "</svg>"


def main():
    if len(sys.argv) != 3 or "--help" in sys.argv:
        print(__doc__)
        return 0 if "--help" in sys.argv else 2
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write("\n".join(draw(read(sys.argv[1]))) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
