# SPDX-License-Identifier: BSD-3-Clause
"""Worlds and cells that are described in Python."""

import gc
import math
import pathlib
import resource
import subprocess
import sys
import weakref

import numpy as np
import pytest

import repel
from gantry import Gantry, gantry_cell

EYE = np.eye(4)


def moved(x, y, z):
    X = np.eye(4)
    X[:3, 3] = x, y, z
    return X


def test_a_world_answers_for_its_pairs():
    world = repel.World()
    table = world.add_part(0, "table", repel.Shape.box([0.6, 0.4, 0.02]))
    post = world.add_part(0, "post", repel.Shape.cylinder(0.05, 0.5), moved(2, 0, 0))
    body = world.add_body("tool", moved(0.1, 0, 0.125))
    fingers = [world.add_part(body, f"finger {i}", repel.Shape.sphere(0.1), moved(0.3 * i, 0, 0))
               for i in range(2)]
    law = repel.ForceLaw(range=0.02, surface_force=100.0)
    assert world.add_pairs(fingers, [table, post], law) == 4
    assert (world.body_count, world.part_count, world.pair_count) == (2, 4, 4)
    near = {each["a"]: each for each in world.near()}
    assert set(near) == {"finger 0", "finger 1"} and near["finger 0"]["b"] == "table"
    assert near["finger 0"]["separation"].distance == pytest.approx(0.005)
    assert near["finger 0"]["force"] == pytest.approx(law(0.005))
    push = world.force_on(body)
    assert push[2] == pytest.approx(2 * law(0.005))
    assert push[4] == pytest.approx(-0.3 * law(0.005))  # about the origin of the body
    np.testing.assert_allclose(world.force_on(0)[:3], -push[:3])
    world.place(body, moved(0.1, 0, 1.0))
    assert not world.force_on(body).any()
    world.place(body, moved(0.1, 0, 0.125), [0, 0, -0.1, 0, 0, 0])
    assert world.force_on(body)[2] > push[2]  # the damper resists the approach
    with pytest.raises(repel.SetupError, match="the world has been evaluated"):
        world.add_body("late")


@pytest.mark.parametrize("wrong, kind, words", [
    (lambda w: w.add_part(5, "part", repel.Shape.sphere(1)), repel.SetupError, "no such body"),
    (lambda w: w.add_pair(0, 7, repel.ForceLaw()), repel.SetupError, "does not exist"),
    (lambda w: w.add_body("b", np.full((4, 4), np.nan)), repel.SetupError, "X_WB: an entry"),
    (lambda w: w.place(0, EYE), repel.SetupError, "body is 0; allowed: 1 to"),
    (lambda w: w.place(1, EYE, np.zeros(3)), ValueError, "V_WB: expected six numbers"),
    (lambda w: w.place(1, EYE, np.full(6, np.nan)), repel.SetupError, "V_WB: an entry"),
    (lambda w: w.force_on(2), repel.SetupError, "body is 2"),
    (lambda w: repel.World(measure="none"), repel.SetupError, "measure is 'none'"),
    (lambda w: w.add_pairs([0.5], [1], repel.ForceLaw()), TypeError, "group_a: expected the numb"),
    (lambda w: repel.World(limits=5), TypeError, "limits: expected a repel.Capacities, got int"),
    (lambda w: repel.World(limits=repel.Capacities(bodies="x")), TypeError,
     "bodies: expected a whole number, got str"),
])
def test_a_world_refuses_by_name(wrong, kind, words):
    world = repel.World()
    body = world.add_body("body")
    world.add_part(body, "part", repel.Shape.sphere(1))
    with pytest.raises(kind, match=words):
        wrong(world)


def driven(cell, ticks, speed=0.1):
    """The records of a gantry that is driven towards the wall, and where it is after each."""
    q, v = np.zeros(3), np.zeros(3)
    command = repel.Command(linear=[speed, 0, 0])
    for k in range(ticks):
        tick = cell.step(q, v, command, (k + 1) * 1_000_000)
        pull = tick.torques - 300.0 * v - [0, 0, 4.0 * 9.81]
        v = v + 0.001 / 4.0 * pull
        q = q + 0.001 * v
        yield tick, q


