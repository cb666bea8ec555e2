#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""bench/near_pairs_table.py JSON: prints what near_pairs has written as a table in Markdown."""

import argparse
import json


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("json", type=argparse.FileType(encoding="utf-8"))
    runs = json.load(parser.parse_args().json)["benchmarks"]
    print("| pairs | near | in overlap | tick per near pair [ns] | warm query [ns] | ratio | "
          "least, formulas alone [ns] |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    for run in runs:
        if run.get("error_occurred"):
            print(f"| {run['name']}: {run['error_message']} | | | | | | |")
            continue
        print(f"| {run['label']} | {run['near']:.0f} | {run['overlapping']:.0f} | "
              f"{run['tick_ns']:.0f} | {run['raw_ns']:.0f} | {run['ratio']:.2f} | "
              f"{run['least_ns']:.0f} |")


if __name__ == "__main__":
    main()
