#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How often a search finds what random runs miss: falsify.py [--seeds N] [--write FILE].

On functions with a planted weakness at a place of chance. Needs the package with its extra `study`.
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import pathlib
import statistics

import numpy as np

from repel.study import falsify
from repel.study.engine import Here

RUNS = 500


@dataclasses.dataclass(frozen=True)
class Number:
    """A quantity of 0..1, or a word if it has choices."""

    name: str
    unit: str = ""
    low: float | None = 0.0
    high: float | None = 1.0
    scale: str = "linear"
    choices: tuple = ()
    nominal: float | str | None = None

    @property
    def is_word(self):
        return bool(self.choices)


class Planted:
    """A study whose margin is a function of its numbers and of the hand's."""

    file = name = "planted"
    text = identity = ""
    versions: dict = {}
    bounds = ()
    runs, seed = RUNS, 1
    measures = ("distance_m",)

    def __init__(self, numbers, hand, seed):
        self.quantities, self._hand = tuple(numbers), hand
        self.random = np.random.default_rng(seed)
        self.columns = (("index", "int64"), *((each.name, "string" if each.is_word else "float64")
                                              for each in numbers),
                        ("distance_m", "float64"), ("margin", "float64"), ("refused", "string"),
                        ("held", "bool"))

    def margin(self, values, hand):
        raise NotImplementedError

    def hand_size(self):
        return self._hand

    def point(self, index):
        random = np.random.default_rng([1, index])
        values = {each.name: str(random.choice(each.choices)) if each.is_word else
                  float(random.uniform(each.low, each.high)) for each in self.quantities}
        return values, random.uniform(-1, 1, self._hand).tolist() if self._hand else None

    def values(self, index):
        return self.point(index)[0]

    def row_of(self, values, hand):
        usual = {each.name: each.nominal for each in self.quantities if each.nominal is not None}
        values = {**usual, **values}
        margin = float(self.margin(values, hand))
        return {"index": -1, **values, "distance_m": margin, "margin": margin, "refused": "",
                "held": margin > 0}

    def row(self, index):
        return {**self.row_of(*self.point(index)), "index": index}

    def command(self, what, folder, hand=None):
        return ["true", str(what)]


class Bowl(Planted):
    """Below 0 in a ball that holds `share` of the cube; with words, only for one of them."""

    def __init__(self, size, share, seed, words=()):
        numbers = [Number(f"x{i}") for i in range(size)]
        super().__init__(numbers + ([Number("tool", choices=words)] if words else []), 0, seed)
        ball = math.pi ** (size / 2) / math.gamma(size / 2 + 1)
        self.radius = (share * max(1, len(words)) / ball) ** (1 / size)
        self.centre = self.random.uniform(self.radius, 1 - self.radius, size)
        self.word = str(self.random.choice(words)) if words else ""

    def margin(self, values, hand):
        x = np.array([values[f"x{i}"] for i in range(len(self.centre))])
        away = float(((x - self.centre) ** 2).sum()) / self.radius ** 2
        return 0.1 * (away - 1) + (0.2 if values.get("tool", "") != self.word else 0.0)


class Slot(Planted):
    """A slot that one direction of the hand enters: `depth` along it, at most `width` beside."""

    def __init__(self, size, seed, depth=0.8, width=0.5):
        super().__init__([Number("speed"), Number("weight")], size, seed)
        way = self.random.normal(size=size)
        self.way, self.depth, self.width = way / np.linalg.norm(way), depth, width

    def margin(self, values, hand):
        along = float(np.dot(hand, self.way))
        beside = float(np.linalg.norm(np.array(hand) - along * self.way))
        return max(self.depth - along, beside - self.width) + 0.1 * values["speed"]


PLANTED = {
    "bowl, 3 numbers, 0.2 %": lambda seed: Bowl(3, 0.002, seed),
    "bowl, 4 numbers, 0.1 %": lambda seed: Bowl(4, 0.001, seed),
    "bowl, 6 numbers, 0.1 %": lambda seed: Bowl(6, 0.001, seed),
    "bowl, 4 numbers and one of 3 words, 0.1 %": lambda seed: Bowl(4, 0.001, seed,
                                                                   ("a", "b", "c")),
    "slot for a hand of 12 numbers": lambda seed: Slot(12, seed),
    "slot for a hand of 24 numbers": lambda seed: Slot(24, seed),
    "slot for a hand of 24 numbers, 1000 runs": lambda seed: Slot(24, seed),
}


def found_by(planted, seed, runs=RUNS):
    """The number of the run at which the search and random runs fail first, or None."""
    found = falsify.search(planted(seed), Here(), runs=runs, seed=seed, reduce=False,
                           compare=False)
    study = planted(seed)
    random = falsify.Search(study, Here(), lambda done, failed: None)
    random.evaluate([study.point(10**12 + 10**6 * seed + i) for i in range(runs)])
    return found.first_failure, random.first_failure


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=40, help="of each function")
    parser.add_argument("--write", metavar="FILE", help="write the table as Markdown")
    chosen = parser.parse_args()
    lines = ["| weakness | found by the search | by random runs | runs of the search, median |",
             "|---|--:|--:|--:|"]
    for name, planted in PLANTED.items():
        runs = 1000 if name.endswith("1000 runs") else RUNS
        pairs = [found_by(planted, seed, runs) for seed in range(1, chosen.seeds + 1)]
        searched = [pair[0] for pair in pairs if pair[0]]
        random = sum(pair[1] is not None for pair in pairs)
        median = f"{statistics.median(searched):.0f}" if searched else "-"
        lines.append(f"| {name} | {len(searched)} of {len(pairs)} | {random} of {len(pairs)} | "
                     f"{median} |")
        print(lines[-1], flush=True)
    if chosen.write:
        from heading import heading
        head = heading("# Search against random runs",
                       f"bench/studies/falsify.py --seeds {chosen.seeds} --write "
                       "bench/results/falsify.md")
        text = [f"Budget: {RUNS} runs unless the row says otherwise. The percentage is the failure",
                "rate of random runs.", ""]
        pathlib.Path(chosen.write).write_text("\n".join([*head, *text, *lines]) + "\n")


if __name__ == "__main__":
    main()