def test_an_own_controller_stops_before_the_wall():
    ticks, places = zip(*driven(gantry_cell(), 4001))
    # 03_own_controller of C++ is the same cell: these are the lines that it prints.
    said = [f"x {places[k][0]:.3f} m, wall {ticks[k].peak_force:.1f} N"
            for k in range(0, 4001, 500)]
    assert said == [f"x {x:.3f} m, wall {force:.1f} N" for x, force in
                    [(0.0, 0.0), (0.022, 0.0), (0.065, 0.0), (0.113, 0.0), (0.162, 0.0),
                     (0.194, 46.4), (0.197, 71.4), (0.197, 71.9), (0.197, 71.9)]]
    last = ticks[-1]
    assert last.stop == "running" and last.status == ("saturated",)  # the hand pushes on
    assert last.hardest_pair == "ball - wall" and 0.0 < last.nearest < 0.02
    assert last.torques.shape == (3,) and last.virtual_force.shape == (6,)
    assert last.virtual_force[0] == pytest.approx(-last.peak_force)
    assert last.time == pytest.approx(4.0)
    record = last.as_dict()
    assert set(record) == set(repel.Tick.FIELDS) and record["stop"] == "running"
    assert set(record["energy"]) >= {"spaceball", "kbb2", "obstacle"}
    assert ticks[0].q[0] < ticks[1000].q[0]  # records are copies, not the last one


def test_a_command_keeps_all_that_hands_do():
    command = repel.Command(linear=[1, 2, 3], guides=5, guide_strength=0.5, scale=2.0,
                            second_angular=[0, 0, 0.5], second_compliant=3)
    assert list(command.linear) == [1, 2, 3] and command.guides == 5
    assert command.guide_strength == 0.5 and command.scale == 2.0
    assert list(command.second_angular) == [0, 0, 0.5] and command.second_compliant == 3
    assert list(command.direction_W) == [1, 0, 0] and command.second_guides == -1
    with pytest.raises(TypeError, match="no argument 'liner'.*linear"):
        repel.Command(liner=[1, 2, 3])
    with pytest.raises(TypeError, match="scale"):
        repel.Command(scale="large")


def test_two_halves_make_a_tick():
    whole, halves = gantry_cell(), gantry_cell()
    q, v = np.array([0.1, 0, 0]), np.zeros(3)
    command = repel.Command(linear=[0.1, 0, 0])
    for _ in range(20):
        tick = whole.step(q, v, command)
        halves.sense([(q, v)])
        (same,) = halves.act([command])
        assert same.torques.tobytes() == tick.torques.tobytes() and same.time == tick.time
    np.testing.assert_array_equal(halves.X_WT(), moved(0.1, 0, 0))
    assert halves.period == 0.001 and halves.arm_count == 1 and halves.pairs == ["ball - wall"]
    with pytest.raises(repel.SetupError, match="act comes after sense"):
        halves.act([command])
    with pytest.raises(ValueError, match="commands: expected 1"):
        halves.sense([(q, v)])
        halves.act([])
    with pytest.raises(ValueError, match=r"readings: expected 1, one for each arm, got 2"):
        halves.sense([(q, v), (q, v)])


def test_faults_are_in_the_record_not_errors():
    cell = gantry_cell()
    rest = repel.Command()
    for _ in range(10):
        cell.step(np.zeros(3), np.zeros(3), rest)
    tick = cell.step(np.full(3, np.nan), np.zeros(3), rest)
    assert "bad_joints" in tick.status and tick.stop == "braking"
    assert np.isfinite(tick.torques).all()
    tick = gantry_cell().step(np.zeros(3), np.zeros(3), repel.Command(linear=[math.nan, 0, 0]))
    assert "bad_command" in tick.status
    tick = gantry_cell().step(np.zeros(3), np.zeros(3), repel.Command(silent_for=1.0))
    assert "silent_device" in tick.status
    with pytest.raises(ValueError, match=r"q: expected a number for each joint \(N,\), got"):
        cell.step(np.zeros((3, 1)), np.zeros(3), rest)


