# SPDX-License-Identifier: BSD-3-Clause
"""Measured against true depth, a panel for each tool, as bench/measures/compare.py found them."""

import chart

STYLES = {"reduction, 2 levels": {"color": chart.ORANGE},
          "reduction, 8 levels": {"color": chart.GREEN},
          "reduction, 32 levels": {"color": chart.BLUE},
          "deepest point": {"color": chart.RED, "linewidth": 1.8},
          "exact": {"color": chart.BLACK, "linestyle": (0, (4, 4))}}


def draw(results, path):
    tools = list(dict.fromkeys(curve["tool"] for curve in results["curves"]))
    _, ((*panels,),) = chart.panels(len(tools), height=2.4, sharey=True)
    for panel, tool in zip(panels, tools):
        of_tool = {c["measure"]: c for c in results["curves"] if c["tool"] == tool}
        for name, style in STYLES.items():
            curve = of_tool[name]
            panel.plot(curve["true [mm]"], curve["measured [mm]"], label=name, **style)
        panel.set(title=tool, aspect="equal", xlim=(-0.6, 40), ylim=(-0.6, 40),
                  xticks=range(0, 41, 10), yticks=range(0, 41, 10), xlabel="true depth [mm]")
    panels[0].set(ylabel="measured depth [mm]")
    chart.legend(panels[-1])
    chart.save(panels[0].figure, path, "Measures: measured against true depth",
               "Measured depth against the true one, by each measure of overlap, for a plate, an "
               "edge, a corner and a cone that enter a table.")
