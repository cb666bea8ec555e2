#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Makes the studies of this folder and writes their pages: publish.py [--results FOLDER].

Needs the package with its extra `study`: pip install '.[study]'. Writes bench/results/arms.md and
walls.md. Exits with 1 if an arm of the first is not calm.
"""

import argparse
import os
import pathlib
import platform
import subprocess
import sys
import tempfile

import pyarrow.parquet

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
FORCE, DAMPING, RATE = 20.0, 100.0, 400.0  # of press_and_slide.yaml: [N], [N s/m], [Hz]


def rows_of(name):
    """The table of a study, a dict for each run, and whether all held."""
    with tempfile.TemporaryDirectory() as folder:
        made = subprocess.run([sys.executable, "-m", "repel", "study", HERE / f"{name}.yaml",
                               "--out", f"{folder}/out"], check=False)
        if made.returncode not in (0, 6):
            sys.exit(f"publish.py: the study {name} ended with status {made.returncode}")
        return pyarrow.parquet.read_table(f"{folder}/out/results.parquet").to_pylist()


def heading(title):
    commit = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty", "--exclude=*"],
                            capture_output=True, text=True, check=False).stdout.strip()
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8")
                if line.startswith("model name")), platform.machine())
    gxx = subprocess.run(["g++", "-dumpfullversion"], capture_output=True, text=True,
                         check=False).stdout.strip()
    return [f"# {title}", "", f"`studies/publish.py`, {cpu}, {os.cpu_count()} processors, g++ {gxx},",
            f"commit {commit or 'unknown'}. The runs do not depend on the clock.", ""]


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
    lines = [f"Stiffness in kN/m of the stiffest wall that is calm, of five in a decade, at {RATE:g} "
             f"Hz with {DAMPING:g} N s/m of damping", "in the wall. The check at set-up allows "
             f"B / (T / 2) = {2e-3 * DAMPING * RATE:g} kN/m with the prediction.", "",
             "| arm | with the prediction | without it |", "|---|---|---|"]
    for arm in dict.fromkeys(row["arm"] for row in rows):
        with_, without = (stiffest([row for row in rows if row["arm"] == arm
                                    and row["prediction"] == word]) for word in ("yes", "no"))
        lines.append(f"| {arm} | {with_} | {without} |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", default=ROOT / "bench/results", type=pathlib.Path)
    results = parser.parse_args().results
    calm = rows_of("calm")
    (results / "arms.md").write_text(
        "\n".join(heading("Arms that people have") + arms_page(calm)) + "\n")
    (results / "walls.md").write_text(
        "\n".join(heading("The stiffest walls") + walls_page(rows_of("stiffest"))) + "\n")
    return 0 if all(row["held"] for row in calm) else 1


if __name__ == "__main__":
    sys.exit(main())
