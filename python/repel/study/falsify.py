# SPDX-License-Identifier: BSD-3-Clause
"""Searches for the values and the hand for which a study does not hold.

A sample of random runs says where the margin is small. From the worst of them an evolution strategy
(CMA-ES) goes downhill in all numbers at once, each mapped to 0..1 by its scale; words and choices
stay those of the start. When it stands still, it starts again from the next one. Of the failure
that it finds, all that it does not need is set back.
"""

from __future__ import annotations

import dataclasses
import json
import math
import shlex
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .._errors import SetupError, needed
from .report import is_choice, number, plain
from .store import whole

if TYPE_CHECKING:
    from .engine import Engine, Job
    from .plan import Study
    from .quantities import Quantity

SAMPLE = 0.12  #: of the runs, those that are random
STARTS = 3  #: from the worst of one random sample, with words and choices that differ
SIGMA = 0.15  #: of the first generation, where all numbers are in 0..1
_FAR = 1_000_000_000  #: from this index on, runs are drawn that no study makes
_DRAWN = 200  # values drawn to see how far a quantity without bounds goes
_STILL = 10  # generations without a run better by 1 %, after which to start elsewhere

Hand = list[float] | None  # numbers of the operator's hand


@dataclasses.dataclass
class Try:
    """A run of the search."""

    values: dict[str, float | str]
    hand: Hand
    row: dict[str, Any]

    @property
    def margin(self) -> float:
        """That of the row; infinite if the run was refused or did not measure it."""
        margin = float(self.row["margin"])
        return math.inf if self.row["refused"] or math.isnan(margin) else margin

    @property
    def is_failure(self) -> bool:
        """Whether it ran and does not hold."""
        return self.margin <= 0


@dataclasses.dataclass
class Found:
    """What a search found."""

    worst: Try
    minimal: Try | None  #: of a failure, with as much as possible set back
    set_back: list[str]  #: what that is
    runs: int  #: of the search, until it stopped
    failed: int  #: of these, those that did not hold, for whatever reason
    unmeasured: int  #: of those, the refused and the ones without a margin
    first_failure: int | None  #: the number of that run, from 1
    reduction_runs: int  #: for the minimal one
    restarts: int
    random_runs: int  #: for comparison
    random_failed: int
    random_least: float
    random_first: int | None
    spans: dict[str, tuple[float, float]]  #: of each number, where it was searched
    seed: int


class Space:
    """The numbers of a study as points of a cube, and back."""

    def __init__(self, study: Study, seed: int):
        self.study = study
        drawn = None
        #: where each number is searched
        self.spans: dict[str, tuple[float, float]] = {}
        self._numbers = [each for each in study.quantities if not is_choice(each)]
        for each in self._numbers:
            low, high = each.low, each.high
            if low is None or high is None:  # as far as draws go
                drawn = drawn or [study.values(_FAR + seed * _DRAWN + i) for i in range(_DRAWN)]
                of_these = [float(values[each.name]) for values in drawn]
                low = min(of_these) if low is None else low
                high = max(of_these) if high is None else high
            self.spans[each.name] = float(low), float(high)

    @property
    def size(self) -> int:
        """Of the cube."""
        return len(self._numbers) + self.study.hand_size()

    def point(self, values: dict[str, float | str], hand: Hand) -> NDArray[Any]:
        """The point of a run."""
        place = []
        for each in self._numbers:
            low, high = self._ends(each)
            here = _scaled(each, float(values[each.name]))
            place.append((here - low) / (high - low) if high > low else 0.5)
        place += [0.5 * (x + 1) for x in hand or [0.0] * self.study.hand_size()]
        return np.asarray(np.clip(place, 0.0, 1.0))

    def run(self, point: NDArray[Any], like: dict[str, float | str]) -> tuple[
            dict[str, float | str], Hand]:
        """The run of a point; words and choices are those of `like`."""
        values = dict(like)
        for each, at in zip(self._numbers, point.tolist()):
            low, high = self._ends(each)
            here = low + at * (high - low)
            least, most = self.spans[each.name]
            values[each.name] = min(max(math.exp(here) if _is_log(each) else here, least), most)
        hand = [2 * x - 1 for x in point[len(self._numbers):].tolist()]
        return values, hand or None

    def _ends(self, each: Quantity) -> tuple[float, float]:
        low, high = self.spans[each.name]
        return _scaled(each, low), _scaled(each, high)


def _is_log(each: Quantity) -> bool:
    return each.scale == "log"


def _scaled(each: Quantity, value: float) -> float:
    return math.log(value) if _is_log(each) else value


class _Over(Exception):
    """The budget is spent, or enough was found."""


