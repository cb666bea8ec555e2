#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""plot.py CSV_FOLDER SVG_FOLDER: draws the curves that `figures` wrote."""

import csv
import math
import os
import sys

# Okabe and Ito: told apart with any colour vision.
SERIES = {"2 levels": "#e69f00", "8 levels": "#009e73", "32 levels": "#0072b2",
          "deepest point": "#d55e00"}
WITNESSES = {"filtered": "#e69f00", "plain": "#0072b2", "averaged": "#d55e00"}
LAWS = {"ceiling only": "#e69f00", "passable": "#0072b2"}
WALLS = {"spring": "#e69f00", "hard wall": "#0072b2", "membrane": "#d55e00"}
LIMITS = {"limited by its force, 30 N": "#e69f00", "limited by its energy, 0.8 J": "#0072b2",
          "soft, 150 N/m": "#d55e00"}
SHAPES = {"point, line, plane, path": "#e69f00", "tube of 20 mm": "#0072b2",
          "cone, 80 mm above its tip": "#d55e00"}
LEGENDS = {"plain": "plain witness point", "filtered": "filtered over 5 ms",
           "averaged": "averaged over four tilts"}


def rows(folder, name):
    with open(os.path.join(folder, name), encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)


def curves(folder, name, keys, x, y):
    """{key: [(x, y)]}, the key being the values of `keys`."""
    found = {}
    for row in rows(folder, name):
        found.setdefault(tuple(row[k] for k in keys), []).append((float(row[x]), float(row[y])))
    return found


def text(x, y, words, style=""):
    return f"<text x='{x:.1f}' y='{y:.1f}' {style}>{words}</text>"


def path(points, style, closed=False):
    d = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points) + ("Z" if closed else "")
    return f"<path d='{d}' {style}/>"


def without_inner(points):
    """Without the points that the straight line between their neighbours passes anyway."""
    kept = points[:2]
    for p in points[2:]:
        (ax, ay), (bx, by) = kept[-2:]
        if abs((bx - ax) * (p[1] - ay) - (by - ay) * (p[0] - ax)) < 0.02 * math.dist((ax, ay), p):
            kept.pop()
        kept.append(p)
    return kept


def envelope(points):
    """The lowest and the highest point of every half pixel."""
    columns = {}
    for p in points:
        columns.setdefault(round(2 * p[0]), []).append(p)
    for column in columns.values():
        yield from sorted({min(column, key=lambda p: p[1]), max(column, key=lambda p: p[1])})


def held(points):
    """As steps: each value stays until the next."""
    for (ax, ay), (bx, _) in zip(points, points[1:]):
        yield from ((ax, ay), (bx, ay))


class Panel:
    """Axes in a box of the picture; `logarithmic` is said of y."""

    def __init__(self, box, x_range, y_range, logarithmic=False):
        self.left, self.top, self.width, self.height = box
        self.x_range, self.y_range, self.logarithmic = x_range, y_range, logarithmic

    def scaled(self, y):
        return math.log10(max(y, 1e-300)) if self.logarithmic else y

    def x(self, x):
        low, high = self.x_range
        return self.left + self.width * (x - low) / (high - low)

    def y(self, y):
        low, high = (self.scaled(end) for end in self.y_range)
        share = (self.scaled(y) - low) / (high - low)
        return self.top + self.height * (1 - min(max(share, 0), 1))

    def points(self, line):
        low, high = sorted(self.x_range)
        return [(self.x(x), self.y(y)) for x, y in line if low <= x <= high]

    def axes(self, x_ticks, y_ticks, x_label, y_label):
        bottom = self.top + self.height
        for value in x_ticks:
            x = self.x(value)
            yield f"<path d='M{x:.1f} {self.top}V{bottom}' stroke='#e4e4e4'/>"
            yield text(x, bottom + 15, f"{value:g}", "text-anchor='middle'")
        for value in y_ticks:
            y = self.y(value)
            yield f"<path d='M{self.left} {y:.1f}H{self.left + self.width}' stroke='#e4e4e4'/>"
            yield text(self.left - 5, y + 4, f"{value:g}", "text-anchor='end'")
        yield text(self.left + self.width / 2, bottom + 32, x_label, "text-anchor='middle'")
        x, y = self.left - 42, self.top + self.height / 2
        yield text(x, y, y_label, f"text-anchor='middle' transform='rotate(-90 {x} {y})'")

    def curve(self, line, colour, thin=without_inner):
        return path(list(thin(self.points(line))),
                    f"fill='none' stroke='{colour}' stroke-width='1.5' stroke-linejoin='round'")


