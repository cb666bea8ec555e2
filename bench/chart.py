# SPDX-License-Identifier: BSD-3-Clause
"""What the plots of measured results have in common: SVG, logarithmic times, a legend."""

import json
import math
import sys


def text(x, y, words, style=""):
    return f"<text x='{x:.1f}' y='{y:.1f}' {style}>{words}</text>"


def runs(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)["benchmarks"]


class Panel:
    """Times from left to right, logarithmic, the same for all panels of a plot; what goes from top
    to bottom is its user's."""

    def __init__(self, left, right, top, bottom, times):
        self.left, self.right, self.top, self.bottom = left, right, top, bottom
        self.low, self.high = math.log10(min(times) / 1.2), math.log10(max(times) * 1.2)

    def x(self, time):
        share = (math.log10(time) - self.low) / (self.high - self.low)
        return self.left + share * (self.right - self.left)

    def title(self, words):
        yield text(self.left, 25, words, "font-weight='bold'")

    def level(self, y, label):
        yield f"<path d='M{self.left} {y:.1f}H{self.right}' stroke='#ddd'/>"
        yield text(self.left - 5, y + 4, label, "text-anchor='end'")

    def times(self):
        for time in (100, 200, 500, 1000, 2000, 5000, 10000, 20000):
            if self.low < math.log10(time) < self.high:
                x = self.x(time)
                yield f"<path d='M{x:.1f} {self.top}V{self.bottom}' stroke='#ddd'/>"
                yield text(x, self.bottom + 15, time, "text-anchor='middle'")


def picture(width, height, names, colours, body):
    """`body` with a legend of `names` at its right edge."""
    yield (f"<svg xmlns='http://www.w3.org/2000/svg' width='{width}' height='{height}' "
           "font-family='sans-serif' font-size='11'>")
    yield "<rect width='100%' height='100%' fill='white'/>"
    yield from body
    for i, name in enumerate(names):
        style = f"fill='{colours.get(name, '#000')}' font-weight='bold'"
        yield text(width - 100, 50 + 18 * i, name, style)
    yield "</svg>"


def main(doc, draw):
    """The whole program: `draw` makes the lines of the plot from the runs of the results."""
    if len(sys.argv) != 3 or "--help" in sys.argv:
        print(doc)
        sys.exit(0 if "--help" in sys.argv else 2)
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write("\n".join(draw(runs(sys.argv[1]))) + "\n")
