#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""How many workers a study keeps busy: scale.py [--quick] [--write FILE].

Runs of a millisecond that only wait, on up to 16 workers of this machine: how much of their time
the workers are busy, and what a batch costs the coordinator. From that follows the number of
workers at which the coordinator has no time left. Needs the package with its extra `study`.
"""

import argparse
import os
import pathlib
import tempfile

import sleeper
from heading import heading
from repel.study import engine

RUN_S = 1e-3


def measured(workers, seconds, run_s=RUN_S):
    """The runs, and as sleeper.make, of about so many seconds."""
    with tempfile.TemporaryDirectory() as folder:
        study = sleeper.Sleeper(round(seconds * workers / (1.2 * run_s)), run_s)
        return study.runs, *sleeper.make(study, workers, folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="5 s of each instead of 20 s")
    parser.add_argument("--write", metavar="FILE", help="write the tables as Markdown")
    chosen = parser.parse_args()
    load = os.getloadavg()[0]
    seconds = 5 if chosen.quick else 20
    lines = ["| workers | a run | runs | runs/s | busy | batches | coordinator, of a processor | "
             "for a batch |", "|--:|--:|--:|--:|--:|--:|--:|--:|"]
    print(*lines, sep="\n")
    for workers, run_s in ((1, RUN_S), (2, RUN_S), (4, RUN_S), (8, RUN_S), (16, RUN_S),
                           (16, 10 * RUN_S)):
        runs, batches, busy, took, cpu = measured(workers, seconds, run_s)
        lines.append(f"| {workers} | {1e3 * run_s:.0f} ms | {runs} | {runs / took:.0f} | "
                     f"{100 * busy / (took * workers):.0f} % | {batches} | "
                     f"{100 * cpu / took:.0f} % | {1e3 * cpu / batches:.1f} ms |")
        print(lines[-1], flush=True)
    lines += ["", "| batches of | runs in one | coordinator for a batch | for a run | full at | "
              "half full at |", "|--:|--:|--:|--:|--:|--:|"]
    print(*lines[-2:], sep="\n")
    usual = engine.BATCH_S
    for batch_s in (0.1, 0.5, usual, 4.0):
        engine.BATCH_S = batch_s
        runs, batches, busy, took, cpu = measured(4, seconds + 4 * batch_s)
        mean_s = busy / batches
        lines.append(f"| {mean_s:.2f} s | {runs / batches:.0f} | {1e3 * cpu / batches:.1f} ms | "
                     f"{1e6 * cpu / runs:.1f} µs | {mean_s * batches / cpu:.0f} workers | "
                     f"{0.5 * mean_s * batches / cpu:.0f} workers |")
        print(lines[-1], flush=True)
    if chosen.write:
        head = heading("# Workers that a study keeps busy",
                       "bench/studies/scale.py " + "--quick " * chosen.quick
                       + "--write bench/results/studies.md")
        text = ["Runs that only wait. Busy: the workers' share of time in runs. The coordinator "
                "is", "one process: Dask's scheduler, and the writer of the table. Workers and "
                "coordinator", "share the processors of this machine with what else ran: a load of "
                f"{load:.1f} before the first.", ""]
        pathlib.Path(chosen.write).write_text("\n".join([*head, *text, *lines]) + "\n")


if __name__ == "__main__":
    main()
