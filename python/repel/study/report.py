# SPDX-License-Identifier: BSD-3-Clause
"""What the table of a study says: summary.json for programs, report.html for people.

The table is read once, a row group at a time; what is drawn is a sample of it.
"""

from __future__ import annotations

import dataclasses
import html
import json
import math
import shlex
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .._errors import needed
from .store import GROUP, whole

if TYPE_CHECKING:
    from .plan import Study
    from .quantities import Quantity

CONFIDENCE = 0.95
WORST = 10
DRAWN = 4000  #: runs in a chart, evenly over the table; to them come
DRAWN_WORST = 400  #: the worst of all
CHARTS = 12  #: quantities with a chart, those that matter most
_BINS = 10


def upper_bound(failed: int, runs: int) -> float:
    """The share of failures that `failed` of `runs` exclude to be larger, with 95 % confidence, by
    Clopper and Pearson, one-sided."""
    if failed >= runs:
        return 1.0
    beta = needed("scipy.stats", "scipy", extra="study").beta
    return float(beta.ppf(CONFIDENCE, failed + 1, runs - failed))


@dataclasses.dataclass
class Seen:
    """What one pass over the table keeps."""

    runs: int = 0
    failed: int = 0
    refused: int = 0
    bound_failed: list[int] = dataclasses.field(default_factory=list)
    bound_unmeasured: list[int] = dataclasses.field(default_factory=list)
    bound_least: list[float] = dataclasses.field(default_factory=list)
    #: (runs, failed among them, least margin among them), at even steps of their logarithm
    course: list[tuple[int, int, float]] = dataclasses.field(default_factory=list)
    sample: Any = None  #: pyarrow's Table, every so many-th row
    worst: Any = None  #: pyarrow's Table, the worst first


