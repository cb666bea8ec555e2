#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench.py [--pairs N] [--shapes N] [--rounds N]: what a pair costs from Python and in C++.

Checks first that the answers have the same bits. Then it times both by turns, keeps the least time
of each, and prints it with the ratio; then what single calls and ticks cost from Python. Needs the
package, a C++ compiler and Eigen.
"""

import argparse
import pathlib
import platform
import sys
import tempfile
import time

import numpy as np

import repel
from gantry import gantry_cell
from problem import COLUMNS, ROOT, Problem, answers_of_loop, built_loop


def time_from_python(problem, repeats):
    """The least time of a pair [ns]."""
    least = float("inf")
    for _ in range(repeats):
        begin = time.perf_counter_ns()
        repel.separations(problem.shapes, problem.X_W, problem.pairs)
        least = min(least, time.perf_counter_ns() - begin)
    return least / len(problem.pairs)


def compared(program, problem, folder, rounds, repeats=5):
    """(from Python, in C++) [ns]: least times of a pair, by turns."""
    rows = repel.separations(problem.shapes, problem.X_W, problem.pairs)
    answers, _ = answers_of_loop(program, problem, folder)
    for name in COLUMNS:
        if rows[name].tobytes() != answers[name].tobytes():
            raise SystemExit(f"{name} differs between Python and C++")
    python, cpp = float("inf"), float("inf")
    for _ in range(rounds):
        cpp = min(cpp, answers_of_loop(program, problem, folder, repeats)[1])
        python = min(python, time_from_python(problem, repeats))
    return python, cpp


def time_of_single_calls(problem):
    """[ns] of a call of `separation` from Python."""
    pairs = problem.pairs[:2000].tolist()
    begin = time.perf_counter_ns()
    for a, b in pairs:
        repel.separation(problem.shapes[a], problem.X_W[a], problem.shapes[b], problem.X_W[b])
    return (time.perf_counter_ns() - begin) / len(pairs)


def time_of_a_tick():
    """[us] of a tick of the default scene from Python, with a simulated arm and the operator, and
    of the `step` alone of an arm with kinematics in Python; medians."""
    scene = repel.load_scene(ROOT / "scenes/anderson_4x8.yaml")
    cell = repel.Cell.from_scene(scene, gravity=False)
    arm, operator = repel.SimulatedArm(cell, kind="ideal"), scene.operator()
    whole, own = [], []
    for _ in range(2000):
        begin = time.perf_counter_ns()
        cell.sense([(arm.q, arm.v)])
        (tick,) = cell.act([operator.step(cell.X_WT(), cell.elapsed)])
        arm.apply(tick)
        arm.step(cell.period)
        whole.append(time.perf_counter_ns() - begin)
    cell, command = gantry_cell(), repel.Command()
    rest = np.zeros(3)
    for _ in range(2000):
        begin = time.perf_counter_ns()
        cell.step(rest, rest, command)
        own.append(time.perf_counter_ns() - begin)
    return np.median(whole) / 1e3, np.median(own) / 1e3


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=10_000)
    parser.add_argument("--shapes", type=int, nargs="+", default=[200, 2000, 20_000])
    parser.add_argument("--rounds", type=int, default=10)
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        program = built_loop(folder)
        if program is None:
            print("skipped: no compiler, or no Eigen")
            return 77
        print(f"{platform.machine()}, Python {platform.python_version()}, {chosen.pairs} pairs, "
              "the same bits from both")
        print("shapes   Python [ns/pair]   C++ [ns/pair]   ratio")
        for shapes in chosen.shapes:
            problem = Problem(1, shapes, chosen.pairs, room=0.5)
            python, cpp = compared(program, problem, pathlib.Path(folder), chosen.rounds)
            print(f"{shapes:6d}   {python:16.0f}   {cpp:13.0f}   {python / cpp:5.2f}")
        print(f"a single call of separation: {time_of_single_calls(problem):.0f} ns")
    if hasattr(repel, "load_scene"):
        whole, own = time_of_a_tick()
        print(f"a tick of anderson_4x8 with its arm and operator: {whole:.1f} us; "
              f"of a gantry with kinematics in Python: {own:.1f} us")
    return 0


if __name__ == "__main__":
    sys.exit(main())
