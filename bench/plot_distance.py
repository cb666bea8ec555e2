# SPDX-License-Identifier: BSD-3-Clause
"""Time against error of every library, tolerance by tolerance."""

import chart

STYLES = {"repel": (chart.RED, "o"), "bullet": (chart.GREY, "^"), "coal": (chart.BLUE, "s"),
          "fcl": (chart.ORANGE, "D"), "mujoco": (chart.GREEN, "P"), "opengjk": (chart.PINK, "v"),
          "dgd": (chart.SKY, "X")}
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


def draw(results, path):
    tasks = curves(results["benchmarks"])
    names = [name for name in STYLES if any(name in task for task in tasks.values())]
    names += sorted({name for task in tasks.values() for name in task} - set(names))
    figure, ((*panels,),) = chart.panels(len(tasks), sharex=True, sharey=True)
    for panel, (task, lines) in zip(panels, tasks.items()):
        for name, style in chart.named(names, STYLES).items():
            panel.plot(*zip(*lines.get(name, [(float("nan"),) * 2])), label=name, **style)
        chart.logarithmic(panel, "x", (1, 2, 5))
        chart.logarithmic(panel, "y", every=3)
        panel.set(title=f"{task}, cold", xlabel="median time of a query [ns]")
    panels[0].set(ylabel="worst relative error", ylim=(LOWEST, 10))
    chart.legend(panels[-1])
    chart.save(figure, path, "Distance: time against error",
               "Median time of a cold query against the worst relative error, a curve for each "
               "library and a point for each tolerance, for boxes and hulls of 8 and 32 vertices.")
