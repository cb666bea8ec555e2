#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""plot_telepresence.py RESULTS.json FOLDER: delay.svg, force against time over a line of waves and a
plain one; transparency.svg, what the operator feels against frequency; zwidth.svg, the stiffest
wall against its damping; align.svg, the torque of the walls on a plate that is pressed flat, and its
jumps, against time. What has no results yet is left out."""

import json
import math
import os
import sys

import chart

WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 400, 340, 55, 40, 50
PALETTE = ("#c1121f", "#2a6f97", "#e09f3e", "#588157", "#7f7f7f")


class Axes:
    """One panel; what is beyond an end of an axis is drawn at that end."""

    def __init__(self, left, across, up):
        self.left, self.right = left + LEFT, left + WIDTH - 15
        self.across, self.up = across, up

    @staticmethod
    def share(value, axis):
        low, high, logarithmic = axis["low"], axis["high"], axis.get("log", False)
        if logarithmic:
            value, low, high = math.log10(max(value, 1e-300)), math.log10(low), math.log10(high)
        return (min(max(value, low), high) - low) / (high - low)

    def x(self, value):
        return self.left + self.share(value, self.across) * (self.right - self.left)

    def y(self, value):
        return HEIGHT - BOTTOM - self.share(value, self.up) * (HEIGHT - TOP - BOTTOM)

    def lines(self, title, foot):
        yield chart.text(self.left, 25, title, "font-weight='bold'")
        yield chart.text(self.left, HEIGHT - 12, foot)
        for mark in self.up["marks"]:
            y = self.y(mark)
            yield f"<path d='M{self.left} {y:.1f}H{self.right}' stroke='#ddd'/>"
            yield chart.text(self.left - 5, y + 4, f"{mark:g}", "text-anchor='end'")
        for mark in self.across["marks"]:
            x = self.x(mark)
            yield f"<path d='M{x:.1f} {TOP}V{HEIGHT - BOTTOM}' stroke='#ddd'/>"
            yield chart.text(x, HEIGHT - BOTTOM + 15, f"{mark:g}", "text-anchor='middle'")

    def curve(self, points, colour, style=""):
        path = "L".join(f"{self.x(x):.1f} {self.y(y):.1f}" for x, y in points)
        yield f"<path d='M{path}' fill='none' stroke='{colour}' {style}/>"


def decades(low, high, steps=(1,)):
    return {"low": low, "high": high, "log": True, "marks": [
        s * 10.0**n for n in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
        for s in steps if low <= s * 10.0**n <= high]}


def even(low, high, step):
    return {"low": low, "high": high,
            "marks": [low + step * n for n in range(int((high - low) / step + 0.5) + 1)]}


def picture(panels, colours):
    body = [line for panel in panels for line in panel]
    return chart.picture(WIDTH * len(panels) + 150, HEIGHT, list(colours), colours, body)


def delay(part):
    colours = {"plain": PALETTE[1], "waves": PALETTE[0]}
    panels = []
    for quantity in ("wall force [N]", "force at the hand [N]"):
        axes = Axes(WIDTH * len(panels), even(0, 10, 2), even(-150, 150, 50))
        panel = list(axes.lines(f"{quantity}, 100 ms, 5 % lost", "time [s]"))
        for way, colour in colours.items():
            run = part["series"][way]
            panel += axes.curve(zip(run["time [s]"], run[quantity]), colour)
        panels.append(panel)
    return picture(panels, colours)


def transparency(part):
    ways = list(dict.fromkeys(name.split(", ")[1] for name in part["series"]))
    colours = dict(zip(ways, PALETTE))
    panels = []
    for contact in ("free", "wall"):
        axes = Axes(WIDTH * len(panels), decades(0.2, 50, (1, 2, 5)), decades(1, 100000))
        panel = list(axes.lines(f"{contact}: impedance felt [N s/m], black: the truth",
                                "frequency [Hz]"))
        for way in ways:
            points = sorted(part["series"][f"{contact}, {way}"], key=lambda p: p["frequency [Hz]"])
            felt = [(p["frequency [Hz]"], p["felt [N s/m]"]) for p in points]
            panel += axes.curve(felt, colours[way])
        truth = [(p["frequency [Hz]"], p["felt [N s/m]"] / 10**(p["against the truth [dB]"] / 20))
                 for p in points]
        panel += axes.curve(truth, "#000")
        panels.append(panel)
    return picture(panels, colours)


def zwidth(part):
    rates = list(dict.fromkeys(row["rate [Hz]"] for row in part["rows"]))
    kinds = {"measured [kN/m]": "", "with controller [kN/m]": "stroke-dasharray='6 3'",
             "clean limit [kN/m]": "stroke-dasharray='1 3'"}
    axes = Axes(0, even(0, 160, 40), decades(1, 10000))
    panel = list(axes.lines("stiffest wall [kN/m]: line; dashed: with controller; dots: clean",
                            "damping of the wall [N s/m]"))
    colours = {}
    for rate, colour in zip(rates, PALETTE):
        colours[f"{rate:g} Hz"] = colour
        for kind, style in kinds.items():
            points = [(row["wall damping [N s/m]"], row[kind]) for row in part["rows"]
                      if row["rate [Hz]"] == rate and row[kind] > 0.0]
            panel += axes.curve(points, colour, style)
    return picture([panel], colours)


def align(part):
    runs = {name: run for name, run in part["series"].items() if "torque [N m]" in run}
    colours = dict(zip(runs, PALETTE))
    if not runs:
        return None
    panels = []
    for quantity, title in (("torque [N m]", "torque of the walls [N m], largest in 50 ms"),
                            ("jump [N m]", "its largest jump from tick to tick [N m]")):
        axes = Axes(WIDTH * len(panels), even(0, 6, 1), even(0, 25, 5))
        panel = list(axes.lines(title, "time [s]"))
        for name, colour in colours.items():
            panel += axes.curve(zip(runs[name]["time [s]"], runs[name][quantity]), colour)
        panels.append(panel)
    return picture(panels, {name.split("Figure 8, ")[-1]: c for name, c in colours.items()})


def main():
    if len(sys.argv) != 3 or "--help" in sys.argv:
        print(__doc__)
        sys.exit(0 if "--help" in sys.argv else 2)
    with open(sys.argv[1], encoding="utf-8") as file:
        parts = json.load(file)["parts"]
    for draw in (delay, transparency, zwidth, align):
        drawn = draw(parts[draw.__name__]) if draw.__name__ in parts else None
        if drawn is None:
            continue
        with open(os.path.join(sys.argv[2], draw.__name__ + ".svg"), "w", encoding="utf-8") as file:
            file.write("\n".join(drawn) + "\n")


if __name__ == "__main__":
    main()
