# SPDX-License-Identifier: BSD-3-Clause
"""Error of a motion against the run time of a step, engine by engine, in more and more
sub-steps."""

import chart

STYLES = {"bullet": (chart.GREY, "^"), "ode": (chart.BLUE, "s"), "mujoco": (chart.GREEN, "P"),
          "reference": (chart.RED, "o")}
BELOW = {"bullet"}  # its sub-steps stand there, since its curve runs beside that of ode
LEAST_ERROR = 1e-10  # [mrad]; the truth is hardly better known


def curve(panel, rows, name, style):
    """What is wrong has earned no time and no point."""
    points = [(r["step [us]"], max(LEAST_ERROR, r["error [mrad]"]), r["sub-steps"])
              for r in rows if r["engine"] == name and r["step [us]"]]
    panel.plot(*zip(*[point[:2] for point in points]), label=name, **style)
    away, across, up = (-3, "right", "top") if name in BELOW else (3, "left", "bottom")
    for time, error, substeps in points:
        panel.annotate(substeps, (time, error), (away, away), textcoords="offset points",
                       ha=across, va=up, color=style["color"], fontsize=7)


def draw(part, path):
    rows = part["rows"]
    arms = list(dict.fromkeys(row["arm"] for row in rows))
    figure, ((*panels,),) = chart.panels(len(arms), sharex=True, sharey=True)
    for panel, arm in zip(panels, arms):
        measured = [name for name in STYLES if any(row["engine"] == name for row in rows)]
        for name, style in chart.named(measured, STYLES).items():
            curve(panel, [row for row in rows if row["arm"] == arm], name, style)
        chart.logarithmic(panel, "x", (1, 3))
        chart.logarithmic(panel, "y", every=2)
        panel.set(title=arm, xlim=(0.3, 1000), ylim=(LEAST_ERROR / 3, 30),
                  xlabel="time of a step of 2.5 ms [µs]; numbers: sub-steps")
    panels[0].set(ylabel="error of a second of motion [mrad]")
    chart.legend(panels[-1])
    chart.save(figure, path, "Engines: error against time",
               "Error of a second of motion against the time of a step, a curve for each engine "
               "and a point for each number of sub-steps, for each arm.")
