#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""plot_overlap.py RESULTS.json PLOT.svg: time against error of every way to measure an overlap."""

import math

import chart

COLOURS = {"reduction": "#c1121f", "deepest point": "#780000", "exact": "#f77f00",
           "bullet": "#7f7f7f", "coal": "#2a6f97", "fcl": "#e09f3e", "libccd": "#8e6bbf",
           "libccd_mpr": "#c8a2e0", "mujoco": "#588157", "ode": "#8b5e34"}
WIDTH, HEIGHT, LEFT, TOP, BOTTOM = 435, 340, 75, 40, 60
DIGITS = 5  # what is right to more is drawn at the foot


def settings_of(runs):
    """{input: {setting: {start: (median ns, error that 5 % exceed)}}}"""
    inputs = {name: {} for name in ("box", "16v")}
    for run in runs:
        name, start, setting, *_ = run["name"].split("/")
        point = (run["p50_ns"], run["p95_relative_error"])
        inputs[name].setdefault(setting, {})[start] = point
    return inputs


def height_of(error):
    digits = min(DIGITS, -math.log10(max(error, 1e-300)))
    return TOP + (HEIGHT - TOP - BOTTOM) * digits / DIGITS


def axes(panel, name):
    yield from panel.title(name)
    for digits in range(DIGITS + 1):
        label = "1" if digits == 0 else f"1e-{digits}"
        yield from panel.level(height_of(10.0**-digits),
                               f"below {label}" if digits == DIGITS else label)
    yield from panel.times()
    yield chart.text(panel.left, HEIGHT - 22,
                     "median time [ns] against the error that 5 % exceed;")
    yield chart.text(panel.left, HEIGHT - 8,
                     "filled warm, hollow cold; numbers: levels of the ladder")


def family(setting):
    """The reduction at every number of levels is one family."""
    return setting.rsplit(" ", 1)[0] if setting[-1].isdigit() else setting


def mark(panel, setting, points):
    colour = COLOURS.get(family(setting), "#000")
    places = {start: (panel.x(time), height_of(error)) for start, (time, error) in points.items()}
    (x, y), (cold_x, cold_y) = places["warm"], places["cold"]
    yield f"<path d='M{cold_x:.1f} {cold_y:.1f}L{x:.1f} {y:.1f}' stroke='{colour}' opacity='0.4'/>"
    yield f"<circle cx='{cold_x:.1f}' cy='{cold_y:.1f}' r='3' fill='white' stroke='{colour}'/>"
    yield f"<circle cx='{x:.1f}' cy='{y:.1f}' r='3.5' fill='{colour}'/>"
    if family(setting) != setting:
        yield chart.text(cold_x + 5, cold_y - 3, setting.rsplit(" ", 1)[1], f"fill='{colour}'")


def panels(inputs):
    times = [time for settings in inputs.values() for points in settings.values()
             for time, _ in points.values()]
    for i, (name, settings) in enumerate(inputs.items()):
        left = WIDTH * i
        panel = chart.Panel(left + LEFT, left + WIDTH - 20, TOP, HEIGHT - BOTTOM, times)
        yield from axes(panel, name)
        for setting, points in settings.items():
            yield from mark(panel, setting, points)


def draw(runs):
    inputs = settings_of(runs)
    drawn = {family(name) for settings in inputs.values() for name in settings}
    families = [name for name in COLOURS if name in drawn] + sorted(drawn - COLOURS.keys())
    return chart.picture(WIDTH * len(inputs) + 110, HEIGHT, families, COLOURS, panels(inputs))


if __name__ == "__main__":
    chart.main(__doc__, draw)