def read(study: Study, results: Path) -> Seen:
    """One pass over the table; holds a row group of it, and samples."""
    pa = needed("pyarrow", extra="study")
    file = needed("pyarrow.parquet", "pyarrow", extra="study").ParquetFile(results)
    total = file.metadata.num_rows
    stride = max(1, -(-total // DRAWN))
    stops = np.unique(np.geomspace(1, max(total, 1), 200).astype(int))
    bounds = study.bounds
    names = [name for name, _ in study.columns if name in {*study.measures, "refused"}]
    seen = Seen(bound_failed=[0] * len(bounds), bound_unmeasured=[0] * len(bounds),
                bound_least=[math.inf] * len(bounds))
    least = math.inf
    samples = []
    for batch in file.iter_batches(batch_size=GROUP):
        table = pa.Table.from_batches([batch])
        margin = np.asarray(table["margin"].to_numpy(), float)
        failed = seen.failed + np.cumsum(~table["held"].to_numpy())
        lowest = np.fmin(least, np.fmin.accumulate(margin))
        for stop in stops[(stops > seen.runs) & (stops <= seen.runs + len(table))]:
            at = stop - seen.runs - 1
            seen.course.append((int(stop), int(failed[at]), float(lowest[at])))
        rows = table.select(names).to_pylist()
        for i, bound in enumerate(bounds):
            margins = np.array([bound.margin(row) for row in rows], float)
            seen.bound_failed[i] += int((margins <= 0).sum())
            seen.bound_unmeasured[i] += int(np.isnan(margins).sum())
            seen.bound_least[i] = float(np.fmin(seen.bound_least[i], np.fmin.reduce(margins)))
        seen.refused += sum(row["refused"] != "" for row in rows)
        samples.append(table.filter((np.arange(len(table)) + seen.runs) % stride == 0))
        worst = table if seen.worst is None else pa.concat_tables([seen.worst, table])
        seen.worst = worst.sort_by([("held", "ascending"), ("margin", "ascending"),
                                    ("index", "ascending")]).slice(0, DRAWN_WORST)
        seen.runs += len(table)
        seen.failed, least = int(failed[-1]), float(lowest[-1])
    seen.sample = pa.concat_tables(samples)
    return seen


def write(folder: Path, study: Study, results: Path) -> dict[str, Any]:
    """Writes summary.json and report.html beside the table and returns the summary. Raises
    NotWritten."""
    seen = read(study, results)
    summary = summary_of(study, seen)
    with whole(folder / "summary.json") as file:
        file.write((json.dumps(summary, indent=2) + "\n").encode())
    with whole(folder / "report.html") as file:
        file.write(page(study, seen, summary).encode())
    return summary


def plain(value: Any) -> Any:
    """A value for JSON, which has no number for what was not measured."""
    return None if isinstance(value, float) and not math.isfinite(value) else value


def summary_of(study: Study, seen: Seen) -> dict[str, Any]:
    """The object of summary.json."""
    worst = [_told(study, row) for row in seen.worst.slice(0, WORST).to_pylist()]
    return {
        "study": study.name, "file": study.file, "runs": seen.runs, "failed": seen.failed,
        "refused": seen.refused, "confidence": CONFIDENCE,
        "upper_bound": upper_bound(seen.failed, seen.runs) if study.is_random else None,
        "bounds": [{"measure": bound.measure, "unit": bound.unit, "relation": bound.relation,
                    "limit": bound.limit, "failed": failed, "not_measured": unmeasured,
                    "least_margin": plain(least)}
                   for bound, failed, unmeasured, least in zip(
                       study.bounds, seen.bound_failed, seen.bound_unmeasured, seen.bound_least)],
        "worst": worst[0], "worst_ten": worst, "versions": dict(study.versions),
        "identity": study.identity, "seed": study.seed,
    }


def _told(study: Study, row: dict[str, Any]) -> dict[str, Any]:
    line = ["repel", "study", "replay", study.file, str(row["index"]), *study.options]
    return {"index": row["index"], "margin": plain(row["margin"]), "held": row["held"],
            "refused": row["refused"],
            "values": {each.name: plain(row.get(each.name)) for each in study.quantities},
            "measured": {name: plain(row.get(name)) for name in study.measures},
            "replay": shlex.join(line)}


def sentence(failed: int, refused: int, runs: int, bound: float | None) -> str:
    """What so many failures prove; bound: None where the runs are no random sample."""
    of_these = f" ({refused} refused at set-up)" if refused else ""
    proves = ("They are no random sample, so no share of others follows." if bound is None else
              f"With 95 % confidence at most {percent(bound)} of such runs fail, for hands and "
              "values drawn like these.")
    return f"{runs - failed} of {runs} runs held, {failed} did not{of_these}. {proves}"


def percent(share: float) -> str:
    """Of a share, rounded up, so that it stays a bound."""
    if share <= 0:
        return "0 %"
    step = 10.0 ** (math.floor(math.log10(100 * share)) - 1)
    return f"{min(100.0, math.ceil(100 * share / step - 1e-9) * step):.3g} %"


def number(value: Any) -> str:
    """Of a value that may be a word, or missing."""
    if value is None or isinstance(value, float) and math.isnan(value):
        return "-"
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def demand(bound: Any) -> str:
    """What a bound, or its object in the summary, demands."""
    has = bound if isinstance(bound, dict) else vars(bound)
    return f"{has['measure']} {has['relation']} {number(has['limit'])} {has['unit']}".rstrip()


def as_text(summary: dict[str, Any]) -> str:
    """The summary for a terminal."""
    lines = [sentence(summary["failed"], summary["refused"], summary["runs"],
                      summary["upper_bound"])]
    for bound in summary["bounds"]:
        unmeasured = f"{bound['not_measured']} not measured, " if bound["not_measured"] else ""
        lines.append(f"  {demand(bound)}: {bound['failed']} did not hold, {unmeasured}least margin "
                     f"{number(bound['least_margin'])}")
    worst = summary["worst"]
    lines.append(f"worst: run {worst['index']}, {_outcome(worst)}")
    lines.append(f"  {worst['replay']}")
    return "\n".join(lines)


def _outcome(run: dict[str, Any]) -> str:
    return run["refused"] or f"margin {number(run['margin'])}"


# What matters.

def shares(study: Study, sample: Any) -> dict[str, float]:
    """Of the variance of the rank of the margin, the share that each quantity explains alone, by
    groups of even size; the largest first."""
    margin = np.asarray(sample["margin"].to_numpy(), float)
    is_there = ~np.isnan(margin)
    rank = needed("scipy.stats", "scipy", extra="study").rankdata(margin[is_there])
    found = {}
    for each in study.quantities:
        if each.name not in sample.column_names:
            continue
        values = np.array(sample[each.name].to_pylist())[is_there]
        kinds, group = np.unique(values, return_inverse=True)
        if not is_choice(each) and len(kinds) > _BINS:
            group = np.argsort(np.argsort(values, kind="stable"), kind="stable") * _BINS // len(
                values)
        found[each.name] = _explained(rank, group)
    return dict(sorted(found.items(), key=lambda item: -item[1]))


def _explained(rank: NDArray[Any], group: NDArray[Any]) -> float:
    """The share of the variance between groups, less what chance gives."""
    total = float(((rank - rank.mean()) ** 2).sum()) if len(rank) else 0.0
    count = np.bincount(group) if len(group) else np.zeros(0)
    groups = int((count > 0).sum())
    if total == 0 or groups < 2 or len(rank) <= groups:
        return 0.0
    means = np.bincount(group, rank) / np.maximum(count, 1)
    between = float((count * (means - rank.mean()) ** 2).sum())
    return max(0.0, 1 - (1 - between / total) * (len(rank) - 1) / (len(rank) - groups))


def is_choice(quantity: Quantity) -> bool:
    """Whether it has kinds and not an order."""
    return quantity.is_word or bool(quantity.choices)


# Charts.

_WIDTH, _HEIGHT = 520, 260
_LEFT, _RIGHT, _TOP, _BOTTOM = 62, 12, 10, 36
_LETTER, _ASLANT = 6.5, 50  # wide in a label, at most; below for labels that stand aslant


@dataclasses.dataclass
class Axis:
    """Where values stand between 0 and 1, and what is written there."""

    name: str
    at: Callable[[Any], NDArray[Any]]
    ticks: list[tuple[float, str]]


def axis_of(name: str, values: NDArray[Any], is_log: bool = False) -> Axis:
    """The axis of numbers."""
    finite = values[np.isfinite(values)].astype(float) if len(values) else np.zeros(0)
    is_log = is_log and len(finite) > 0 and bool(finite.min() > 0)
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 1.0)
    if low == high:
        low, high = (low / 2, high * 2) if is_log else (low - abs(low or 1), high + abs(high or 1))
    forward: Callable[[Any], Any] = np.log10 if is_log else (lambda x: x)
    first, span = forward(low), forward(high) - forward(low)

    def at(x: Any) -> NDArray[Any]:
        place: NDArray[Any] = (forward(x) - first) / span
        return place

    marks = _powers(low, high) if is_log else _steps(low, high)
    return Axis(name, at, [(float(at(np.float64(mark))), f"{mark:.4g}") for mark in marks])


