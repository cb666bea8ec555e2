# SPDX-License-Identifier: BSD-3-Clause
"""What a build without some of its parts says to whom asks for them."""

import subprocess
import sys

import pytest

import repel
from repel._left_out import PACKAGES


def test_names_the_packages_of_what_is_left_out(monkeypatch):
    monkeypatch.setitem(PACKAGES, "covers", "libexample-dev")
    with pytest.raises(AttributeError, match="repel.cover is not in this build.*libexample-dev"):
        repel.__getattr__("cover")
    monkeypatch.delitem(PACKAGES, "covers")
    with pytest.raises(AttributeError, match="switched off"):
        repel.__getattr__("cover")
    with pytest.raises(AttributeError, match="no attribute 'covers'"):
        repel.__getattr__("covers")


def test_an_arm_of_a_urdf_file_names_the_packages_too(monkeypatch):
    monkeypatch.delattr(repel._repel, "_read_urdf", raising=False)
    monkeypatch.setitem(PACKAGES, "robots", "libexample-dev")
    with pytest.raises(repel.SetupError, match="Arm.from_urdf is not in this build.*libexample"):
        repel.Arm.from_urdf("arm.urdf")


def test_lists_what_is_there_and_nothing_else():
    assert all(hasattr(repel, name) for name in repel.__all__)
    assert sorted(repel.__all__) == sorted(set(repel.__all__))


def test_starts_without_scenes_and_covers():
    """As of a build with the core alone."""
    program = """
import sys
import repel._repel as compiled
for name in ("Scene", "ScriptedOperator", "SimulatedArm", "load_scene", "Cover", "cover",
             "DepthCamera", "LiveView"):
    if hasattr(compiled, name):
        delattr(compiled, name)
for name in [name for name in sys.modules if name.startswith("repel") and "_repel" not in name]:
    del sys.modules[name]
import repel
assert "cover" not in repel.__all__ and "World" in repel.__all__
from repel import *
try:
    repel.LiveView
except AttributeError as error:
    assert "repel.LiveView is not in this build" in str(error)
else:
    raise AssertionError
"""
    subprocess.run([sys.executable, "-c", program], check=True)