class Sketch:
    """The cross sections above a panel, at the scale of its x axis."""

    def __init__(self, panel, middle):
        self.panel, self.middle = panel, middle
        low, high = panel.x_range
        self.scale = panel.width / (high - low)

    def place(self, point, shift=0.0):
        return self.panel.x(point[0] + shift), self.middle - self.scale * point[1]

    def shape(self, outline, style, shift=0.0):
        return path([self.place(p, shift) for p in outline], style, closed=True)

    def arrow(self, point, shift, degrees):
        (x, y), turn = self.place(point, shift), math.radians(degrees)
        ax, ay = math.cos(turn), -math.sin(turn)
        tip = x + 26 * ax, y + 26 * ay
        wings = [(tip[0] - 7 * ax + s * 3.5 * ay, tip[1] - 7 * ay - s * 3.5 * ax) for s in (1, -1)]
        yield path([(x, y), (tip[0] - 6 * ax, tip[1] - 6 * ay)], "stroke='#000' stroke-width='2'")
        yield path([tip, *wings], "fill='#000'", closed=True)


def sketch(panel, middle, motion, outlines, directions, positions):
    drawing = Sketch(panel, middle)
    right = panel.x_range[1]
    block = [(min(x, right), y) for x, y in outlines[motion, "B"]]
    yield drawing.shape(block, "fill='#eeeeee' stroke='#888'")
    body = outlines[motion, "A"]
    middle_of_body = [sum(p[i] for p in body) / len(body) for i in (0, 1)]
    for position in positions:
        yield drawing.shape(body, "fill='#56b4e9' fill-opacity='0.25' stroke='#0072b2'", position)
    for position in positions:
        nearest = min(directions, key=lambda p: abs(p[0] - position))
        yield from drawing.arrow(middle_of_body, position, nearest[1])


def legend(left, top, colours, names=None):
    for i, (name, colour) in enumerate(colours.items()):
        y = top + 17 * i
        yield f"<path d='M{left} {y - 4}h18' stroke='{colour}' stroke-width='2.5'/>"
        yield text(left + 24, y, (names or {}).get(name, name))


def into_a_box(folder):
    directions = curves(folder, "motions.csv", ("motion", "series"), "position_mm",
                        "direction_deg")
    outlines = curves(folder, "outlines.csv", ("motion", "shape"), "x_mm", "y_mm")
    for i, motion in enumerate(("box", "turned box")):
        panel = Panel((70 + 380 * i, 190, 300, 190), (-165, 25), (80, 190))
        yield from sketch(panel, 100, motion, outlines, directions[motion, "8 levels"],
                          (-125, -82, -25))
        yield from panel.axes(range(-150, 1, 50), (90, 120, 150, 180), "position [mm]",
                              "direction [deg]")
        yield text(panel.left + 4, panel.y(180) - 4, "back", "fill='#666'")
        yield text(panel.left + 4, panel.y(90) - 4, "up", "fill='#666'")
        for series, colour in SERIES.items():
            yield panel.curve(directions[motion, series], colour)
    yield from legend(765, 205, SERIES)


def through_a_rectangle(folder):
    distances = curves(folder, "motions.csv", ("motion", "series"), "position_mm", "distance_mm")
    directions = curves(folder, "motions.csv", ("motion", "series"), "position_mm",
                        "direction_deg")
    outlines = curves(folder, "outlines.csv", ("motion", "shape"), "x_mm", "y_mm")
    whole = Panel((70, 230, 400, 230), (-165, 165), (-60, 30))
    close = Panel((550, 230, 260, 230), (-82, -48), (-33, 3))
    yield from sketch(whole, 130, "triangle", outlines, directions["triangle", "8 levels"],
                      (-105, -45, 0, 60))
    yield from whole.axes(range(-150, 151, 50), range(-60, 31, 15), "position [mm]",
                          "distance [mm]")
    yield from close.axes(range(-80, -49, 10), range(-30, 1, 5), "position [mm]", "distance [mm]")
    yield text(close.left, close.top - 10, "the beginning of the overlap", "font-weight='bold'")
    for series, colour in SERIES.items():
        yield whole.curve(distances["triangle", series], colour)
        yield close.curve(distances["triangle", series], colour)
    yield from legend(560, 60, SERIES)


