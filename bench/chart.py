# SPDX-License-Identifier: BSD-3-Clause
"""What all charts have in common: their style, and SVG files that are the same for the same data.

Needs matplotlib: apt-get install python3-matplotlib"""

import io
import math
import pathlib
import sys

try:
    import matplotlib
except ImportError:
    sys.exit(f"{pathlib.Path(sys.argv[0]).name}: charts need matplotlib: "
             "apt-get install python3-matplotlib")

matplotlib.use("svg")
MATPLOTLIB = f"Matplotlib v{matplotlib.__version__}"  # as it names itself in what it writes
from matplotlib import pyplot, ticker  # noqa: E402  after the choice of what draws

# Okabe and Ito: told apart with any colour vision.
RED, BLUE, ORANGE, GREEN, PINK, SKY = ("#d55e00", "#0072b2", "#e69f00", "#009e73", "#cc79a7",
                                       "#56b4e9")
GREY, BLACK = "#777777", "#000000"

pyplot.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "repel", "font.sans-serif": "DejaVu Sans",
    "font.size": 8, "axes.titlesize": 8, "axes.titleweight": "bold", "axes.titlelocation": "left",
    "axes.grid": True, "grid.color": "#e0e0e0", "grid.linewidth": 0.6, "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#999999",
    "xtick.color": "#999999", "ytick.color": "#999999", "xtick.labelcolor": BLACK,
    "ytick.labelcolor": BLACK, "lines.linewidth": 1.1, "lines.markersize": 4,
    "legend.frameon": False, "legend.handlelength": 1.4})


def panels(columns, rows=1, width=9.0, height=3.2, **how):
    """A figure [inch] and its panels, a matrix."""
    return pyplot.subplots(rows, columns, figsize=(width, height), squeeze=False,
                           layout="constrained", **how)


def named(names, styles):
    """{name: how to plot it}: a colour and a marker; what has no style is black."""
    return {name: dict(zip(("color", "marker"), styles.get(name, (BLACK, "x")))) for name in names}


def magnitude(value, _=None):
    """A number, in full where that is short, or else as a power of ten."""
    if 0.01 <= value < 1000:
        return f"{value:g}"
    if 1000 <= value < 1e6:
        return f"{value:,.0f}".replace(",", "\N{THIN SPACE}")
    power = str(round(math.log10(value)))
    return "10" + power.translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def logarithmic(panel, way, steps=(1,), every=1):
    """Makes `way`, x or y, logarithmic, with a number at `steps` times every `every`-th power."""
    getattr(panel, f"set_{way}scale")("log")
    axis = getattr(panel, f"{way}axis")
    axis.set_major_locator(ticker.FixedLocator(
        [step * 10.0**power for power in range(-18, 13, every) for step in steps]))
    axis.set_major_formatter(magnitude)
    axis.set_minor_locator(ticker.NullLocator())


def legend(panel):
    """What the lines of all panels are, at the right of the last one."""
    panel.legend(loc="upper left", bbox_to_anchor=(1.02, 1), borderaxespad=0)


def name_ends(panel, lines, gap=9.5):
    """The name of each line at its right end; names that would overlap move apart [points]."""
    panel.figure.draw_without_rendering()
    ends = []
    for line in lines:
        x, y = line.get_xydata()[-1]
        ends.append((panel.transData.transform((x, y))[1] * 72 / panel.figure.dpi, (x, y), line))
    ends.sort(key=lambda end: end[0])
    heights = [end[0] for end in ends]
    for _ in range(100):
        for i in range(1, len(heights)):
            lack = gap - (heights[i] - heights[i - 1])
            if lack > 0:
                heights[i - 1] -= lack / 2
                heights[i] += lack / 2
    for height, (own, point, line) in zip(heights, ends):
        panel.annotate(line.get_label(), point, (6, height - own), textcoords="offset points",
                       color=line.get_color(), va="center", annotation_clip=False)


def save(figure, path, title, words):
    """Writes the figure as SVG with a title and a description for those who do not see it."""
    file = io.StringIO()
    figure.savefig(file, format="svg", metadata={"Date": None, "Title": title})
    pyplot.close(figure)
    described = file.getvalue().replace("</title>", f"</title>\n <desc>{words}</desc>", 1)
    pathlib.Path(path).write_text(described, encoding="utf-8")
