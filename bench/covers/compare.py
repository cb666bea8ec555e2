#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""compare.py COVER [--write FILE] [--fetch] [--patience S] [MESH...]: covers meshes with each engine
and writes a table of parts, time and proven bounds, as Markdown.

Without MESH: the meshes of scenes/meshes. --fetch adds links of robots from the PyPI package
example-robot-data (130 MB, into build/pypi). The engine coacd takes part where its PyPI package is
installed or REPEL_COACD names its library, hacd where it is built in. An engine that takes longer than --patience, 300 s, is
given up."""

import argparse
import json
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import time
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
ERROR, OVERLAP, PARTS = "2mm", "5mm", "32"
PACKAGE = "example-robot-data==6.0.0"
LINKS = ["panda_description/meshes/collision/hand.stl", "panda_description/meshes/collision/link5.stl",
         "ur_description/meshes/ur5/collision/base.stl",
         "ur_description/meshes/ur5/collision/wrist1.stl",
         "ur_description/meshes/ur5/collision/forearm.stl",
         "tiago_pro_description/meshes/torso/laptop_tray_collision.stl"]


def fetched():
    """The links, from a wheel that pip fetches once."""
    folder = ROOT / "build/pypi"
    folder.mkdir(parents=True, exist_ok=True)
    if not list(folder.glob("example_robot_data-*.whl")):
        subprocess.run([sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest",
                        folder, PACKAGE], check=True)
    with zipfile.ZipFile(next(folder.glob("example_robot_data-*.whl"))) as wheel:
        for name in wheel.namelist():
            if any(name.endswith(link) for link in LINKS):
                yield pathlib.Path(wheel.extract(name, folder / "meshes"))


def row_of(program, mesh, engine, patience):
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, "report.json")
        start = time.monotonic()
        try:
            run = subprocess.run([program, mesh, "-o", os.path.join(folder, "parts.yaml"), "--json",
                                  report, "--quiet", "--allow-gaps", "--engine", engine, "--parts",
                                  PARTS, "--error", ERROR, "--overlap", OVERLAP],
                                 capture_output=True, text=True, timeout=patience, check=False)
        except subprocess.TimeoutExpired:
            return f"| {mesh.stem} | {engine} | more than {patience:.0f} | | | | | | |"
        seconds = time.monotonic() - start
        if run.returncode != 0:
            print(run.stderr.strip(), file=sys.stderr)
            return None
        with open(report, encoding="utf-8") as file:
            cover = json.load(file)
    corners = sum(len(part) for part in cover["parts"])
    seam = "" if cover["seam_m"] is None else f"{1e3 * cover['seam_m']:.3g}"
    return (f"| {mesh.stem} | {engine} | {seconds:.1f} | {len(cover['parts'])} | {corners} "
            f"| {1e3 * cover['excess_m']:.3g} | {1e3 * cover['excess_mean_m']:.2g} "
            f"| {len(cover['uncovered'])} | {seam} |")


def machine():
    with open("/proc/cpuinfo", encoding="utf-8") as file:
        names = [line.split(":")[1].strip() for line in file if line.startswith("model name")]
    commit = subprocess.run(["git", "-C", ROOT, "describe", "--always", "--dirty", "--abbrev=12"],
                            capture_output=True, text=True, check=False).stdout.strip()
    return f"{names[0] if names else platform.machine()}; commit {commit}"


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("meshes", nargs="*", type=pathlib.Path)
    parser.add_argument("--write")
    parser.add_argument("--fetch", action="store_true")
    parser.add_argument("--patience", type=float, default=300.0)
    options = parser.parse_args()
    meshes = options.meshes or sorted((ROOT / "scenes/meshes").glob("*.stl"))
    if options.fetch:
        meshes += list(fetched())
    lines = ["# Covers of meshes", "", "Written by bench/covers/compare.py; "
             "[covers.md](../../docs/covers.md) says what the figures are.", "",
             machine() + f"; --parts {PARTS} --error {ERROR} --overlap {OVERLAP}", "",
             "| mesh | engine | time [s] | parts | corners | excess, at most [mm] | mean excess [mm] "
             "| uncovered pieces | seams [mm] |", "|---|---|---:|---:|---:|---:|---:|---:|---:|"]
    for mesh in meshes:
        for engine in ("hull", "planes", "coacd", "hacd"):
            row = row_of(options.program, mesh, engine, options.patience)
            if row:
                lines.append(row)
                print(row, file=sys.stderr)
    text = "\n".join(lines) + "\n"
    if options.write:
        pathlib.Path(options.write).write_text(text, encoding="utf-8")
    else:
        print(text, end="")


if __name__ == "__main__":
    main()