class Search:
    """The runs of a search, counted and kept while it lasts."""

    def __init__(self, study: Study, engine: Engine, tick: Callable[[int, int], None]):
        """tick: takes how many runs are done, and how many of them did not hold."""
        self._study, self._engine, self._tick = study, engine, tick
        self.made = 0
        self.first_failure: int | None = None
        self.worst: Try | None = None
        self.failed = 0  # as a study counts them, with those that have no margin
        self.unmeasured = 0

    def evaluate(self, runs: Sequence[Job]) -> list[Try]:
        """Makes the runs, of values or as the study draws them, in the order given."""
        jobs = list(runs)
        place = {id(job): i for i, job in enumerate(jobs)}
        rows: list[dict[str, Any]] = [{} for _ in jobs]
        for made in self._engine.made(self._study, jobs):
            if made is not None:
                for job, row in zip(made.jobs, made.rows.to_pylist()):
                    rows[place[id(job)]] = row
            self._tick(0 if made is None else len(made.jobs), 0)
        tries = [Try(*((self._study.values(job), None) if isinstance(job, int) else job), row)
                 for job, row in zip(jobs, rows)]
        for each in tries:
            self.made += 1
            if self.worst is None or each.margin < self.worst.margin:
                self.worst = each
            self.failed += not each.row["held"]
            self.unmeasured += math.isinf(each.margin) and not each.row["held"]
            if each.is_failure:
                self.first_failure = self.first_failure or self.made
        self._tick(0, sum(not each.row["held"] for each in tries))
        return tries


def search(study: Study, engine: Engine, *, runs: int = 500, seconds: float = math.inf,
           seed: int = 1, every: bool = False, compare: bool = True, reduce: bool = True,
           tick: Callable[[int, int], None] = lambda done, failed: None) -> Found:
    """Searches for the least margin with at most so many runs and about so many seconds [s].

    seed: of what is random; equal ones find the same wherever it is made. every: go on after the
    first failure. compare: make as many random runs too. reduce: look for a minimal failure. tick:
    takes how many runs are done since it was called, and how many of them failed. Raises SetupError
    if nothing varies, KeyboardInterrupt if one comes before the first runs are done; a later one
    ends the search.
    """
    space = Space(study, seed)
    if not study.quantities and space.size == 0:
        raise SetupError(f"{study.file}: nothing varies in it, so there is nothing to search",
                         study.file)
    trying = Search(study, engine, tick)
    ends = time.monotonic() + seconds
    restarts = 0

    def evaluate(what: Sequence[tuple[dict[str, float | str], Hand]]) -> list[Try]:
        if trying.made >= runs or trying.made and time.monotonic() > ends:
            raise _Over
        tries = trying.evaluate(what[:runs - trying.made])
        if trying.first_failure and not every or len(tries) < len(what):
            raise _Over
        return tries

    first = _FAR + 1_000_000 * (seed + 1)
    try:
        for restarts, start in enumerate(_starts(study, space, evaluate, first, runs)):
            _descend(space, evaluate, start, seed + 1000 * restarts)
    except _Over:
        pass
    except KeyboardInterrupt:  # what it has found by then is told
        compare = reduce = False
    if trying.worst is None:
        raise KeyboardInterrupt
    random = Search(study, engine, tick)
    if compare:
        random.evaluate(range(first + 500_000, first + 500_000 + trying.made))
    minimal: Try | None = None
    set_back: list[str] = []
    reduction = Search(study, engine, tick)
    if reduce and trying.worst.is_failure:
        minimal, set_back = _reduced(study, reduction, trying.worst)
    return Found(
        worst=trying.worst, minimal=minimal, set_back=set_back, runs=trying.made,
        failed=trying.failed, unmeasured=trying.unmeasured, first_failure=trying.first_failure,
        reduction_runs=reduction.made, restarts=restarts, random_runs=random.made,
        random_failed=random.failed,
        random_least=random.worst.margin if random.worst else math.nan,
        random_first=random.first_failure, spans=space.spans, seed=seed)


def _starts(study: Study, space: Space, evaluate: Callable[[Any], list[Try]], first: int,
            runs: int) -> Iterator[Try]:
    """The worst of random runs, one for each combination of words and choices first; then of
    others, for as long as the budget lasts."""
    kinds = [each.name for each in study.quantities if is_choice(each)]
    size = max(4, round(SAMPLE * runs))
    while True:
        sample = evaluate([study.point(first + i) for i in range(size)])
        first += size
        best: dict[Any, Try] = {}
        for each in sorted(sample, key=lambda each: each.margin):
            best.setdefault(tuple(each.values[name] for name in kinds), each)
        if space.size > 0:  # else random runs are all there is
            yield from list(best.values())[:STARTS]


def _descend(space: Space, evaluate: Callable[[Any], list[Try]], start: Try, seed: int) -> None:
    """Goes downhill from a run until that stands still."""
    cma = needed("cma", extra="study")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of plots and of small cubes
        strategy = cma.CMAEvolutionStrategy(
            _inside(space.point(start.values, start.hand)), SIGMA,
            {"bounds": [0, 1], "seed": seed + 1, "verbose": -9})
        best, still = start.margin, 0
        while still < _STILL and not strategy.stop():
            points = strategy.ask()
            tries = evaluate([space.run(np.asarray(point), start.values) for point in points])
            known = [each.margin for each in tries if math.isfinite(each.margin)]
            bad = max(known, default=0.0) + 1  # of runs that were refused
            strategy.tell(points, [min(each.margin, bad) for each in tries])
            least = min(each.margin for each in tries)
            still = 0 if least < best - 0.01 * abs(best) else still + 1
            best = min(best, least)


