# SPDX-License-Identifier: BSD-3-Clause
"""Time of a tick against the number of pairs, way by way, and the memory of a pair."""

import chart

STYLES = {"repel": (chart.RED, "o"), "repel, every pair": (chart.BLACK, "X"),
          "bullet, with forces": (chart.GREY, "^"), "coal, with forces": (chart.BLUE, "s"),
          "fcl, with forces": (chart.ORANGE, "D")}


def curves(runs, near, value):
    """{method: [(pairs, value)]} in the caller's thread; a wrong answer earns no point."""
    methods = {}
    for run in runs:
        if run.get("near") != near or run["method"] not in STYLES:
            continue
        if run["threads"] == 0 and run["equal_to_brute_force"]:
            methods.setdefault(run["method"], []).append((run["pairs"], run[value]))
    return methods


def draw(results, path):
    runs = results["benchmarks"]
    wanted = [(curves(runs, near, "mean_ns"), f"{near:g} near", "mean time of a tick [ns]")
              for near in sorted({run["near"] for run in runs if "near" in run})]
    wanted.append((curves(runs, 3, "bytes_per_pair"), "memory, 3 near", "memory of a pair [B]"))
    wanted = [each for each in wanted if each[0]]
    columns = min(3, len(wanted))
    figure, panels = chart.panels(columns, -(-len(wanted) // columns), height=5.2, sharex=True)
    panels = list(panels.flat)
    for panel, (methods, title, label) in zip(panels, wanted):
        for name, style in chart.named(STYLES, STYLES).items():
            if name in methods:
                panel.plot(*zip(*sorted(methods[name])), label=name, **style)
        chart.logarithmic(panel, "x")
        panel.set_xticks((32, 1000, 100000, 1000000))
        chart.logarithmic(panel, "y", (1, 2, 5) if "[B]" in label else (1,))
        panel.set(title=title, xlabel="pairs", ylabel=label)
        panel.tick_params(labelbottom=True)
    handles = panels[0].get_legend_handles_labels()
    for panel in panels[len(wanted):]:
        panel.set_axis_off()
    panels[-1].legend(*handles, loc="center left")
    chart.save(figure, path, "Scale: time of a tick against pairs",
               "Mean time of a tick against the number of pairs, a panel for each number of near "
               "pairs and a curve for each method, and the memory of a pair.")
