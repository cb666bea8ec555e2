# SPDX-License-Identifier: BSD-3-Clause
"""What a cell is told of its drive, and how it computes."""

import time

import numpy as np
import pytest

import repel
from gantry import gantry_cell
from repel import Cell

AT_REST = (np.zeros(3), np.zeros(3))
HAND = repel.Command(linear=[0.1, 0.0, 0.0])


def test_a_drive_that_is_stopped_gets_no_force_of_the_operator():
    cell = gantry_cell()
    for _ in range(20):  # not longer: a joint that is pushed and does not move is frozen
        moving = cell.step(*AT_REST, HAND)
    assert moving.torques[0] > 1.0
    for _ in range(100):
        stopped = cell.step(*AT_REST, HAND, state="stopped")
    assert abs(stopped.torques[0]) < 1e-9
    with pytest.raises(repel.SetupError, match="state is 'broken'; allowed: enabled, disabled"):
        cell.step(*AT_REST, HAND, state="broken")


def test_sense_takes_what_step_takes():
    one, other = gantry_cell(), gantry_cell()
    for state in ["enabled"] * 20 + ["stopped"] * 20:
        expected = one.step(*AT_REST, HAND, state=state)
        other.sense([(*AT_REST, None, state)])
        (tick,) = other.act([HAND])
        assert (tick.torques == expected.torques).all() and tick.status == expected.status
    with pytest.raises(TypeError, match=r"\(q, v\), \(q, v, wrench\)"):
        other.sense([(AT_REST[0],)])


def cell_of(**options):
    rails = [repel.Link(name, type="prismatic", axis_J=axis, lower=-1.0, upper=1.0,
                        viscous_friction=300.0, rotor_inertia=4.0)
             for name, axis in zip("xyz", np.eye(3))]
    arm = repel.Arm(rails, start=[0.22, 0.0, 0.0],
                    parts=[repel.Part("box", repel.Shape.box([0.04, 0.04, 0.04]))])
    wall = repel.Obstacle("wall", repel.Shape.box([0.1, 1.0, 1.0]), ([0.35, 0, 0], [1, 0, 0, 0]),
                          repel.ForceLaw(tilt=0.0))
    return Cell(rate_hz=1000.0, arms=[arm], obstacles=[wall], start_inside="allow", **options)


@pytest.mark.parametrize("options", [{"threads": 1}, {"threads": 1, "mode": "beside"}])
def test_threads_say_the_same(options):
    """A worker beside the tick gets a processor when it gets one: until then the cell says what
    it was told last, and fifty ticks may be over before. So it is asked until it has come."""
    at = np.array([0.22, 0.0, 0.0]), np.zeros(3)
    alone, other = cell_of(), cell_of(**options)
    for _ in range(200):
        expected = alone.step(*at, repel.Command())
    assert -0.0075 < expected.nearest < -0.005
    for _ in range(10_000):
        tick = other.step(*at, repel.Command())
        if tick.nearest == pytest.approx(expected.nearest, abs=2e-5):
            return
        time.sleep(0.001)
    pytest.fail(f"{tick.nearest} m, not {expected.nearest} m")


@pytest.mark.parametrize("measure, error", [("exact", 1e-12), ("reduction", 1e-3)])
def test_a_cell_measures_overlaps_as_it_is_told(measure, error):
    """The box is 10 mm deep in the wall."""
    tick = cell_of(measure=measure).step(np.array([0.22, 0.0, 0.0]), np.zeros(3), repel.Command())
    assert tick.nearest == pytest.approx(-0.01, abs=error)


@pytest.mark.parametrize("options, said", [
    ({"measure": "guess"}, "measure is 'guess'; allowed"),
    ({"threads": -1}, "threads is -1; allowed: 0 to 64"),
    ({"mode": "behind"}, "mode is 'behind'; allowed: together, beside"),
])
def test_what_cannot_be_is_refused(options, said):
    with pytest.raises(repel.SetupError, match=said):
        cell_of(**options)
