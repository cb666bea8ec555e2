# SPDX-License-Identifier: BSD-3-Clause
"""What varies in a study, and how it is drawn."""

from __future__ import annotations

import functools
import hashlib
import math
import statistics
from dataclasses import dataclass
from typing import Any

import numpy as np

from .._errors import needed
from .entry import Entry, number_and_unit

KINDS = ("uniform", "log_uniform", "normal", "choice", "grid")
SAMPLINGS = ("random", "latin_hypercube", "sobol")


def draws(seed: int, name: str, index: int, count: int) -> np.ndarray:
    """(count,) in [0, 1), by the name and index alone: the same on every machine."""
    digest = hashlib.shake_128(f"{seed}/{name}/{index}".encode()).digest(8 * count)
    return (np.frombuffer(digest, "<u8") >> np.uint64(11)) * 2.0**-53


@functools.lru_cache(maxsize=4)
def _table(sampling: str, seed: int, runs: int, dimensions: int) -> np.ndarray:
    qmc: Any = needed("scipy.stats", "scipy", extra="study").qmc
    if sampling == "latin_hypercube":
        table = qmc.LatinHypercube(dimensions, seed=seed).random(runs)
    else:
        # It is balanced at powers of two, of which it takes the first numbers.
        table = qmc.Sobol(dimensions, seed=seed).random_base2(max(0, runs - 1).bit_length())[:runs]
    return np.asarray(table)


def shares(sampling: str, seed: int, runs: int, names: list[str], index: int) -> list[float]:
    """For each name a number in [0, 1). Beyond the runs, all is random."""
    if sampling == "random" or not names or index >= runs:
        return [float(draws(seed, name, index, 1)[0]) for name in names]
    return [float(x) for x in _table(sampling, seed, runs, len(names))[index]]


@dataclass(frozen=True)
class Quantity:
    """What varies: a number, or a word.

    name: a path into the scene, or an option of a run. low, high: between them it is searched; of a
    normal distribution three deviations from its mean. scale: linear or log. choices: of a word,
    and of numbers that are chosen. cases: for each choice what it sets, paths and texts; none: the
    name is the path. Where a run has no value of it, it is as the scene has it.
    """

    name: str
    unit: str = ""
    kind: str = "uniform"
    low: float | None = None
    high: float | None = None
    scale: str = "linear"
    choices: tuple[float | str, ...] = ()
    is_word: bool = False
    cases: tuple[tuple[tuple[str, str], ...], ...] = ()

    def at(self, share: float) -> float | str:
        """The value at a share of the distribution, from 0 to 1."""
        if self.choices:
            return self.choices[min(int(share * len(self.choices)), len(self.choices) - 1)]
        assert self.low is not None and self.high is not None
        if self.kind == "normal":
            middle, deviation = (self.low + self.high) / 2, (self.high - self.low) / 6
            within = min(max(share, 1e-12), 1 - 1e-12)
            return statistics.NormalDist(middle, deviation).inv_cdf(within)
        return self.between(share)

    def between(self, share: float) -> float:
        """The number at a share of the way from low to high, by its scale."""
        assert self.low is not None and self.high is not None
        if self.scale == "log":
            value = math.exp(math.log(self.low) * (1 - share) + math.log(self.high) * share)
        else:
            value = self.low * (1 - share) + self.high * share
        return min(max(value, self.low), self.high)

    def settings(self, value: float | str) -> tuple[tuple[str, str], ...]:
        """What the value sets: paths, and texts as a scene file has them."""
        if self.cases:
            return self.cases[self.choices.index(value)]
        if isinstance(value, str):
            return ((self.name, value),)
        number = str(int(value)) if value.is_integer() else repr(value)  # some keys are whole
        return ((self.name, f"{number} {self.unit}".rstrip()),)


def quantity_of(entry: Entry) -> Quantity:
    """What an entry of `vary` says."""
    how = entry.only(KINDS)
    if how.is_map and how.name in ("choice", "grid"):
        cases = {name: tuple((each.name, each.text) for each in case.entries().values())
                 for name, case in how.entries().items()}
        return Quantity(entry.name, "", how.name, choices=tuple(cases), is_word=True,
                        cases=tuple(cases.values()))
    values = list(how) if how.is_list else how.fail(f"{how.name} of {entry.name}: expected a list")
    if how.name in ("choice", "grid"):
        return _choice_of(entry.name, how, values)
    if len(values) != 2:
        how.fail(f"{how.name} of {entry.name} has {len(values)} values; allowed: two, "
                 + ("mean and deviation" if how.name == "normal" else "the least and the greatest"))
    numbers, unit = _numbers_of(entry.name, values)
    first, second = numbers
    if not (math.isfinite(first) and math.isfinite(second)):
        how.fail(f"{how.name} of {entry.name} is not finite; allowed: finite numbers")
    if how.name == "normal":
        if second <= 0:
            how.fail(f"the deviation of {entry.name} is {second:g}; allowed: above 0")
        first, second = first - 3 * second, first + 3 * second
    elif first >= second:
        how.fail(f"{how.name} of {entry.name} goes from {first:g} to {second:g}; allowed: the "
                 "least before the greatest, and not equal")
    if how.name == "log_uniform" and first <= 0:
        how.fail(f"log_uniform of {entry.name} begins at {first:g}; allowed: above 0")
    scale = "log" if how.name == "log_uniform" else "linear"
    return Quantity(entry.name, unit, how.name, first, second, scale)


def _numbers_of(name: str, values: list[Entry]) -> tuple[list[float], str]:
    numbers, units = [], []
    for each in values:
        found = number_and_unit(each.text)
        if found is None:
            each.fail(f"{name}: '{each.text}' is no number")
        numbers.append(found[0])
        units.append(found[1])
    if len(set(units)) > 1:
        values[0].fail(f"{name}: the units {' and '.join(sorted(set(units)))} beside each other; "
                       "allowed: one for all")
    return numbers, units[0]


def _choice_of(name: str, how: Entry, values: list[Entry]) -> Quantity:
    if not values:
        how.fail(f"{how.name} of {name} is empty; allowed: one value or more")
    texts = [each.text for each in values]
    if len(set(texts)) < len(texts):
        how.fail(f"{how.name} of {name} has a value twice")
    if any(number_and_unit(text) is None for text in texts) or _is_row(texts):
        return Quantity(name, "", how.name, choices=tuple(texts), is_word=True)
    numbers, unit = _numbers_of(name, values)
    return Quantity(name, unit, how.name, min(numbers), max(numbers), choices=tuple(numbers))


def _is_row(texts: list[str]) -> bool:
    """`0 45 -90 deg` is a row of numbers, and stays a text."""
    found = [number_and_unit(text) for text in texts]
    return any(each is not None and number_and_unit(each[1]) is not None for each in found)
