# SPDX-License-Identifier: BSD-3-Clause
"""The studies of repel's own, small; one of them larger, with its coordinator killed on the way."""

import os
import pathlib
import signal
import subprocess
import sys
import time

import pytest

import repel
from problem import ROOT

for needed in ("yaml", "pyarrow", "scipy", "distributed"):
    pytest.importorskip(needed)
if not hasattr(repel._repel, "run_scene"):
    pytest.skip("this build runs no scenes", allow_module_level=True)

STUDIES = pathlib.Path(ROOT) / "studies"
#: How many runs, and what is known of them: 0 they hold, 6 that some do not is their result.
OWN = {"calm": (10, 0), "stiffest": (20, 6), "glass": (6, 0), "hard_walls": (13, 0)}


def study(name, out, *arguments):
    return [sys.executable, "-m", "repel", "study", STUDIES / f"{name}.yaml", "--out", out, "--quiet",
            *arguments]


def test_every_study_is_tested():
    files = {file.stem for file in STUDIES.glob("*.yaml") if "\nhold:" in file.read_text()}
    assert files == set(OWN)


@pytest.mark.parametrize("name", OWN)
def test_a_study_of_ours(tmp_path, name):
    runs, status = OWN[name]
    done = subprocess.run(study(name, tmp_path / "out", "--runs", str(runs), "--workers", "0"),
                          check=False)
    assert done.returncode == status
    assert (tmp_path / "out/report.html").stat().st_size > 10000


def test_a_killed_study_goes_on_to_the_same_table(tmp_path):
    arguments = ["--runs", "60", "--workers", "2"]
    whole, killed = tmp_path / "whole", tmp_path / "killed"
    subprocess.run(study("calm", whole, *arguments), check=True)
    running = subprocess.Popen(study("calm", killed, *arguments))
    while running.poll() is None and not list(killed.glob("parts/*.parquet")):
        time.sleep(0.05)
    assert running.poll() is None, "it was over before it could be killed"
    os.kill(running.pid, signal.SIGKILL)
    running.wait()
    assert not (killed / "results.parquet").exists()
    subprocess.run(study("calm", killed, *arguments, "--resume"), check=True)
    assert (killed / "results.parquet").read_bytes() == (whole / "results.parquet").read_bytes()
