# SPDX-License-Identifier: BSD-3-Clause
"""The lines above a table of studies."""

import os
import pathlib
import platform
import subprocess

import dask
import numpy

root = pathlib.Path(__file__).resolve().parent.parent.parent


def heading(title, command):
    """How the table was made, and where."""
    commit = subprocess.run(["git", "-C", root, "rev-parse", "--short", "HEAD"],
                            capture_output=True, text=True, check=False).stdout.strip()
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8")
                if line.startswith("model name")), platform.machine())
    # In two pieces, for who looks for the licence of this file.
    return ["<!-- SPDX-" "License-Identifier: BSD-3-Clause -->", "", title, "", f"`{command}`,",
            f"{cpu}, {os.cpu_count()} processors, Python {platform.python_version()}, Dask "
            f"{dask.__version__}, NumPy {numpy.__version__}, commit {commit or 'unknown'}.", ""]