def parallel_plates(folder):
    keys = ("run", "rate_hz", "witness")
    tilts = curves(folder, "plates.csv", keys, "time_s", "tilt_deg")
    torques = curves(folder, "plates.csv", keys, "time_s", "torque_nm")
    for i, run in enumerate((("held, 20 N", "400"), ("held, 20 N", "1000"),
                             ("bare, 20 N", "1000"))):
        left = 70 + 310 * i
        tilt = Panel((left, 60, 235, 170), (0, 5), (1e-4, 200), logarithmic=True)
        torque = Panel((left, 300, 235, 150), (6.0, 6.03), (-8, 8))
        yield text(left, 45, f"{run[0]}, loop of {run[1]} Hz", "font-weight='bold'")
        yield from tilt.axes(range(0, 6), [10.0**k for k in range(-4, 3)], "time [s]",
                             "tilt [deg]")
        yield from torque.axes((6.0, 6.01, 6.02, 6.03), range(-8, 9, 4), "time [s]",
                               "torque about x [N m]")
        for witness, colour in WITNESSES.items():
            yield tilt.curve(tilts[*run, witness], colour, envelope)
            yield torque.curve(torques[*run, witness], colour, held)
    for i, (name, colour) in enumerate(WITNESSES.items()):
        yield from legend(70 + 200 * i, 20, {name: colour}, LEGENDS)


def passages(folder):
    keys = ("body", "law")
    forces = {"up": curves(folder, "passages.csv", keys, "height_mm", "up_n"),
              "aside": curves(folder, "passages.csv", keys, "height_mm", "aside_n")}
    for i, (body, part, most, words) in enumerate((
            ("membrane", "up", 15, "through a membrane of 4 mm"),
            ("tissue", "up", 6, "through tissue of 100 mm"),
            ("edge of the tissue", "up", 6, "over the edge of the tissue"),
            ("edge of the tissue", "aside", 6, "the same"))):
        panel = Panel((70 + 290 * (i % 2), 50 + 250 * (i // 2), 220, 170), (120, -120),
                      (-most, most))
        yield text(panel.left, panel.top - 12, words, "font-weight='bold'")
        yield from panel.axes(range(-100, 101, 50), range(-most, most + 1, most // 3),
                              "height of the finger [mm]", f"force {part} [N]")
        for law, colour in LAWS.items():
            yield panel.curve(forces[part][body, law], colour)
    yield from legend(590, 70, LAWS)


def walls(folder):
    for i, (what, label) in enumerate((("ball_mm", "ball beyond the surface [mm]"),
                                       ("felt_n", "force that is felt [N]"))):
        panel = Panel((70 + 330 * i, 30, 250, 210), (-30, 70), (-30, 70))
        yield from panel.axes(range(-20, 71, 20), range(-20, 71, 20),
                              "hand beyond the surface [mm]", label)
        for (wall,), line in curves(folder, "walls.csv", ("wall",), "hand_mm", what).items():
            yield panel.curve(line, WALLS[wall])
    yield from legend(670, 50, WALLS)


def fixtures(folder):
    keys = ("what", "fixture")
    forces = curves(folder, "pulls.csv", keys, "distance_mm", "force_n")
    energies = curves(folder, "pulls.csv", keys, "distance_mm", "energy_j")
    for i, (what, found, colours, most, step, words) in enumerate((
            ("limit", forces, LIMITS, 32, 8, "force [N]"),
            ("limit", energies, LIMITS, 2, 0.5, "energy stored [J]"),
            ("shape", forces, SHAPES, 32, 8, "force [N]"))):
        panel = Panel((70 + 290 * i, 85, 220, 190), (0, 150), (0, most))
        yield from panel.axes(range(0, 151, 50), [step * k for k in range(int(most / step) + 1)],
                              "distance [mm]" if what == "limit" else "way aside [mm]", words)
        for name, colour in colours.items():
            yield panel.curve(found[what, name], colour, list)
        if i != 1:
            yield from legend(panel.left, 25, colours)


PICTURES = {"into_a_box": (into_a_box, 880, 430),
            "through_a_rectangle": (through_a_rectangle, 840, 510),
            "parallel_plates": (parallel_plates, 950, 500),
            "passages": (passages, 700, 530),
            "walls": (walls, 770, 300),
            "fixtures": (fixtures, 900, 320)}


def main():
    if len(sys.argv) != 3 or "--help" in sys.argv:
        print(__doc__)
        return 0 if "--help" in sys.argv else 2
    for name, (draw, width, height) in PICTURES.items():
        with open(os.path.join(sys.argv[2], name + ".svg"), "w", encoding="utf-8") as file:
            file.write(f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' "
                       "font-family='sans-serif' font-size='11'>\n"
                       "<rect width='100%' height='100%' fill='white'/>\n")
            file.write("\n".join(draw(sys.argv[1])) + "\n</svg>\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