def _inside(point: NDArray[Any]) -> NDArray[Any]:
    """Off the faces of the cube, where half of all steps lead nowhere."""
    return np.asarray(np.clip(point, 0.02, 0.98))


def _reduced(study: Study, trying: Search, failure: Try) -> tuple[Try, list[str]]:
    """The failure with as much as possible left as it is in the scene, of the hand at 0, and the
    names of that."""
    at_once = [each.name for each in study.quantities if each.name in failure.values]
    at_once += [f"hand[{i}]" for i, x in enumerate(failure.hand or []) if x != 0]
    set_back: list[str] = []

    def without(names: Sequence[str], of: Try) -> tuple[dict[str, float | str], Hand]:
        values = {name: value for name, value in of.values.items() if name not in names}
        hand = of.hand and [0.0 if f"hand[{i}]" in names else x for i, x in enumerate(of.hand)]
        return values, hand

    def shrink(names: list[str], of: Try) -> Try:
        """All at once, or else each half."""
        if not names:
            return of
        tried = trying.evaluate([without(names, of)])[0]
        if tried.is_failure:
            set_back.extend(names)
            return tried
        if len(names) == 1:
            return of
        half = len(names) // 2
        return shrink(names[half:], shrink(names[:half], of))

    left, reduced = at_once, failure
    while left:  # what is set back may make that possible for what was tried before
        reduced = shrink(left, reduced)
        before, left = left, [name for name in left if name not in set_back]
        if left == before:
            break
    return reduced, set_back


# What is said of it.

def write(folder: Path, study: Study, found: Found) -> dict[str, Any]:
    """Writes falsify.json and worst/replay.sh, for a failure also minimal/replay.sh, and returns
    the object of the former. Raises NotWritten."""
    summary: dict[str, Any] = {
        "study": study.name, "file": study.file, "seed": found.seed, "runs": found.runs,
        "failed": found.worst.is_failure, "first_failure": found.first_failure,
        "not_held": found.failed, "not_measured": found.unmeasured, "restarts": found.restarts,
        "worst": _told(study, found.worst, folder / "worst"),
        "minimal": found.minimal and {
            **_told(study, found.minimal, folder / "minimal"), "set_back": found.set_back,
            "runs": found.reduction_runs},
        "random": {"runs": found.random_runs, "failed": found.random_failed,
                   "first_failure": found.random_first, "least_margin": plain(found.random_least)}
        if found.random_runs else None,
        "searched": {name: list(span) for name, span in found.spans.items()},
        "hand": study.hand_size(), "versions": dict(study.versions), "identity": study.identity,
    }
    with whole(folder / "falsify.json") as file:
        file.write((json.dumps(summary, indent=2) + "\n").encode())
    return summary


def _told(study: Study, run: Try, folder: Path) -> dict[str, Any]:
    """The run for JSON; writes what makes it again into the folder."""
    line = shlex.join(study.command(run.values, folder, run.hand))
    with whole(folder / "replay.sh") as file:
        file.write(f"#!/bin/sh\n{line}\n".encode())
    return {"margin": plain(run.margin), "refused": run.row["refused"], "values": run.values,
            "hand": run.hand, "measured": {name: plain(run.row.get(name))
                                           for name in study.measures}, "replay": line}


def as_text(summary: dict[str, Any]) -> str:
    """The summary for a terminal."""
    worst, minimal, random = summary["worst"], summary["minimal"], summary["random"]
    if summary["failed"]:
        lines = [f"failure found, run {summary['first_failure']} of the search: margin "
                 f"{number(worst['margin'])}"]
    else:
        lines = [f"no failure found in {summary['runs']} runs; least margin "
                 f"{number(worst['margin'])}. This is no proof that there is none."]
    if summary["not_measured"]:
        lines.append(f"{summary['not_measured']} of {summary['runs']} runs were refused or without "
                     "a measure; they did not hold either, but have no margin to search by")
    lines += _numbers(worst)
    if minimal:
        lines.append(f"set back to the scene as far as it still fails ({len(minimal['set_back'])} "
                     f"numbers, {minimal['runs']} more runs): margin {number(minimal['margin'])}")
        lines += _numbers(minimal)
    if random:
        lines.append(f"as many random runs: {random['failed']} of {random['runs']} did not hold, "
                     f"least margin {number(random['least_margin'])}")
    return "\n".join(lines)


def _numbers(run: dict[str, Any]) -> list[str]:
    lines = [f"  refused: {run['refused']}"] if run["refused"] else []
    lines += [f"  {name} {number(value)}" for name, value in run["values"].items()]
    if run["hand"]:
        lines.append("  hand " + " ".join(number(x) for x in run["hand"]))
    lines += [f"  measured {name} {number(value)}" for name, value in run["measured"].items()]
    return [*lines, f"  {run['replay']}"]
