# SPDX-License-Identifier: BSD-3-Clause
"""A study without a cell, whose runs are arithmetic, for tests and benchmarks of what is around.

As a program it is `repel` with STUDY a word such as toy or toy:killer=17, see ToyStudy."""

from __future__ import annotations

import dataclasses
import hashlib
import math
import os
import signal
import sys
import time

import numpy as np


@dataclasses.dataclass(frozen=True)
class Quantity:
    name: str
    unit: str = ""
    is_word: bool = False
    low: float | None = 0.0
    high: float | None = 1.0
    scale: str = "linear"
    choices: tuple = ()
    nominal: float | str | None = None


@dataclasses.dataclass(frozen=True)
class Bound:
    measure: str
    unit: str
    relation: str
    limit: float

    def margin(self, row):
        return (row[self.measure] - self.limit) * (1 if self.relation == "above" else -1)


@dataclasses.dataclass
class ToyStudy:
    """Each run draws `weight`, `speed` and `tool` and measures how deep it goes.

    killer: the run that kills its process. bug: the run that raises. sleep: [s] of each run.
    odd: the run without measures. refuse: the run that is refused. salt: is in the identity.
    """

    runs: int = 100
    seed: int = 1
    killer: int = -1
    bug: int = -1
    odd: int = -1
    refuse: int = -1
    sleep: float = 0.0
    limit: float = 0.9
    salt: str = ""
    versions: dict = dataclasses.field(default_factory=lambda: ToyStudy.versions_here())

    name = "toy"
    file = "toy"
    options = ()
    is_random = True
    quantities = (Quantity("weight", "kg", low=0.1, high=10.0, scale="log", nominal=1.0),
                  Quantity("speed", "m/s", nominal=0.5),
                  Quantity("tool", is_word=True, low=None, high=None, choices=("ball", "<rod>"),
                           nominal="ball"))
    measures = ("depth_m",)
    columns = (("index", "int64"), ("weight", "float64"), ("speed", "float64"), ("tool", "string"),
               ("depth_m", "float64"), ("margin", "float64"), ("refused", "string"),
               ("held", "bool"))

    @staticmethod
    def versions_here():
        return {"toy": os.environ.get("TOY_VERSION", "1")}

    @property
    def text(self):
        return f"toy: {self.salt}\n"

    @property
    def identity(self):
        return hashlib.sha256(f"{self.seed} {self.limit} {self.salt}".encode()).hexdigest()

    @property
    def bounds(self):
        return (Bound("depth_m", "m", "below", self.limit),)

    def values(self, index):
        random = np.random.default_rng([self.seed, index])
        return {"weight": float(10 ** random.uniform(-1, 1)), "speed": float(random.uniform()),
                "tool": str(random.choice(["ball", "<rod>"]))}

    def row(self, index):
        if index == self.killer:
            os.kill(os.getpid(), signal.SIGKILL)
        if index == self.bug:
            raise ZeroDivisionError("a planted bug")
        time.sleep(self.sleep)
        return self._row(index, self.values(index))

    def row_of(self, values, hand):
        return self._row(-1, {**{each.name: each.nominal for each in self.quantities}, **values})

    def _row(self, index, values):
        refused = "it stands in a wall" if index == self.refuse and index >= 0 else ""
        is_empty = refused or (index == self.odd and index >= 0)
        depth = math.nan if is_empty else values["speed"] * (1 + 0.1 * math.log10(values["weight"]))
        margin = self.limit - depth
        return {"index": index, **values, "depth_m": depth, "margin": margin, "refused": refused,
                "held": margin > 0}

    def hand_size(self):
        return 0

    def point(self, index):
        return self.values(index), None

    def command(self, what, folder, hand=None):
        return [sys.executable, "-c", "import sys; print(*sys.argv[1:])", f"{what}", "--fast"]


def read_study(name, runs=None):
    """Of a word as toy:runs=50,bug=3."""
    given = dict(each.split("=") for each in name.partition(":")[2].split(",") if each)
    kinds = {each.name: type(each.default) for each in dataclasses.fields(ToyStudy)}
    study = ToyStudy(**{key: kinds[key](value) for key, value in given.items()})
    if runs is not None:
        study.runs, study.options = runs, ("--runs", str(runs))
    study.file = name
    return study


def main():
    import toy_study  # by its name, for workers to find it
    from repel.study import command
    command.read_study = toy_study.read_study
    sys.exit(command.main())


if __name__ == "__main__":
    main()
