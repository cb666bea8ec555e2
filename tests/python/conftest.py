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
    """The program in the package, or where the build of the sources puts it."""
    try:
        return repel.program()
    except repel.SetupError:
        built = pathlib.Path(ROOT) / "build/release/bin/teleop"
        if not built.exists():
            pytest.skip("the program teleop is not here")
        os.environ["REPEL_TELEOP"] = str(built)
        return repel.program()


@pytest.fixture(scope="session")
def scenes():
    return pathlib.Path(ROOT) / "scenes"