class Broken(Gantry):
    def __init__(self):
        super().__init__()
        self.breaks = False

    def tool_jacobian(self):
        if self.breaks:
            raise ArithmeticError("no Jacobian today")
        return super().tool_jacobian()


def test_errors_of_own_kinematics_come_out_of_the_tick():
    kinematics = Broken()
    cell = gantry_cell(kinematics)
    cell.step(np.zeros(3), np.zeros(3), repel.Command())
    kinematics.breaks = True
    with pytest.raises(ArithmeticError, match="no Jacobian today"):
        cell.step(np.zeros(3), np.zeros(3), repel.Command())
    kinematics.breaks = False
    tick = cell.step(np.zeros(3), np.zeros(3), repel.Command())
    assert np.isfinite(tick.torques).all()
    kinematics.breaks = True
    with pytest.raises(ArithmeticError, match="no Jacobian today"):
        gantry_cell(kinematics)


def test_a_cell_takes_one_call_at_a_time():
    class Eager(Gantry):
        cell = None

        def X_WT(self):
            if self.cell is not None:
                self.cell.step(np.zeros(3), np.zeros(3), repel.Command())
            return super().X_WT()

    eager = Eager()
    cell = gantry_cell(eager)
    eager.cell = cell
    with pytest.raises(RuntimeError, match="allowed is one call at a time"):
        cell.step(np.zeros(3), np.zeros(3), repel.Command())
    eager.cell = None
    assert cell.step(np.zeros(3), np.zeros(3), repel.Command()).torques.shape == (3,)


def test_kinematics_that_are_none_are_refused_by_name():
    class Flat(Gantry):
        def tool_jacobian(self):
            return np.zeros((3, 3))

    with pytest.raises(ValueError, match=r"tool_jacobian: expected an array \(6, 3\), got .*3, 3"):
        gantry_cell(Flat())
    with pytest.raises(TypeError, match="kinematics: it has no update"):
        gantry_cell(object())


@pytest.mark.parametrize("change, words", [
    ({"start": [2.0, 0, 0]}, "robot start: 2 m for"),
    ({"start": [0.0, 0]}, "2 joints; allowed: 3"),
    ({"links": []}, "it has no joint"),
    ({"tool_speed": 100.0}, "tool speed is 100"),
])
def test_cells_that_cannot_be_are_refused(change, words):
    with pytest.raises(repel.SetupError, match=words):
        gantry_cell(**change)


@pytest.mark.parametrize("change, words", [
    ({"arms": [None]}, r"arms\[0\]: expected a repel.Arm, got NoneType"),
    ({"arms": 5}, "arms: expected a sequence of repel.Arm, got int"),
    ({"obstacles": [None]}, r"obstacles\[0\]: expected a repel.Obstacle, got NoneType"),
    ({"obstacles": [repel.Obstacle("o", None)]}, "shape: expected a Shape, got NoneType"),
    ({"loose": [repel.Loose("o", repel.Shape.sphere(1.0), mass="1")]}, "mass: expected a number"),
])
def test_what_no_cell_is_made_of_is_refused_by_name(change, words):
    with pytest.raises(TypeError, match=words):
        repel.Cell(rate_hz=1000.0, **{"arms": [], **change})


