# SPDX-License-Identifier: BSD-3-Clause
"""Time against error of every way to measure an overlap."""

import chart

STYLES = {"reduction": (chart.RED, "o"), "deepest point": (chart.BLACK, "s"),
          "exact": (chart.ORANGE, "D"), "bullet": (chart.GREY, "^"), "coal": (chart.BLUE, "s"),
          "fcl": (chart.ORANGE, "v"), "libccd": (chart.SKY, "<"), "libccd_mpr": (chart.SKY, ">"),
          "mujoco": (chart.GREEN, "P"), "ode": (chart.PINK, "X")}
LEAST = 1e-5  # what is right to more is drawn at the foot


def settings_of(runs):
    """{input: {setting: {start: (median ns, error that 5 % exceed)}}}"""
    inputs = {name: {} for name in ("box", "16v")}
    for run in runs:
        name, start, setting, *_ = run["name"].split("/")
        point = (run["p50_ns"], max(LEAST, run["p95_relative_error"]))
        inputs[name].setdefault(setting, {})[start] = point
    return inputs


def family(setting):
    """The reduction at every number of levels is one family."""
    return setting.rsplit(" ", 1)[0] if setting[-1].isdigit() else setting


def mark(panel, setting, points, style):
    hollow = {**style, "markerfacecolor": "white"}
    panel.plot(*zip(points["cold"], points["warm"]), color=style["color"], alpha=0.4)
    panel.plot(*points["cold"], **hollow)
    panel.plot(*points["warm"], **style)
    if family(setting) != setting:
        panel.annotate(setting.rsplit(" ", 1)[1], points["cold"], (4, 2),
                       textcoords="offset points", color=style["color"])


def draw(results, path):
    inputs = settings_of(results["benchmarks"])
    drawn = {family(name) for settings in inputs.values() for name in settings}
    names = [name for name in STYLES if name in drawn] + sorted(drawn - STYLES.keys())
    styles = chart.named(names, STYLES)
    _, ((*panels,),) = chart.panels(len(inputs), height=3.4, sharex=True, sharey=True)
    for panel, (name, settings) in zip(panels, inputs.items()):
        for setting, points in settings.items():
            mark(panel, setting, points, styles[family(setting)])
        for label, style in styles.items():
            panel.plot([], label=label, linestyle="none", **style)
        chart.logarithmic(panel, "x", (1, 2, 5))
        chart.logarithmic(panel, "y")
        panel.set(title=name, ylim=(LEAST / 1.6, 2),
                  xlabel="median time of a query [ns]; filled: warm, hollow: cold")
    panels[0].set(ylabel="relative error that 5 % exceed;\nat the foot: 10⁻⁵ or less")
    panels[0].annotate("numbers: levels of the ladder", (1, 0.74), xycoords="axes fraction",
                       ha="right", color=chart.RED)
    chart.legend(panels[-1])
    chart.save(panels[0].figure, path, "Overlap: time against error",
               "Median time of a query, warm and cold, against the relative error that 5 percent "
               "exceed, for every measure of overlap, of boxes and of hulls of 16 vertices.")
