#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""What memory a study takes as it grows: memory.py [--runs N N ...].

The most that the coordinator and its largest worker have, in MB, for studies of each size whose
runs wait for two milliseconds. Exits with 1 if one has a tenth more than that of the first.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile
import time

import psutil


def most(runs, workers=2):
    """The most [MB] of the coordinator, and of the largest worker."""
    program = pathlib.Path(__file__).with_name("sleeper.py")
    with tempfile.TemporaryDirectory() as folder:
        child = subprocess.Popen([sys.executable, program, str(runs), "2", str(workers), folder])
        of_all = {}
        while child.poll() is None:
            try:
                for each in (process := psutil.Process(child.pid),
                             *process.children(recursive=True)):
                    of_all[each.pid] = max(of_all.get(each.pid, 0), each.memory_info().rss)
            except psutil.NoSuchProcess:
                pass
            time.sleep(0.05)
        if child.returncode:
            sys.exit(child.returncode)
    coordinator = of_all.pop(child.pid)
    return coordinator / 1e6, max(of_all.values()) / 1e6


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, nargs="+", default=[2000, 10000])
    first = None
    print("| runs | coordinator | largest worker |\n|--:|--:|--:|")
    flat = True
    for runs in parser.parse_args().runs:
        both = most(runs)
        print(f"| {runs} | {both[0]:.0f} MB | {both[1]:.0f} MB |", flush=True)
        first = first or both
        flat &= all(now <= 1.1 * then for now, then in zip(both, first))
    sys.exit(0 if flat else 1)


if __name__ == "__main__":
    main()