def test_links_alone_make_kinematics():
    if not hasattr(repel, "SimulatedArm"):
        pytest.skip("built without robots")
    turn = repel.Link("turn", axis_J=(0, 0, 1), mass=2.0, p_LC=(0.25, 0, 0), lower=-3, upper=3,
                      I_C_L=np.eye(3) * 0.05, effort_limit=50.0, velocity_limit=2.0)
    bend = repel.Link("bend", X_PJ=moved(0.5, 0, 0), axis_J=(0, 1, 0), mass=1.0, lower=-3, upper=3,
                      p_LC=(0.25, 0, 0), I_C_L=np.eye(3) * 0.02, effort_limit=50.0,
                      velocity_limit=2.0)
    arm = repel.Arm([turn, bend], X_LT=moved(0.5, 0, 0),
                    parts=[repel.Part("tip", repel.Shape.sphere(0.02)),
                           repel.Part("forearm", repel.Shape.capsule(0.03, 0.2), link=1)])
    cell = repel.Cell(rate_hz=1000.0, arms=[arm])
    assert cell.joints() == ["turn", "bend"]
    tick = cell.step([0, 0], [0, 0], repel.Command())
    np.testing.assert_allclose(cell.X_WT(), moved(1.0, 0, 0), atol=1e-12)
    assert tick.torques[1] == pytest.approx(-0.25 * 9.81, abs=1e-3)
    plant = repel.SimulatedArm(cell)
    for _ in range(100):
        tick = cell.step(plant.q, plant.v, repel.Command())
        plant.apply(tick)
        plant.step(cell.period)
    assert np.abs(plant.q).max() < 1e-3  # the torques hold it


class Holder(Gantry):
    """Kinematics that keep their own cell: a circle for the collector."""

    def __init__(self):
        super().__init__()
        self.cell = gantry_cell(self)


def test_circles_through_a_cell_are_collected():
    holder = Holder()
    gone = weakref.ref(holder)
    holder.cell.step(np.zeros(3), np.zeros(3), repel.Command())
    del holder
    gc.collect()
    assert gone() is None


@pytest.mark.parametrize("beside", [
    lambda cell: repel.LiveView(cell, port=0),
    lambda cell: repel.DepthCamera(cell, width=4, height=3, fx=3, fy=3, cx=1.5, cy=1.0),
])
def test_circles_through_what_is_beside_a_cell_are_collected(beside):
    if not hasattr(repel, "LiveView") or not hasattr(repel, "DepthCamera"):
        pytest.skip("built without views or cameras")
    kinematics = Gantry()
    kinematics.beside = beside(gantry_cell(kinematics))
    gone = weakref.ref(kinematics)
    gc.collect()
    assert gone() is not None
    del kinematics
    gc.collect()
    assert gone() is None


def resident():
    """[kB] of this process."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize() // 1024


def use_everything():
    problem = [repel.Shape.hull(np.random.default_rng(1).normal(size=(200, 3))) for _ in range(10)]
    rows = repel.separations(problem, np.stack([EYE] * 10), [[0, 1]] * 100)
    world = repel.World()
    body = world.add_body("body")
    a, b = world.add_part(body, "a", problem[0]), world.add_part(0, "b", problem[1])
    world.add_pair(a, b, repel.ForceLaw())
    world.near()
    cell = gantry_cell()
    ticks = [cell.step(np.zeros(3), np.zeros(3), repel.Command()) for _ in range(3)]
    for wrong in (np.eye(3), "no", np.full((4, 4), np.nan)):
        with pytest.raises((ValueError, TypeError)):
            repel.separation(problem[0], wrong, problem[1], EYE)
    return rows, ticks


def test_nothing_leaks():
    for _ in range(20):
        use_everything()
    gc.collect()
    before, objects = resident(), len(gc.get_objects())
    for _ in range(100):
        use_everything()
    gc.collect()
    # Each round makes megabytes; a leak of one of ten would show.
    assert resident() - before < 8000
    assert len(gc.get_objects()) - objects < 200


def test_the_module_leaves_nothing_behind_at_the_end():
    code = "import world_test; world_test.use_everything(); world_test.Holder()"
    done = subprocess.run([sys.executable, "-c", code], cwd=pathlib.Path(__file__).parent,
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0 and done.stderr == ""  # nanobind says what was left
