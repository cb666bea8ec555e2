#!/usr/bin/env python3
"""plot.py RESULTS.json PLOT.svg: time against error of every way to measure an overlap."""

import json
import math
import sys

COLOURS = {"reduction": "#c1121f", "deepest point": "#780000", "exact": "#f77f00",
           "bullet": "#7f7f7f", "coal": "#2a6f97", "fcl": "#e09f3e", "libccd": "#8e6bbf",
           "libccd_mpr": "#c8a2e0", "mujoco": "#588157", "ode": "#8b5e34"}
WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 435, 340, 75, 40, 60
DIGITS = 5  # what is right to more is drawn at the foot


def read(path):
    """{input: {setting: {start: (median ns, error that 5 % exceed)}}}"""
    with open(path, encoding="utf-8") as file:
        runs = json.load(file)["benchmarks"]
    inputs = {name: {} for name in ("box", "16v")}
    for run in runs:
        name, start, setting, *_ = run["name"].split("/")
        point = (run["p50_ns"], run["p95_relative_error"])
        inputs[name].setdefault(setting, {})[start] = point
    return inputs


def text(x, y, words, style=""):
    return f"<text x='{x:.1f}' y='{y:.1f}' {style}>{words}</text>"


class Panel:
    """One input: logarithmic axes, the same for all inputs."""

    def __init__(self, left, times):
        self.left = left + LEFT
        self.right = left + WIDTH - 20
        self.low, self.high = math.log10(min(times) / 1.2), math.log10(max(times) * 1.2)

    def x(self, time):
        share = (math.log10(time) - self.low) / (self.high - self.low)
        return self.left + share * (self.right - self.left)

    def y(self, error):
        digits = min(DIGITS, -math.log10(max(error, 1e-300)))
        return TOP + (HEIGHT - TOP - BOTTOM) * digits / DIGITS

    def axes(self, name):
        yield text(self.left, 25, name, "font-weight='bold'")
        for digits in range(DIGITS + 1):
            y = self.y(10.0**-digits)
            label = "1" if digits == 0 else f"1e-{digits}"
            yield f"<path d='M{self.left} {y:.1f}H{self.right}' stroke='#ddd'/>"
            yield text(self.left - 5, y + 4, f"below {label}" if digits == DIGITS else label,
                       "text-anchor='end'")
        for time in (100, 200, 500, 1000, 2000, 5000, 10000, 20000):
            if self.low < math.log10(time) < self.high:
                x = self.x(time)
                yield f"<path d='M{x:.1f} {TOP}V{HEIGHT - BOTTOM}' stroke='#ddd'/>"
                yield text(x, HEIGHT - BOTTOM + 15, time, "text-anchor='middle'")
        yield text(self.left, HEIGHT - 22, "median time [ns] against the error that 5 % exceed;")
        yield text(self.left, HEIGHT - 8, "filled warm, hollow cold; numbers: levels of the ladder")


def family(setting):
    """The reduction at every number of levels is one family."""
    return setting.rsplit(" ", 1)[0] if setting[-1].isdigit() else setting


def mark(panel, setting, points):
    colour = COLOURS.get(family(setting), "#000")
    places = {start: (panel.x(time), panel.y(error)) for start, (time, error) in points.items()}
    (x, y), (cold_x, cold_y) = places["warm"], places["cold"]
    yield f"<path d='M{cold_x:.1f} {cold_y:.1f}L{x:.1f} {y:.1f}' stroke='{colour}' opacity='0.4'/>"
    yield f"<circle cx='{cold_x:.1f}' cy='{cold_y:.1f}' r='3' fill='white' stroke='{colour}'/>"
    yield f"<circle cx='{x:.1f}' cy='{y:.1f}' r='3.5' fill='{colour}'/>"
    if family(setting) != setting:
        yield text(cold_x + 5, cold_y - 3, setting.rsplit(" ", 1)[1], f"fill='{colour}'")


def draw(inputs):
    times = [time for settings in inputs.values() for points in settings.values()
             for time, _ in points.values()]
    drawn = {family(name) for settings in inputs.values() for name in settings}
    families = [name for name in COLOURS if name in drawn] + sorted(drawn - COLOURS.keys())
    width = WIDTH * len(inputs) + 110
    yield (f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{HEIGHT}' "
           "font-family='sans-serif' font-size='11'>")
    yield "<rect width='100%' height='100%' fill='white'/>"
    for i, (name, settings) in enumerate(inputs.items()):
        panel = Panel(WIDTH * i, times)
        yield from panel.axes(name)
        for setting, points in settings.items():
            yield from mark(panel, setting, points)
    for i, name in enumerate(families):
        style = f"fill='{COLOURS.get(name, '#000')}' font-weight='bold'"
        yield text(width - 100, 50 + 18 * i, name, style)
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
