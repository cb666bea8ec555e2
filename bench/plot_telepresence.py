# SPDX-License-Identifier: BSD-3-Clause
"""What an operator feels, part by part."""

import chart

PALETTE = (chart.RED, chart.BLUE, chart.GREEN, chart.ORANGE, chart.PINK)
MOST_FORCE = 150  # [N]; more is drawn at the end of the axis


def clipped(values):
    return [min(max(value, -MOST_FORCE), MOST_FORCE) for value in values]


def delay(part, path):
    """Force against time over a line of waves and a plain one."""
    _, ((*panels,),) = chart.panels(2, sharex=True, sharey=True)
    for panel, quantity in zip(panels, ("wall force [N]", "force at the hand [N]")):
        for way, colour in (("plain", chart.BLUE), ("waves", chart.RED)):
            run = part["series"][way]
            panel.plot(run["time [s]"], clipped(run[quantity]), color=colour, label=way)
        panel.set(title="100 ms, 5 % lost; beyond 150 N drawn at 150 N", xlabel="time [s]",
                  ylabel=quantity, xlim=(0, 10), ylim=(-MOST_FORCE * 1.03, MOST_FORCE * 1.03))
    chart.legend(panels[-1])
    chart.save(panels[0].figure, path, "Delay: force against time",
               "Force of the wall and force at the hand over 10 seconds, on a line of waves and on "
               "a plain one, delayed by 100 ms; forces beyond 150 N are drawn at 150 N.")


def transparency(part, path):
    """What the operator feels against frequency."""
    ways = list(dict.fromkeys(name.split(", ")[1] for name in part["series"]))
    _, ((*panels,),) = chart.panels(2, sharex=True, sharey=True)
    for panel, contact in zip(panels, ("free", "wall")):
        for way, colour in zip(ways, PALETTE):
            points = sorted(part["series"][f"{contact}, {way}"], key=lambda p: p["frequency [Hz]"])
            frequencies = [p["frequency [Hz]"] for p in points]
            panel.plot(frequencies, [p["felt [N s/m]"] for p in points], color=colour, label=way)
        truth = [p["felt [N s/m]"] / 10**(p["against the truth [dB]"] / 20) for p in points]
        panel.plot(frequencies, truth, color=chart.BLACK, linewidth=1.8, label="the truth")
        chart.logarithmic(panel, "x", (1, 2, 5))
        chart.logarithmic(panel, "y")
        panel.set(title=contact, xlabel="frequency [Hz]", xlim=(0.2, 50), ylim=(1, 1e5))
    panels[0].set(ylabel="impedance felt [N s/m]")
    chart.legend(panels[-1])
    chart.save(panels[0].figure, path, "Transparency: impedance against frequency",
               "Impedance that the operator feels against frequency, free and at a wall, beside "
               "the true one, directly and over waves of several delays.")


def zwidth(part, path):
    """The stiffest wall against its damping."""
    rates = list(dict.fromkeys(row["rate [Hz]"] for row in part["rows"]))
    kinds = {"measured": "-", "with controller": "--", "clean limit": ":"}
    _, ((panel,),) = chart.panels(1, width=6.4, height=3.6)
    for rate, colour in zip(rates, PALETTE):
        for kind, dashes in kinds.items():
            points = [(row["wall damping [N s/m]"], row[f"{kind} [kN/m]"]) for row in part["rows"]
                      if row["rate [Hz]"] == rate and row[f"{kind} [kN/m]"] > 0.0]
            panel.plot(*zip(*points), dashes, color=colour, label=f"{rate:g} Hz, {kind}")
    chart.logarithmic(panel, "y")
    panel.set(xlabel="damping of the wall [N s/m]", ylabel="stiffest wall [kN/m]", xlim=(0, 160),
              ylim=(1, 1e4), xticks=range(0, 161, 40))
    chart.name_ends(panel, [line for line in panel.lines if line.get_linestyle() != ":"])
    panel.annotate("dotted: clean limits", panel.lines[2].get_xydata()[-1], (6, -3),
                   textcoords="offset points")
    chart.save(panel.figure, path, "Z-width: the stiffest wall against its damping",
               "Stiffest wall against its damping at several rates of the loop: as measured, with "
               "the controller, and the clean limit.")


def align(part, path):
    """The torque of the walls on a plate that is pressed flat, and its jumps, against time."""
    runs = {name: run for name, run in part["series"].items() if "torque [N m]" in run}
    if not runs:
        return
    _, ((*panels,),) = chart.panels(2, sharex=True)
    for panel, quantity, label in zip(panels, ("torque [N m]", "jump [N m]"), (
            "torque of the walls, largest in 50 ms [N m]",
            "its largest jump from tick to tick [N m]")):
        for (name, run), colour in zip(runs.items(), PALETTE):
            panel.plot(run["time [s]"], run[quantity], color=colour,
                       label=name.split("Figure 8, ")[-1])
        panel.set(xlabel="time [s]", ylabel=label, xlim=(0, 6), ylim=(0, None))
    chart.legend(panels[-1])
    chart.save(panels[0].figure, path, "Align: torque of the walls against time",
               "Torque of the walls on a plate that is pressed flat, and its largest jump from "
               "tick to tick, over 6 seconds at several rates, with relief and without.")
