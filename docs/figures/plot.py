#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""plot.py CSV_FOLDER SVG_FOLDER: draws the curves that `figures` wrote."""

import argparse
import csv
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
import chart  # noqa: E402  after the folder where it is

SERIES = {"2 levels": chart.ORANGE, "8 levels": chart.GREEN, "32 levels": chart.BLUE,
          "deepest point": chart.RED}
WITNESSES = {"filtered": chart.ORANGE, "plain": chart.BLUE, "averaged": chart.RED}
LAWS = {"ceiling only": chart.ORANGE, "passable": chart.BLUE}
WALLS = {"spring": chart.ORANGE, "hard wall": chart.BLUE, "membrane": chart.RED}
LIMITS = {"limited by its force, 30 N": chart.ORANGE,
          "limited by its energy, 0.8 J": chart.BLUE, "soft, 150 N/m": chart.RED}
SHAPES = {"point, line, plane, path": chart.ORANGE, "tube of 20 mm": chart.BLUE,
          "cone, 80 mm above its tip": chart.RED}
LEGENDS = {"plain": "plain witness point", "filtered": "filtered over 5 ms",
           "averaged": "averaged over\nfour tilts"}


def curves(folder, name, keys, x, y):
    """{key: [(x, y)]}, the key being the values of `keys`."""
    found = {}
    with open(folder / name, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            found.setdefault(tuple(row[k] for k in keys), []).append((float(row[x]), float(row[y])))
    return found


def plot(panel, found, colours, *key, **how):
    """The curves of a key and each of the names of `colours`."""
    for name, colour in colours.items():
        panel.plot(*zip(*found[*key, name]), color=colour, label=LEGENDS.get(name, name), **how)


def sketch(panel, x_range, motion, outlines, directions, positions):
    """The cross sections at some positions, and where the force points there."""
    panel.set(aspect="equal", anchor="S", xlim=x_range)
    panel.set_axis_off()
    panel.fill(*zip(*[(min(x, x_range[1]), y) for x, y in outlines[motion, "B"]]),
               facecolor="#eeeeee", edgecolor="#888888", clip_on=False)
    body = outlines[motion, "A"]
    x, y = (sum(p[i] for p in body) / len(body) for i in (0, 1))
    length = 0.09 * (x_range[1] - x_range[0])
    for position in positions:
        panel.fill(*zip(*[(px + position, py) for px, py in body]), facecolor=chart.SKY + "40",
                   edgecolor=chart.BLUE)
        turn = math.radians(min(directions, key=lambda p: abs(p[0] - position))[1])
        panel.annotate("", (x + position + length * math.cos(turn), y + length * math.sin(turn)),
                       (x + position, y), zorder=3,
                       arrowprops={"arrowstyle": "-|>", "color": chart.BLACK, "shrinkA": 0})


def into_a_box(folder, path):
    directions = curves(folder, "motions.csv", ("motion", "series"), "position_mm",
                        "direction_deg")
    outlines = curves(folder, "outlines.csv", ("motion", "shape"), "x_mm", "y_mm")
    figure, panels = chart.panels(2, 2, height=4.6)
    for (above, below), motion in zip(panels.T, ("box", "turned box")):
        sketch(above, (-165, 25), motion, outlines, directions[motion, "8 levels"],
               (-125, -82, -25))
        plot(below, directions, SERIES, motion)
        below.set(xlim=(-165, 25), ylim=(80, 195), xticks=range(-150, 1, 50),
                  yticks=(90, 120, 150, 180), xlabel="position [mm]", ylabel="direction [deg]")
        for place, words in ((180, "back"), (90, "up")):
            below.annotate(words, (-162, place), (0, 2), textcoords="offset points",
                           color="#666666")
    chart.legend(panels[1, 1])
    chart.save(figure, path, "Into a box: direction against position",
               "A box, straight and turned, moves into a larger one: its cross section at three "
               "positions, and the direction of the force by each measure against the position.")


def through_a_rectangle(folder, path):
    keys = ("motion", "series")
    distances = curves(folder, "motions.csv", keys, "position_mm", "distance_mm")
    directions = curves(folder, "motions.csv", keys, "position_mm", "direction_deg")
    outlines = curves(folder, "outlines.csv", ("motion", "shape"), "x_mm", "y_mm")
    figure, ((above, beside), (whole, close)) = chart.panels(
        2, 2, height=5.4, gridspec_kw={"height_ratios": (8, 7), "width_ratios": (8, 5)})
    sketch(above, (-165, 165), "triangle", outlines, directions["triangle", "8 levels"],
           (-105, -45, 0, 60))
    for panel in whole, close:
        plot(panel, distances, SERIES, "triangle")
        panel.set(xlabel="position [mm]", ylabel="distance [mm]")
    whole.set(xlim=(-165, 165), ylim=(-60, 30), yticks=range(-60, 31, 15))
    close.set(xlim=(-82, -48), ylim=(-33, 3), title="the beginning of the overlap")
    beside.set_axis_off()
    beside.legend(*whole.get_legend_handles_labels(), loc="center left")
    chart.save(figure, path, "Through a rectangle: distance against position",
               "A triangle moves through a rectangle: its cross section at four positions, and "
               "the distance by each measure against the position, also enlarged.")


def parallel_plates(folder, path):
    keys = ("run", "rate_hz", "witness")
    tilts = curves(folder, "plates.csv", keys, "time_s", "tilt_deg")
    torques = curves(folder, "plates.csv", keys, "time_s", "torque_nm")
    tilts = {key: [(t, max(tilt, 1e-4)) for t, tilt in line] for key, line in tilts.items()}
    figure, panels = chart.panels(3, 2, height=4.8, sharey="row")
    for (tilt, torque), run in zip(panels.T, (("held, 20 N", "400"), ("held, 20 N", "1000"),
                                              ("bare, 20 N", "1000"))):
        plot(tilt, tilts, WITNESSES, *run)
        plot(torque, torques, WITNESSES, *run, drawstyle="steps-post")
        chart.logarithmic(tilt, "y")
        tilt.set(title=f"{run[0]}, loop of {run[1]} Hz", xlim=(0, 5), ylim=(0.8e-4, 300),
                 xlabel="time [s]")
        torque.set(xlim=(6.0, 6.03), xticks=(6.0, 6.01, 6.02, 6.03), ylim=(-8, 8),
                   yticks=range(-8, 9, 4), xlabel="time [s]")
    panels[0, 0].set(ylabel="tilt [deg]")
    panels[1, 0].set(ylabel="torque about x [N m]")
    chart.legend(panels[0, -1])
    with chart.pyplot.rc_context({"path.simplify_threshold": 0.4}):  # a tick is far below a pixel
        chart.save(figure, path, "Parallel plates: tilt and torque against time",
                   "Tilt of a plate over 5 seconds and torque over 30 milliseconds, held and bare, "
                   "at two rates of the loop, for plain, filtered and averaged witness points.")


def passages(folder, path):
    keys = ("body", "law")
    forces = {"up": curves(folder, "passages.csv", keys, "height_mm", "up_n"),
              "aside": curves(folder, "passages.csv", keys, "height_mm", "aside_n")}
    figure, panels = chart.panels(2, 2, width=7.6, height=4.8)
    for panel, (body, part, most, words) in zip(panels.flat, (
            ("membrane", "up", 15, "through a membrane of 4 mm"),
            ("tissue", "up", 6, "through tissue of 100 mm"),
            ("edge of the tissue", "up", 6, "over the edge of the tissue"),
            ("edge of the tissue", "aside", 6, "the same"))):
        plot(panel, forces[part], LAWS, body)
        panel.set(title=words, xlim=(120, -120), ylim=(-most, most), xticks=range(-100, 101, 50),
                  yticks=range(-most, most + 1, most // 3), xlabel="height of the finger [mm]",
                  ylabel=f"force {part} [N]")
    chart.legend(panels[0, 1])
    chart.save(figure, path, "Passages: force against height",
               "Force on a finger against its height, through a membrane, through tissue and over "
               "the edge of the tissue, by a law with a ceiling only and by a passable one.")


def walls(folder, path):
    figure, ((*panels,),) = chart.panels(2, width=7.6, height=2.9)
    for panel, what, label in zip(panels, ("ball_mm", "felt_n"),
                                  ("ball beyond the surface [mm]", "force that is felt [N]")):
        plot(panel, curves(folder, "walls.csv", ("wall",), "hand_mm", what), WALLS)
        panel.set(xlim=(-30, 70), ylim=(-30, 70), xticks=range(-20, 71, 20),
                  yticks=range(-20, 71, 20), xlabel="hand beyond the surface [mm]", ylabel=label)
    chart.legend(panels[1])
    chart.save(figure, path, "Walls: what a hand feels that pushes",
               "Place of a ball and force that is felt against the place of the hand that pushes "
               "it, at a spring, a hard wall and a membrane.")


def fixtures(folder, path):
    keys = ("what", "fixture")
    forces = curves(folder, "pulls.csv", keys, "distance_mm", "force_n")
    energies = curves(folder, "pulls.csv", keys, "distance_mm", "energy_j")
    figure, ((*panels,),) = chart.panels(3, height=3.1)
    for panel, (what, found, colours, most, words) in zip(panels, (
            ("limit", forces, LIMITS, 32, "force [N]"),
            ("limit", energies, LIMITS, 2, "energy stored [J]"),
            ("shape", forces, SHAPES, 32, "force [N]"))):
        plot(panel, found, colours, what)
        panel.set(xlim=(0, 150), ylim=(0, most), yticks=[most / 4 * k for k in range(5)],
                  xlabel="distance [mm]" if what == "limit" else "way aside [mm]", ylabel=words)
        panel.legend(loc="lower left", bbox_to_anchor=(0, 1))
    chart.save(figure, path, "Virtual fixtures: force and energy against distance",
               "Force and stored energy as a tool is led out of a fixture, for three kinds of "
               "limit, and the force for three shapes.")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("curves", metavar="CSV_FOLDER", type=pathlib.Path)
    parser.add_argument("pictures", metavar="SVG_FOLDER", type=pathlib.Path)
    arguments = parser.parse_args()
    for draw in (into_a_box, through_a_rectangle, parallel_plates, passages, walls, fixtures):
        draw(arguments.curves, arguments.pictures / f"{draw.__name__}.svg")


if __name__ == "__main__":
    main()
