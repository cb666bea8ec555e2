#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Where the instructions of a tick go: split.py TELEOP [SCENE...] [--write FILE] [--json FILE].

TELEOP is the path of that program. Runs the scenes (default: anderson_4x8 and two_arms) without
real time under callgrind, and prints the instructions of each call of control/repel/loop/tick.hpp, as
a mean over the ticks, with the median time of a tick in a run without callgrind. Needs valgrind
where the program is built and where it runs.
"""

import argparse
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parent.parent.parent

# Row of the table, function. With worker threads the pairs would be shared out to them.
calls = [
    ("begin_tick", "repel::Teleoperator::begin_tick"),
    ("read_joints", "repel::Teleoperator::read_joints"),
    ("place_bodies", "repel::Teleoperator::place_bodies"),
    ("the pairs", "repel::Coprocessor::exchange"),
    ("push_away", "repel::Teleoperator::push_away"),
    ("gather_damping", "repel::gather_damping"),
    ("follow", "repel::Teleoperator::follow"),
    ("run_network", "repel::Teleoperator::run_network"),
    ("judge", "repel::ArmCommand::judge"),
    ("drive", "repel::Teleoperator::drive"),
    ("finish_tick", "repel::Teleoperator::finish_tick"),
]
halves = ["repel::Cell::sense(*", "repel::Cell::act(*"]


def report_of(command, folder):
    report = folder / "report.json"
    subprocess.run([*command, "--report", report], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return json.loads(report.read_text())


def instructions(profile, ticks):
    """Inclusive instructions per tick of each call, and of the tick."""
    listed = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", profile],
                            check=True, capture_output=True, text=True).stdout
    found = {}
    for line in listed.splitlines():
        match = re.match(r"\s*([\d,]+) +\([^)]*\) +(.*)", line)
        if not match:
            continue
        count = int(match[1].replace(",", "")) / ticks
        name = match[2].partition(":")[2].removeprefix("void ")
        if match[2].startswith("PROGRAM TOTALS"):
            found["a tick"] = count
        for call, function in calls:
            if name.startswith(function + "(") and "::{lambda" not in name:
                found.setdefault(call, count)
    return found


def measure(teleop, scene):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        timed = report_of([teleop, "run", scene, "--fast"], folder)
        profile = folder / "profile"
        counted = report_of(["valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}",
                             *(f"--toggle-collect={half}" for half in halves),
                             teleop, "run", scene, "--fast"], folder)
        split = instructions(profile, counted["ticks"])
    if missing := [call for call, _ in calls if call not in split]:
        sys.exit(f"{scene}: not in the profile: {', '.join(missing)}")
    split["the rest"] = split["a tick"] - sum(split[call] for call, _ in calls)
    return {"scene": scene, "commit": timed["machine"]["commit"],
            "compiler": timed["machine"]["compiler"], "cpu": timed["machine"]["cpu"],
            "pairs_evaluated_per_tick": timed["pairs_evaluated_per_tick"],
            "compute_us_p50": timed["compute_us"]["p50"],
            "network_us_p50": timed["network_us"]["p50"], "instructions": split}


def table(results):
    lines = ["| call | " + " | ".join(each["scene"] for each in results) + " |",
             "|---|" + "---:|" * len(results)]
    for row in [call for call, _ in calls] + ["the rest", "a tick"]:
        counts = (each["instructions"][row] for each in results)
        lines.append(f"| {row} | " + " | ".join(f"{count:.0f}" for count in counts) + " |")
    for title, key, form in (("pairs evaluated", "pairs_evaluated_per_tick", ".2f"),
                             ("median time of a tick [us]", "compute_us_p50", ".2f"),
                             ("median time of a network [us]", "network_us_p50", ".2f")):
        lines.append(f"| {title} | " + " | ".join(f"{each[key]:{form}}" for each in results) + " |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("teleop", help="path of the program")
    parser.add_argument("scenes", nargs="*", default=["anderson_4x8", "two_arms"])
    parser.add_argument("--write", metavar="FILE", help="write the table as Markdown")
    parser.add_argument("--json", metavar="FILE", help="write the figures")
    arguments = parser.parse_args()
    if shutil.which("valgrind") is None:
        sys.exit("valgrind is missing; to have it: apt-get install valgrind")
    teleop = pathlib.Path(arguments.teleop).resolve()
    results = [measure(teleop, scene) for scene in arguments.scenes]
    lines = table(results)
    print("\n".join(lines))
    if arguments.write:
        made = results[0]
        head = ["# A tick, call by call", "",
                "[benchmarks.md](../../docs/benchmarks.md#a-tick-call-by-call) says how to read it.",
                f"Written by `bench/tick/split.py`: {made['cpu']}, {made['compiler']}, commit "
                f"{made['commit']}.", ""]
        pathlib.Path(arguments.write).write_text("\n".join(head + lines) + "\n")
    if arguments.json:
        pathlib.Path(arguments.json).write_text(json.dumps(results, indent=2) + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
