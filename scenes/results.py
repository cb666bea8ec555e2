#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""results.py SCENE.yaml LOG.csv REPORT.json RESULT.json PAGE.md: writes the part of the report that
is the same in every run to RESULT, and as tables into PAGE, between its two marks."""

import json
import re
import sys
import textwrap

from draw import phases_of, read_run

KEPT = ("scene", "backend", "rate_hz", "ticks", "pairs", "nearest_m", "nearest_pair", "deepest_m",
        "peak_force_n", "status_ticks", "chatter")
SEEN = ("images", "most_cells", "cells_left_out", "silent_s", "least_clearance_m",
        "least_clearance_pair")
MARKS = "<!-- Written by scenes/publish, from here -->\n", "<!-- to here -->\n"
FELT = 1.0  # [N]


def deficits(modules):
    return [{"name": m["name"], "passive": m["passive"], "deficit": m["deficit"]} for m in modules]


def result_of(report):
    result = {key: report[key] for key in KEPT}
    result["obstacles"] = report["obstacles"]
    if report["camera"]:
        result["camera"] = {key: report["camera"][key] for key in SEEN}
    result["modules"] = deficits(report["modules"])
    result["partners"] = [{**partner, "modules": deficits(partner["modules"])}
                          for partner in report["partners"]]
    result["machine"] = {key: report["machine"][key] for key in ("cpu", "compiler", "commit")}
    return result


def mm(metres):
    return f"{1e3 * metres:.1f}"


def summary(result):
    """A paragraph on the whole run."""
    if result["pairs"] == 0:
        yield f"{result['ticks']} ticks at {result['rate_hz']:g} Hz, no pairs, no virtual force."
        return
    said = sorted({bit for arm in [result, *result["partners"]] for bit in arm["status_ticks"]})
    peak = max(arm["peak_force_n"] for arm in [result, *result["partners"]])
    deepest = result["deepest_m"]
    nearest = result["nearest_pair"].replace(" - ", "` to `")
    text = (f"{result['ticks']} ticks at {result['rate_hz']:g} Hz, {result['pairs']} pairs. "
            f"Least distance {mm(result['nearest_m'])} mm (`{nearest}`), deepest intrusion "
            f"{mm(deepest) if deepest else 0} mm. Peak virtual force on a tool {peak:.0f} N. "
            f"Status bits: {', '.join(f'`{bit}`' for bit in said) or 'none'}.")
    yield textwrap.fill(text, 100, break_on_hyphens=False)
    if "camera" in result:
        yield ""
        yield textwrap.fill(camera_sentences(result["camera"]), 100, break_on_hyphens=False)


def camera_sentences(camera):
    pair = camera["least_clearance_pair"].replace(" - ", "` from `")
    return (f"{camera['images']} images, of up to {camera['most_cells']} cells. Least distance of "
            f"`{pair}` itself, which is not in the model: {mm(camera['least_clearance_m'])} mm. "
            f"The camera was silent for {camera['silent_s']:.1f} s.")


def obstacle_table(result):
    felt = [o for o in result["obstacles"] if o["peak_force_n"] >= FELT]
    if not felt:
        return
    yield "| obstacle | peak [N] | least distance [mm] | deepest [mm] | largest force on |"
    yield "|---|---|---|---|---|"
    for o in sorted(felt, key=lambda o: -o["peak_force_n"]):
        deepest = mm(o["deepest_m"]) if o["deepest_m"] else 0
        whose = "" if o["body"].split("/")[-1] == "tool" else ", a link"
        if o["body"] == o["part"]:
            whose = ", held"
        yield (f"| `{o['name']}` | {o['peak_force_n']:.0f} | {mm(o['nearest_m'])} | {deepest} | "
               f"`{o['part']}`{whose} |")
    unfelt = len(result["obstacles"]) - len(felt)
    if unfelt:
        yield f"\nThe other {unfelt} push less than {FELT:g} N."


def chatter_table(result):
    """How rough the walls were on each arm: rms above 30 Hz, and the largest jump per tick."""
    if result["pairs"] == 0:
        return
    above = result["chatter"]["above_hz"]
    yield ""
    yield (f"| chatter of the walls on | force above {above:g} Hz [N] | its largest jump [N] | "
           f"torque above {above:g} Hz [N m] | its largest jump [N m] |")
    yield "|---|---|---|---|---|"
    for arm in [result, *result["partners"]]:
        walls = arm["chatter"]["walls"]
        cells = [f"{walls[key]:.3g}" if walls[key] is not None else "not known"
                 for key in ("force_rms_n", "force_jump_n", "torque_rms_nm", "torque_jump_nm")]
        name = f"the tool of `{arm['name']}`" if arm is not result else "the tool"
        yield f"| {name} | {' | '.join(cells)} |"


def concerns(arm, partners, pair):
    """Whether an arm is one of the two that a pair is of."""
    first, second = pair.split(" - ") if pair else ("", "")
    if arm.prefix:
        return first.startswith(arm.prefix) or second.startswith(arm.prefix)
    return not any(first.startswith(partner["name"] + "/") for partner in partners)


def phase_table(arm, partners):
    """What the operator of an arm does, and the largest force in that time, if the arm is one of
    the pair with the largest force in the whole cell."""
    if arm.prefix or partners:
        yield f"The operator of `{arm.prefix[:-1]}`:\n" if arm.prefix else "The first operator:\n"
    yield "| | until [s] | what the operator does | device | largest force |"
    yield "|---|---|---|---|---|"
    for number, phase, ticks in phases_of(arm.entry, arm.log):
        row = max(ticks, key=lambda row: (concerns(arm, partners, row["hardest_pair"]),
                                          float(row["hardest_n"] or 0)))
        force = float(row["hardest_n"] or 0)
        felt = force >= FELT and concerns(arm, partners, row["hardest_pair"])
        push = f"{force:.0f} N, `{row['hardest_pair']}`" if felt else ""
        device = phase["device"].replace("_", " ")
        yield (f"| {number} | {float(ticks[-1]['time_s']):.1f} | {phase['name']} | {device} | "
               f"{push} |")


def tables(result, arms):
    yield from summary(result)
    yield ""
    yield from obstacle_table(result)
    yield from chatter_table(result)
    for arm in arms:
        yield ""
        yield from phase_table(arm, result["partners"])


def main():
    if len(sys.argv) != 6 or "--help" in sys.argv:
        print(__doc__)
        sys.exit(0 if "--help" in sys.argv else 2)
    scene_path, log_path, report_path, result_path, page_path = sys.argv[1:]
    with open(report_path, encoding="utf-8") as file:
        result = result_of(json.load(file))
    with open(result_path, "w", encoding="utf-8") as file:
        file.write(json.dumps(result, indent=2) + "\n")
    _, arms, log = read_run(scene_path, log_path)
    for arm in arms:
        arm.log = log
    with open(page_path, encoding="utf-8") as file:
        page = file.read()
    written = MARKS[0] + "\n" + "\n".join(tables(result, arms)) + "\n\n" + MARKS[1]
    between = re.escape(MARKS[0]) + ".*" + re.escape(MARKS[1])
    page, count = re.subn(between, lambda _: written, page, flags=re.DOTALL)
    if count != 1:
        sys.exit(f"{page_path}: the two marks of the tables are not there")
    with open(page_path, "w", encoding="utf-8") as file:
        file.write(page)


if __name__ == "__main__":
    main()
