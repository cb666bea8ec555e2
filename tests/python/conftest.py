# SPDX-License-Identifier: BSD-3-Clause
import os
import pathlib

import pytest

import repel
from problem import ROOT, built_loop


@pytest.fixture(scope="session")
def loop(tmp_path_factory):
    program = built_loop(tmp_path_factory.mktemp("loop"))
    if program is None:
        pytest.skip("no compiler, or no Eigen")
    return program


@pytest.fixture(scope="session")
def teleop():
    """The program, found as the package finds it, or where the build of the sources puts it."""
    built = pathlib.Path(ROOT) / "build/release/bin/teleop"
    if "REPEL_TELEOP" not in os.environ and built.exists():
        os.environ["REPEL_TELEOP"] = str(built)
    try:
        return repel.program()
    except repel.SetupError:
        pytest.skip("the program teleop is not here")


@pytest.fixture(scope="session")
def scenes():
    return pathlib.Path(ROOT) / "scenes"
