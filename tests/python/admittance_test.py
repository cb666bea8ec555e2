# SPDX-License-Identifier: BSD-3-Clause
"""An arm that takes positions or rates."""

import numpy as np
import pytest

import repel
from gantry import Gantry, gantry_cell

SHOWN = repel.Admittance(response=0.01, inertia=[4.0, 4.0, 4.0])
HAND = repel.Command(linear=[0.1, 0.0, 0.0])


def test_rails_follow_positions_to_a_wall_and_no_further():
    cell = gantry_cell(admittance=SHOWN)
    q, v = np.zeros(3), np.zeros(3)
    for _ in range(5000):
        tick = cell.step(q, v, HAND)
        assert tick.positions.shape == tick.rates.shape == (3,)
        way = (1.0 - np.exp(-cell.period / 0.01)) * (tick.positions - q)
        q, v = q + way, way / cell.period
    assert 0.15 < q[0] < 0.2  # the wall begins there
    assert np.abs(v).max() < 1e-3
    assert q[2] == pytest.approx(0.0, abs=1e-3)  # an arm with positions holds its own weight


def test_both_halves_of_a_tick_command_the_same():
    whole, halves = gantry_cell(admittance=SHOWN), gantry_cell(admittance=SHOWN)
    q, v = np.zeros(3), np.zeros(3)
    for _ in range(100):
        expected = whole.step(q, v, HAND)
        halves.sense([(q, v)])
        (tick,) = halves.act([HAND])
        assert (tick.positions == expected.positions).all()
        assert (tick.rates == expected.rates).all()
        q, v = tick.positions, tick.rates
    assert q[0] > 0.0


def test_without_it_there_is_no_motion_to_send():
    tick = gantry_cell().step(np.zeros(3), np.zeros(3), HAND)
    assert tick.positions is None and tick.rates is None


class Broken(Gantry):
    def mass_matrix(self):
        raise RuntimeError("no masses here")


@pytest.mark.parametrize("change, error, said", [
    ({"admittance": repel.Admittance(response=0.2)}, repel.SetupError,
     "admittance response at 1000 Hz is 0.2 s; allowed: 0 to 0.1"),
    ({"admittance": repel.Admittance(inertia=[1.0])}, repel.SetupError,
     "admittance of 1 joints for an arm of 3"),
    ({"admittance": repel.Admittance(), "kinematics": Broken()}, RuntimeError, "no masses here"),
])
def test_what_cannot_be_is_refused(change, error, said):
    with pytest.raises(error, match=said):
        gantry_cell(**change)
