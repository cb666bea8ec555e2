#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the studies of repel's own and writes their pages: publish.py [--results FOLDER].

Needs the package with its extra `study`: pip install '.[study]'. Writes bench/results/arms.md,
walls.md and pushes.md. Exits with 1 if an arm of the first is not calm, or gets into a wall of the
last.
"""

import argparse
import pathlib
import subprocess
import sys
import tempfile

import pyarrow.parquet

from heading import heading, root
COMMAND = "bench/studies/publish.py"
FORCE, DAMPING, RATE = 20.0, 100.0, 400.0  # of press_and_slide.yaml: [N], [N s/m], [Hz]


def rows_of(name):
    """The table of a study, a dict for each run."""
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "repel", "study", root / f"studies/{name}.yaml", "--out",
                   f"{folder}/out"]
        made = subprocess.run(command, check=False)
        if made.returncode not in (0, 6):
            sys.exit(f"publish.py: the study {name} ended with status {made.returncode}")
        return pyarrow.parquet.read_table(f"{folder}/out/results.parquet").to_pylist()


def arms_page(rows):
    lines = ["| arm | rate, Hz | inertia | by sampling, J | joint speed, rad/s | wall force, N "
             "| above 30 Hz, N rms | at a limit | faults | exit | calm |",
             "|---|---|---|---|---|---|---|---|---|---|---|"]
    for row in sorted(rows, key=lambda row: row["index"]):
        lines.append(
            f"| {row['arm']} | {row['rate']:g} | {row['plant_inertia']:g} "
            f"| {row['sampling_energy_j']:.2g} | {row['joint_speed_rad_s']:.3g} "
            f"| {row['wall_force_n']:.1f} | {row['force_above_30hz_n']:.2g} "
            f"| {100 * row['limit_share']:.1f} % | {100 * row['fault_share']:.1f} % "
            f"| {row['exit']:g} | {'yes' if row['held'] else '**no**'} |")
    return lines


def stiffest(rows):
    """[kN/m] The stiffest wall that holds, with all that are softer; none: a word."""
    best = None
    for row in sorted(rows, key=lambda row: -row["laws.wall.range"]):
        if not row["held"]:
            break
        best = 2 * FORCE / row["laws.wall.range"]  # [N/mm]
    return "none" if best is None else f"{best:.3g}"


def walls_page(rows):
    lines = ["Stiffness in kN/m of the stiffest wall that is calm, of five in a decade, at "
             f"{RATE:g} Hz with {DAMPING:g} N s/m", "of damping in the wall. The check at set-up allows "
             f"B / (T / 2) = {2e-3 * DAMPING * RATE:g} kN/m with the prediction.", "",
             "| arm | with the prediction | without it |", "|---|---|---|"]
    for arm in dict.fromkeys(row["arm"] for row in rows):
        with_, without = (stiffest([row for row in rows if row["arm"] == arm
                                    and row["prediction"] == word]) for word in ("yes", "no"))
        lines.append(f"| {arm} | {with_} | {without} |")
    return lines


def pushes_page(rows):
    rates = sorted({row["rate"] for row in rows})
    hands = len(rows) // len({(row["scene"], row["rate"]) for row in rows})
    lines = [f"The least distance from a hard wall, in mm, of {hands} hands in each; below 0 is in it.",
             "", "| scene | " + " | ".join(f"{rate:g} Hz" for rate in rates) + " |",
             "|---|" + "--:|" * len(rates)]
    for scene in dict.fromkeys(row["scene"] for row in rows):
        least = [1e3 * min(row["nearest_wall_m"] for row in rows
                           if row["scene"] == scene and row["rate"] == rate) for rate in rates]
        lines.append(f"| {scene} | " + " | ".join(f"{each:.3f}" for each in least) + " |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", default=root / "bench/results", type=pathlib.Path)
    results = parser.parse_args().results
    calm = rows_of("calm")
    walls = rows_of("stiffest")
    pushes = rows_of("hard_walls")
    for page, lines in (
            ("arms.md", heading("# Arms that people have", COMMAND) + arms_page(calm)),
            ("walls.md", heading("# The stiffest walls", COMMAND) + walls_page(walls)),
            ("pushes.md", heading("# Hands stronger than the arm before hard walls", COMMAND)
             + pushes_page(pushes))):
        (results / page).write_text("\n".join(lines) + "\n")
    return 0 if all(row["held"] for row in calm + pushes) else 1


if __name__ == "__main__":
    sys.exit(main())
