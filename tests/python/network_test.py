# SPDX-License-Identifier: BSD-3-Clause
"""Networks of chosen modules."""

import numpy as np
import pytest

import repel
from gantry import gantry_cell

pytestmark = pytest.mark.skipif("scenes" in repel._left_out.PACKAGES,
                                reason="the build lacks the part of scenes")

MASTER = [{"module": "torque_arm"}, {"module": "multiplex"}, {"module": "spaceball"}]
COUPLED = [*MASTER, {"module": "kbb2"}, {"module": "obstacle"}, {"module": "puma_kin"},
           {"module": "puma_joints"}]
ASIDE = repel.Command(linear=[0.05, 0.02, 0.0])


def driven(network, command, ticks=2000):
    """Where the tool is after so many ticks, by torques on 4 kg with 300 N s/m."""
    cell = gantry_cell(network=network)
    q, v = np.zeros(3), np.zeros(3)
    for _ in range(ticks):
        tick = cell.step(q, v, command)
        push = tick.torques - [0.0, 0.0, 4.0 * 9.81]
        v = (4.0 * v + cell.period * push) / (4.0 + cell.period * 300.0)
        q = q + cell.period * v
    return q, tick


def test_modules_are_those_of_the_list():
    q, tick = driven(COUPLED, ASIDE)
    assert [name for name in tick.energy if name != "prediction"] == [
        each["module"] for each in COUPLED]
    assert 0.05 < q[0] < 0.11 and q[1] == pytest.approx(0.4 * q[0], abs=0.01)


def test_a_coupling_may_be_softer_and_named():
    soft = [dict(each) for each in COUPLED]
    soft[3] = {"module": "kbb2", "name": "soft", "stiffness": "500 N/m", "damping": "100 N s/m",
               "force_limit": "5 N"}
    q, tick = driven(soft, ASIDE)
    assert "soft" in tick.energy
    assert 0.0 < q[0] < 0.05  # 5 N on 300 N s/m


def test_a_fixture_keeps_the_tool_on_its_path():
    path = {"name": "rail", "shape": "path", "points": ["0 0 0 m", "0.3 0 0 m"],
            "stiffness": "5 kN/m", "most_force": "100 N"}
    guided = [*COUPLED[:4], {"module": "guide", "fixtures": [path]}, *COUPLED[4:]]
    free, _ = driven(COUPLED, ASIDE)
    held, _ = driven(guided, ASIDE)
    assert held[0] > 0.5 * free[0]
    assert abs(held[1]) < 0.7 * free[1]  # the coupling pulls as well


def test_six_axes_are_driven_and_feel():
    network = [{"module": "six_axes"}, *COUPLED[3:]]
    q, _ = driven(network, repel.Command(linear=[0.0, 0.05, 0.0]))
    assert q[1] > 0.05


@pytest.mark.parametrize("network, error, said", [
    ([{"module": "no_such"}], repel.SetupError, "no_such"),
    ([{"module": "kbb2", "stiffnes": "1 N/m"}], repel.SetupError, "stiffnes"),
    ([{"module": "kbb2", "stiffness": 500}], repel.SetupError, "N/m"),
    ([], repel.SetupError, "no module"),
    ("kbb2", TypeError, "network: expected a sequence of dict"),
    (["kbb2"], TypeError, r"network\[0\]: expected a dict, got str"),
])
def test_what_cannot_be_is_refused(network, error, said):
    with pytest.raises(error, match=said):
        gantry_cell(network=network)


def test_a_force_sensor_is_read():
    sensor = {"module": "force_sensor", "gain": 0.5, "cutoff": "0 Hz"}
    network = [*COUPLED[:-1], sensor, COUPLED[-1]]
    cells = [gantry_cell(network=network) for _ in range(2)]
    torques = []
    for cell, wrench in zip(cells, (None, [20.0, 0.0, 0.0, 0.0, 0.0, 0.0])):
        for _ in range(20):
            tick = cell.step(np.zeros(3), np.zeros(3), repel.Command(), wrench=wrench)
        torques.append(tick.torques)
    assert torques[0][0] == 0.0 and torques[1][0] > 0.1
    with pytest.raises(ValueError, match="wrench"):
        cells[0].step(np.zeros(3), np.zeros(3), repel.Command(), wrench=[1.0])
