#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/near_pairs_table.py JSON: prints what near_pairs has written as tables in Markdown."""

import argparse
import json


def mujoco_table(runs):
    """The contacts that MuJoCo found between the pairs of the ticks."""
    if not any(run["name"].startswith("mujoco_contacts") for run in runs):
        print("\nMuJoCo is not measured. To have it: bench/publish, which fetches it from PyPI")
        return
    ticks = {run["name"].partition("/")[2]: run for run in runs}
    print("\n| pairs | near | multiccd | contacts of a near pair | "
          "MuJoCo, its contacts per near pair [ns] | times the tick |")
    print("|---|---:|---|---:|---:|---:|")
    for run in runs:
        if not run["name"].startswith("mujoco_contacts"):
            continue
        _, scene, pairs, multiccd, manual = run["name"].split("/")
        ns, wrong = run["tick_ns"], run["wrong"]
        times = f"{ns / ticks[f'{scene}/{pairs}/{manual}']['tick_ns']:.2f}"
        took = f"({ns:.0f}) wrong: {wrong:.0f} of {run['checked']:.0f}" if wrong else f"{ns:.0f}"
        print(f"| {run['label']} | {pairs.removeprefix('pairs:')} | "
              f"{'on' if multiccd.endswith('1') else 'off'} | {run['contacts']:.1f} | {took} | "
              f"{f'({times})' if wrong else times} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("json", type=argparse.FileType(encoding="utf-8"))
    runs = json.load(parser.parse_args().json)["benchmarks"]
    print("| pairs | near | in overlap | tick per near pair [ns] | warm query [ns] | ratio | "
          "least, formulas alone [ns] |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    for run in runs:
        if not run["name"].startswith("near_pair/"):
            continue
        if run.get("error_occurred"):
            print(f"| {run['name']}: {run['error_message']} | | | | | | |")
            continue
        print(f"| {run['label']} | {run['near']:.0f} | {run['overlapping']:.0f} | "
              f"{run['tick_ns']:.0f} | {run['raw_ns']:.0f} | {run['ratio']:.2f} | "
              f"{run['least_ns']:.0f} |")
    mujoco_table(runs)


if __name__ == "__main__":
    main()
