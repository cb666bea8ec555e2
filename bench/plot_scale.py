#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""plot_scale.py RESULTS.json PLOT.svg: time of a tick against the number of pairs, way by way, and
the memory of a pair."""

import math

import chart

COLOURS = {"repel": "#c1121f", "repel, every pair": "#f77f00", "bullet, with forces": "#7f7f7f",
           "coal, with forces": "#2a6f97", "fcl, with forces": "#e09f3e"}
WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 330, 340, 60, 40, 50
FEWEST, MOST = 32, 1000000


def curves(runs, near, value):
    """{method: [(pairs, value)]} in the caller's thread; a wrong answer earns no point."""
    methods = {}
    for run in runs:
        if run.get("near") != near or run["method"] not in COLOURS:
            continue
        if run["threads"] == 0 and run["equal_to_brute_force"]:
            methods.setdefault(run["method"], []).append((run["pairs"], run[value]))
    return methods


class Axes:
    """Pairs from left to right, a value from bottom to top, both logarithmic."""

    def __init__(self, left, values):
        self.left, self.right = left + LEFT, left + WIDTH - 15
        self.low, self.high = math.floor(math.log10(min(values))), math.ceil(
            math.log10(max(values)))

    def x(self, pairs):
        share = math.log(pairs / FEWEST) / math.log(MOST / FEWEST)
        return self.left + share * (self.right - self.left)

    def y(self, value):
        share = (math.log10(value) - self.low) / max(1, self.high - self.low)
        return HEIGHT - BOTTOM - share * (HEIGHT - TOP - BOTTOM)

    def lines(self, title, foot):
        yield chart.text(self.left, 25, title, "font-weight='bold'")
        yield chart.text(self.left, HEIGHT - 12, foot)
        for digits in range(self.low, self.high + 1):
            y = self.y(10.0**digits)
            yield f"<path d='M{self.left} {y:.1f}H{self.right}' stroke='#ddd'/>"
            yield chart.text(self.left - 5, y + 4, f"{10.0**digits:g}", "text-anchor='end'")
        for pairs in (32, 1000, 100000, 1000000):
            x = self.x(pairs)
            yield f"<path d='M{x:.1f} {TOP}V{HEIGHT - BOTTOM}' stroke='#ddd'/>"
            yield chart.text(x, HEIGHT - BOTTOM + 15, f"{pairs:g}", "text-anchor='middle'")

    def curve(self, method, points):
        colour = COLOURS.get(method, "#000")
        places = [(self.x(pairs), self.y(value)) for pairs, value in sorted(points)]
        path = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in places)
        yield f"<path d='{path}' fill='none' stroke='{colour}'/>"
        for x, y in places:
            yield f"<circle cx='{x:.1f}' cy='{y:.1f}' r='3' fill='{colour}'/>"


def panel(left, methods, title, foot):
    axes = Axes(left, [value for points in methods.values() for _, value in points])
    yield from axes.lines(title, foot)
    for method, points in methods.items():
        yield from axes.curve(method, points)


def draw(runs):
    nears = sorted({run["near"] for run in runs if "near" in run})
    wanted = [(curves(runs, near, "mean_ns"), f"{near:g} near",
               "mean time of a tick [ns] against pairs") for near in nears]
    wanted.append((curves(runs, 3, "bytes_per_pair"), "memory, 3 near", "bytes per pair"))
    panels = [(methods, *words) for methods, *words in wanted if methods]
    body = [line for i, p in enumerate(panels) for line in panel(WIDTH * i, *p)]
    names = [name for name in COLOURS if any(name in methods for methods, *_ in panels)]
    return chart.picture(WIDTH * len(panels) + 120, HEIGHT, names, COLOURS, body)


if __name__ == "__main__":
    chart.main(__doc__, draw)
