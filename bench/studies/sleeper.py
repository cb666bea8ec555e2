# SPDX-License-Identifier: BSD-3-Clause
"""A study whose runs only wait, to measure what is around them. As a program: sleeper.py RUNS
MILLISECONDS WORKERS FOLDER makes it."""

import dataclasses
import sys
import time

from repel.study.engine import engine
from repel.study.store import Store


@dataclasses.dataclass
class Sleeper:
    """Each run takes `seconds` [s] and has eight numbers."""

    runs: int
    seconds: float

    file = name = text = identity = "sleeper"
    seed = 1
    versions = {"sleeper": "1"}
    quantities = bounds = ()
    measures = tuple(f"measure_{i}" for i in range(6))
    columns = (("index", "int64"), *((name, "float64") for name in measures),
               ("took_s", "float64"), ("margin", "float64"), ("refused", "string"),
               ("held", "bool"))

    @staticmethod
    def versions_here():
        return Sleeper.versions

    def values(self, index):
        return {}

    def row(self, index):
        began = time.perf_counter()
        time.sleep(self.seconds)
        numbers = {name: 0.1 * index + i for i, name in enumerate(self.measures)}
        return {"index": index, **numbers, "margin": 1.0, "refused": "", "held": True,
                "took_s": time.perf_counter() - began}


def make(study, workers, folder):
    """Makes it; returns batches, seconds that runs took, seconds in all, and those of the processor
    for this process, with its scheduler and its table."""
    with Store(folder, study) as store, engine(workers, None, lambda text: None) as where:
        began, cpu = time.perf_counter(), time.process_time()
        batches, busy = 0, 0.0
        for made in where.made(study, store.missing):
            if made is not None:
                store.add(made.rows)
                batches += 1
                busy += made.rows["took_s"].to_numpy().sum()
        took = time.perf_counter() - began, time.process_time() - cpu
        store.finish()
    return batches, busy, *took


if __name__ == "__main__":
    import sleeper  # by its name, for workers to find it
    sleeper.make(sleeper.Sleeper(int(sys.argv[1]), 1e-3 * float(sys.argv[2])), int(sys.argv[3]),
                 sys.argv[4])
