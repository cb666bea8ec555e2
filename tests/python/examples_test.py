# SPDX-License-Identifier: BSD-3-Clause
"""The examples run, and say what the documentation says that they say."""

import importlib.util
import json
import os
import pathlib
import re
import subprocess
import sys

import pytest

import repel
from problem import ROOT

EXAMPLES = ROOT / "examples/python"


def said_by(name, *arguments, folder):
    return subprocess.run([sys.executable, EXAMPLES / name, *map(str, arguments)], cwd=folder,
                          capture_output=True, text=True, check=True).stdout


def test_the_first_program_is_that_of_the_page(tmp_path):
    page = (ROOT / "docs/python.md").read_text()
    code = re.search(r"```python\n(.*?)```", page, re.DOTALL)[1]
    assert code in (EXAMPLES / "01_two_boxes.py").read_text()
    printed = re.search(r"\nprints\n\n((?:    .*\n)+)", page)[1]
    said = said_by("01_two_boxes.py", folder=tmp_path)
    assert said.splitlines() == [line.strip() for line in printed.splitlines()]


def test_a_thousand_pairs(tmp_path):
    said = said_by("02_thousand_pairs.py", folder=tmp_path)
    cold, warm = map(int, re.search(r"support pairs: (\d+), then (\d+)", said).groups())
    assert warm < cold and float(re.search(r"apart: (\S+) m", said)[1]) < 1e-6


def test_a_run_is_plotted(teleop, tmp_path):
    pytest.importorskip("matplotlib")
    said = said_by("03_plot_a_run.py", "anderson_4x8", "plot.png", folder=tmp_path)
    assert re.match(r"2000 ticks, at most \d+\.\d N: plot\.png", said)
    assert (tmp_path / "plot.png").read_bytes().startswith(b"\x89PNG")


def test_an_own_controller(tmp_path):
    lines = said_by("04_own_controller.py", folder=tmp_path).splitlines()
    assert lines[0].startswith("x 0.000 m, wall 0.0 N")
    assert lines[-1] == "x 0.197 m, wall 71.9 N, saturated"  # as 03_own_controller.cpp


def test_an_arm_in_mujoco(tmp_path):
    pytest.importorskip("mujoco", minversion="4", reason="its distances are exact from 4 on")
    said = said_by("05_mujoco.py", folder=tmp_path)
    force = re.match(r"0 contacts, walls of up to (\d+) N", said)[1]
    assert 10 < int(force) < 100
    assert float(re.search(r"within (\S+) m of MuJoCo's", said)[1]) < 1e-9


def test_the_notebook_runs():
    notebook = json.loads((EXAMPLES / "first_steps.ipynb").read_text())
    names = {}
    for cell in notebook["cells"]:
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            exec("".join(cell["source"]), names)
    assert names["s"].distance == pytest.approx(0.01)
    assert names["world"].pair_count == 1


def test_every_public_name_is_on_the_page():
    page = (ROOT / "docs/python.md").read_text()
    missing = [name for name in repel.__all__ if not re.search(rf"`[^`\n]*\b{name}\b", page)]
    assert missing == []


def test_every_public_name_has_its_documentation():
    for name in repel.__all__:
        thing = getattr(repel, name)
        assert thing.__doc__, name


def test_stubs_come_with_the_package():
    package = pathlib.Path(repel.__file__).parent
    assert (package / "py.typed").exists()
    stub = (package / "_repel.pyi").read_text()
    compile(stub, "_repel.pyi", "exec")
    for name in ("Shape", "Cell", "World", "Tick"):
        assert f"class {name}:" in stub
    assert "def separation(a: Shape, X_WA: numpy.typing.ArrayLike" in stub


def test_the_types_of_the_package_hold(tmp_path):
    pytest.importorskip("mypy")
    # What NumPy multiplies is Any.
    checked = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--no-warn-return-any",
                              "-p", "repel"], cwd=tmp_path, capture_output=True, text=True,
                             check=False)
    assert checked.returncode == 0, checked.stdout


def test_a_program_of_the_whole_package_passes_the_type_checker(tmp_path):
    pytest.importorskip("mypy")
    if repel._left_out.PACKAGES or not hasattr(repel._repel, "LiveView"):
        pytest.skip("built without some of its parts")
    checked = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--cache-dir",
                              str(tmp_path), "--follow-imports", "silent",
                              str(ROOT / "tests/python/typed_program.py")], cwd=tmp_path,
                             capture_output=True, text=True, check=False)
    assert checked.returncode == 0, checked.stdout


STAND_INS = ROOT / "tests/python/stand_ins"


def with_stand_ins():
    """For a program in the place of another one's robot."""
    paths = [str(STAND_INS), str(pathlib.Path(repel.__file__).parents[1])]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}


def said_with_stand_ins(name, seconds, folder):
    return subprocess.run([sys.executable, EXAMPLES / name, "192.0.2.1", str(seconds)], cwd=folder,
                          env=with_stand_ins(), capture_output=True, text=True,
                          check=True).stdout.splitlines()


def test_torques_take_the_arm_of_franka_to_a_wall(tmp_path):
    lines = said_with_stand_ins("franka.py", 2, tmp_path)
    assert lines[0] == "0.0 s: x 0.307 m, wall 0.0 N"  # the pose of the maker's start
    assert re.fullmatch(r"2.0 s: x 0.39\d m, wall [67]\d.\d N", lines[-1])


def test_positions_take_the_arm_of_universal_robots_to_a_wall(tmp_path):
    lines = said_with_stand_ins("ur_servo.py", 3, tmp_path)
    assert re.fullmatch(r"3.0 s: [23].\d mm from the wall, [67]\d.\d N", lines[-1])


@pytest.mark.parametrize("package, name", [("pylibfranka", "franka.py"),
                                           ("rtde_control", "ur_servo.py")])
def test_examples_of_others_fit_the_packages_that_are_installed(package, name, tmp_path):
    """By their stubs; without stubs, names and types of repel are still checked."""
    for needed in ("mypy", package):
        if importlib.util.find_spec(needed) is None:
            pytest.skip(f"to have it: pip install {needed.replace('rtde_control', 'ur-rtde')}")
    said = subprocess.run([sys.executable, "-m", "mypy", "--cache-dir", str(tmp_path),
                           "--disable-error-code", "import-untyped", "--disable-error-code",
                           "import-not-found", "--follow-imports", "silent",
                           str(EXAMPLES / name)], cwd=tmp_path, capture_output=True, text=True)
    assert said.returncode == 0, said.stdout + said.stderr