def _steps(low: float, high: float) -> list[float]:
    raw = (high - low) / 5
    power = 10.0 ** math.floor(math.log10(raw))
    step = next((power * each for each in (1, 2, 5) if power * each >= raw), 10 * power)
    return [step * i for i in range(math.ceil(low / step), math.floor(high / step) + 1)]


def _powers(low: float, high: float) -> list[float]:
    decades = math.log10(high / low)
    if decades < 0.7:
        return _steps(low, high)
    every = max(1, math.ceil(decades / 6))
    marks = [step * 10.0 ** power
             for power in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1, every)
             for step in ((1, 2, 5) if decades < 2 else (1,))]
    return [mark for mark in marks if low <= mark <= high]


def words_of(name: str, choices: Sequence[Any], values: Sequence[Any]) -> Axis:
    """The axis of words; values stand side by side about their word."""
    known = list(dict.fromkeys([*choices, *values]))
    place = {word: (i + 0.5) / len(known) for i, word in enumerate(known)}

    def at(words: NDArray[Any]) -> NDArray[Any]:
        beside = np.modf(np.arange(len(words)) * 0.6180339887)[0] - 0.5
        middle = np.array([place[word] for word in words.tolist()])
        return np.asarray(middle + 0.6 * beside / len(known))

    every = -(-len(known) // 12)  # of more there is no room for the names
    return Axis(name, at, [(place[word], str(word)[:14]) for word in known[::every]])


def _frame(x: Axis, y: Axis, inside: str, label: str) -> str:
    wide, high = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BOTTOM
    # Words that do not fit beside each other stand aslant.
    is_tight = _LETTER * max((len(text) for _, text in x.ticks), default=0) * len(x.ticks) > wide
    tall = _HEIGHT + (_ASLANT if is_tight else 0)
    parts = [f"<svg viewBox='0 0 {_WIDTH} {tall}' role='img' aria-label='{_text(label)}'>"]
    for at, text in x.ticks:
        px, below = _LEFT + at * wide, _TOP + high + 14
        how = (f"text-anchor='end' transform='rotate(-40 {px:.1f} {below})'" if is_tight else
               "text-anchor='middle'")
        parts.append(f"<path class='grid' d='M{px:.1f} {_TOP}v{high}'/><text x='{px:.1f}' "
                     f"y='{below}' {how}>{_text(text)}</text>")
    for at, text in y.ticks:
        py = _TOP + (1 - at) * high
        parts.append(f"<path class='grid' d='M{_LEFT} {py:.1f}h{wide}'/><text x='{_LEFT - 5}' "
                     f"y='{py + 4:.1f}' text-anchor='end'>{_text(text[:9])}</text>")
    parts.append(f"<text x='{_LEFT + wide / 2}' y='{tall - 5}' text-anchor='middle'>"
                 f"{_text(x.name)}</text><text x='11' y='{_TOP + high / 2}' text-anchor='middle' "
                 f"transform='rotate(-90 11 {_TOP + high / 2})'>{_text(y.name)}</text>")
    return "".join([*parts, inside, "</svg>\n"])


def _pixels(x: Axis, y: Axis, xs: Any, ys: Any) -> list[tuple[float, float]]:
    wide, high = _WIDTH - _LEFT - _RIGHT, _HEIGHT - _TOP - _BOTTOM
    return [(_LEFT + px * wide, _TOP + (1 - py) * high) for px, py in zip(x.at(xs), y.at(ys))
            if math.isfinite(px) and math.isfinite(py)]


def _dots(kind: str, places: list[tuple[float, float]]) -> str:
    if not places:
        return ""
    return (f"<path class='dots {kind}' d='"
            + "".join(f"M{px:.0f} {py:.0f}h0" for px, py in places) + "'/>")


def _line(kind: str, places: list[tuple[float, float]]) -> str:
    if not places:
        return ""
    way = "L".join(f"{px:.1f} {py:.1f}" for px, py in places)
    return f"<path class='{kind}' d='M{way}'/>"


def _zero(x: Axis, y: Axis) -> str:
    place = float(y.at(np.float64(0)))
    if not 0 <= place <= 1:
        return ""
    py = _TOP + (1 - place) * (_HEIGHT - _TOP - _BOTTOM)
    return f"<path class='zero' d='M{_LEFT} {py:.1f}h{_WIDTH - _LEFT - _RIGHT}'/>"


class Cloud:
    """The runs that are drawn: values by name, and how each ended."""

    def __init__(self, seen: Seen):
        pa = needed("pyarrow", extra="study")
        table = pa.concat_tables([seen.sample, seen.worst])
        margin = np.asarray(table["margin"].to_numpy(), float)
        _, first = np.unique(table["index"].to_numpy(), return_index=True)
        keep = first[np.isfinite(margin[first])]
        self._table = table.take(keep)
        self.margin = margin[keep]
        held = self._table["held"].to_numpy()
        close = np.quantile(self.margin[held], 0.2) if held.any() else 0.0
        #: (class of the style, which runs), those on top last
        self.kinds = [("held", held & (self.margin > close)),
                      ("close", held & (self.margin <= close)), ("failed", ~held)]

    def values(self, quantity: Quantity) -> NDArray[Any]:
        return np.array(self._table[quantity.name].to_pylist(),
                        object if is_choice(quantity) else float)

    def axis(self, quantity: Quantity) -> Axis:
        values = self.values(quantity)
        name = f"{quantity.name} [{quantity.unit}]" if quantity.unit else quantity.name
        if is_choice(quantity):
            return words_of(name, quantity.choices, values.tolist())
        return axis_of(name, values, quantity.scale == "log")

    def chart(self, x: Axis, y: Axis, xs: NDArray[Any], ys: NDArray[Any], label: str,
              below: str = "") -> str:
        return _frame(x, y, below + "".join(
            _dots(kind, _pixels(x, y, xs[which], ys[which])) for kind, which in self.kinds), label)


# The page.

_STYLE = """
:root { color-scheme: light dark; --ink: #1a1c1e; --soft: #62676d; --rule: #d9dce0; --page: #fff;
  --tile: #f4f5f7; --held: #0b62c4; --close: #a86d00; --failed: #d1300c; --good: #22863a; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e8ea; --soft: #9aa0a6; --rule: #3a3e44;
  --page: #17191c; --tile: #202327; --held: #6fb0ff; --close: #e6b450; --failed: #ff7a5c;
  --good: #6fd08c; } }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink); background: var(--page);
  max-width: 62em; margin: 2em auto; padding: 0 1em; }
h1 { font-size: 1.6em; margin: 0; } h2 { font-size: 1.15em; margin: 2em 0 .5em; }
p { margin: .4em 0; overflow-wrap: anywhere; } .soft, figcaption { color: var(--soft); }
.says { font-size: 1.15em; }
.tiles { display: grid; grid-template-columns: repeat(auto-fill, minmax(10em, 1fr)); gap: .6em;
  margin: 1em 0; } .tiles div { background: var(--tile); border-radius: 6px; padding: .6em .8em; }
.tiles dt { color: var(--soft); font-size: .85em; } .tiles dd { margin: 0; font-size: 1.15em; }
.charts { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 24em), 1fr));
  gap: 1em; } figure { margin: 0; break-inside: avoid; } figcaption { font-weight: 600; }
svg { width: 100%; height: auto; display: block; } svg path { fill: none; stroke-width: 1.4; }
svg text { font: 11px system-ui, sans-serif; fill: var(--soft); }
svg .grid { stroke: var(--rule); stroke-width: 1; }
svg .zero { stroke: var(--failed); stroke-dasharray: 6 3; }
svg .dots { stroke-width: 3; stroke-linecap: round; } svg .dots.held { opacity: .45; }
svg .failed.dots { stroke-width: 5; } .held { stroke: var(--held); }
.close { stroke: var(--close); } .failed { stroke: var(--failed); }
.no { color: var(--failed); font-weight: 600; }
.yes { color: var(--good); font-weight: 600; } b.held { color: var(--held); }
b.close { color: var(--close); } b.failed { color: var(--failed); }
.wide { overflow-x: auto; } table { border-collapse: collapse; font-size: .9em; }
th, td { text-align: right; padding: .25em .6em; border-bottom: 1px solid var(--rule); }
th { color: var(--soft); font-weight: 600; } .name { text-align: left; }
pre { background: var(--tile); padding: 1em; overflow: auto; font-size: .85em; }
@media print { body { margin: 0; max-width: none; font-size: 11px; } .wide, pre { overflow: visible;
  white-space: pre-wrap; } }
"""

_LIMITS = """It says nothing of values outside of what was drawn, nothing of hands that move
otherwise, nothing of what the simulation leaves out, and what fails rarely may not be among these
runs: <code>repel falsify</code> searches for it."""


def _text(text: Any) -> str:
    return html.escape(str(text), quote=True)


def _table(head: Sequence[str], rows: Sequence[Sequence[str]], names: int = 1) -> str:
    """Cells are HTML."""
    def cells(tag: str, row: Sequence[str]) -> str:
        return "".join(f"<{tag}{' class=name' if i < names else ''}>{cell}</{tag}>"
                       for i, cell in enumerate(row))
    body = "".join(f"<tr>{cells('td', row)}</tr>\n" for row in rows)
    return f"<div class='wide'><table><tr>{cells('th', head)}</tr>\n{body}</table></div>\n"


def _figure(title: str, chart: str) -> str:
    return f"<figure><figcaption>{_text(title)}</figcaption>{chart}</figure>\n"


def page(study: Study, seen: Seen, summary: dict[str, Any]) -> str:
    """report.html, which needs nothing else."""
    title = _text(study.name)
    return "".join([
        "<!doctype html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'/>\n"
        "<meta name='viewport' content='width=device-width, initial-scale=1'/>\n"
        f"<title>{title} - repel study</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n"
        f"<h1>{title}</h1>\n",
        _what_held(summary), _worst(study, summary), _what_matters(study, seen),
        _convergence(study, seen), _where_from(study), "</body>\n</html>\n"])


def _what_held(summary: dict[str, Any]) -> str:
    failed, runs, bound = summary["failed"], summary["runs"], summary["upper_bound"]
    tiles = {"runs": str(runs), "did not hold": str(failed),
             "refused at set-up": str(summary["refused"]),
             **({} if bound is None else {"at most fail, 95 %": percent(bound)}),
             "least margin": number(summary["worst"]["margin"])}
    rows = [[_text(demand(each)), _answer(each), str(each["failed"]), str(each["not_measured"]),
             number(each["least_margin"])] for each in summary["bounds"]]
    says = sentence(failed, summary["refused"], runs, bound)
    return (f"<p class='says'>{_text(says)}</p>\n<p class='soft'>{_LIMITS}</p>\n<dl class='tiles'>"
            + "".join(f"<div><dt>{name}</dt><dd>{_text(value)}</dd></div>"
                      for name, value in tiles.items()) + "</dl>\n<h2>What held</h2>\n"
            + _table(["bound", "held", "runs that did not", "not measured", "least margin"], rows))


def _answer(bound: dict[str, Any]) -> str:
    """Whether a bound held in all runs; what was not measured did not, for what is known."""
    if bound["failed"]:
        return "<span class='no'>NO</span>"
    if bound["not_measured"]:
        return "<span class='no'>not known</span>"
    return "<span class='yes'>yes</span>"


def _worst(study: Study, summary: dict[str, Any]) -> str:
    runs = summary["worst_ten"]
    units = {each.name: each.unit for each in study.quantities}
    units |= {bound.measure: bound.unit for bound in study.bounds}
    rows = [["margin", *(number(run["margin"]) for run in runs)],
            ["held", *("yes" if run["held"] else "<span class='no'>NO</span>" for run in runs)]]
    for kind in ("values", "measured"):
        rows += [[_text(f"{name} [{units[name]}]" if units.get(name) else name),
                  *(_text(number(run[kind][name])) for run in runs)] for name in runs[0][kind]]
    if any(run["refused"] for run in runs):
        rows.append(["refused", *(_text(run["refused"]) for run in runs)])
    lines = "\n".join(run["replay"] for run in runs)
    return (f"<h2>The worst {len(runs)}</h2>\n"
            + _table(["run", *(str(run["index"]) for run in runs)], rows)
            + f"<p>To see one of them again, in the live view with --view:</p>\n"
              f"<pre>{_text(lines)}</pre>\n")


def _what_matters(study: Study, seen: Seen) -> str:
    cloud = Cloud(seen)
    shared = shares(study, seen.sample)
    by_name = {each.name: each for each in study.quantities}
    drawn = [by_name[name] for name in list(shared)[:CHARTS]]
    if not drawn or len(cloud.margin) == 0:
        return "<h2>What matters</h2>\n<p>Nothing was varied, or nothing was measured.</p>\n"
    stride = -(-seen.runs // DRAWN)
    shown = (f"{len(cloud.margin)} of {seen.runs} runs are drawn: every {stride}th that has a "
             f"margin, and the worst {len(seen.worst)}, so that failures look more frequent than "
             "they are" if stride > 1 else "All runs that have a margin are drawn")
    legend = (f"<p class='soft'>{shown}. <b class='failed'>Did not hold</b>, <b class='close'>"
              "held, the closest fifth of those drawn</b>, <b class='held'>held</b>.</p>\n")
    text = "<h2>What matters</h2>\n" + legend
    if len(drawn) > 1 and shared[drawn[1].name] >= 0.005:  # 1 %, as it is written
        x, y = drawn[:2]
        text += _figure(f"The two that matter most: {x.name} and {y.name}", cloud.chart(
            cloud.axis(x), cloud.axis(y), cloud.values(x), cloud.values(y),
            f"{x.name} against {y.name}"))
    margin = axis_of("margin", cloud.margin)
    charts = []
    for each in drawn:
        axis = cloud.axis(each)
        charts.append(_figure(f"{each.name}: explains {100 * shared[each.name]:.0f} %", cloud.chart(
            axis, margin, cloud.values(each), cloud.margin, f"margin against {each.name}",
            _zero(axis, margin))))
    rest = list(shared)[CHARTS:]
    return (text + "<p class='soft'>Below: the margin against each quantity, and the share of the "
            "variance of its rank that the quantity explains alone.</p>\n<div class='charts'>"
            + "".join(charts) + "</div>\n"
            + (f"<p class='soft'>Not drawn, as they explain less: {_text(', '.join(rest))}.</p>\n"
               if rest else ""))


def _convergence(study: Study, seen: Seen) -> str:
    runs = np.array([each[0] for each in seen.course], float)
    failed = np.array([each[1] for each in seen.course])
    least = np.array([each[2] for each in seen.course])
    bound = np.array([upper_bound(int(f), int(n)) if study.is_random else math.nan
                      for f, n in zip(failed, runs)])
    share = failed / runs
    x = axis_of("runs", runs, True)
    y = axis_of("share", np.concatenate([bound, share[share > 0]]), True)
    some = share > 0
    both = (_line("close", _pixels(x, y, runs, bound))
            + _line("failed", _pixels(x, y, runs[some], share[some])))
    low = axis_of("least margin", least)
    largest = ", and the largest that 95 % confidence leaves" if study.is_random else ""
    return ("<h2>Convergence</h2>\n<div class='charts'>"
            + _figure(f"Failures: their share (red){largest}",
                      _frame(x, y, both, "share of failures over runs"))
            + _figure("Least margin so far", _frame(
                x, low, _zero(x, low) + _line("held", _pixels(x, low, runs, least)),
                "least margin over runs")) + "</div>\n")


def _where_from(study: Study) -> str:
    versions = ", ".join(f"{name} {version}" for name, version in study.versions.items())
    return (f"<h2>Where it is from</h2>\n<p>{_text(study.file)}, seed {study.seed}; "
            f"{_text(versions)}<br/><span class='soft'>identity {_text(study.identity)}</span>"
            "</p>\n"
            f"<details><summary>The study file</summary><pre>{_text(study.text)}</pre></details>\n")
