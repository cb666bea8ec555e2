# SPDX-License-Identifier: BSD-3-Clause
"""A cell in the loop of a MuJoCo simulation."""

import importlib
import warnings

import numpy as np
import pytest

import repel
from problem import ROOT

mujoco = pytest.importorskip("mujoco", reason="the package mujoco is not installed")
importlib.import_module("repel.mujoco")

ARM = (ROOT / "examples/python/05_mujoco.xml").read_text()
FORTH = repel.Command(linear=[0.1, 0, 0])


def made(text=ARM):
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    return model, data


def attached(text=ARM, **options):
    return repel.mujoco.attach(*made(text), site="tool", **options)


def with_geom(more, after="<worldbody>"):
    return ARM.replace(after, after + more, 1)


def test_an_arm_is_driven_against_a_wall_and_does_not_touch_it():
    sim = attached()
    assert sim.cell.joints() == [f"joint {i}" for i in range(1, 8)]
    assert [wall.name for wall in sim.obstacles] == ["table", "post", "rail", "ball", "wedge"]
    assert sim.left_out == ["foot"] and sim.cell.period == pytest.approx(0.001)
    ticks = []
    for _ in range(2000):
        ticks.append(sim.step(FORTH))
        assert sim.data.ncon == 0
    assert sim.data.time == pytest.approx(2.0)
    assert ticks[-1].hardest_pair == "part 7 - wedge" and ticks[-1].peak_force > 10.0
    assert {tick.stop for tick in ticks} == {"running"}
    np.testing.assert_array_equal(sim.data.qfrc_applied, ticks[-1].torques)
    np.testing.assert_allclose(sim.cell.X_WT()[:3, 3], sim.data.site("tool").xpos, atol=1e-12)


def test_a_tick_does_not_move_the_simulation():
    sim = attached()
    before = sim.data.qpos.copy()
    sim.tick(FORTH)
    assert sim.data.time == 0.0 and np.array_equal(sim.data.qpos, before)
    assert sim.data.qfrc_applied.any()
    other = attached()
    other.step(FORTH)
    mujoco.mj_step(sim.model, sim.data)
    np.testing.assert_array_equal(sim.data.qpos, other.data.qpos)


def test_a_period_is_of_whole_timesteps():
    sim = attached(rate_hz=250.0)
    sim.step()
    assert sim.data.time == pytest.approx(0.004)
    for wrong in (300.0, 2000.0):
        with pytest.raises(repel.SetupError, match=f"rate_hz is {wrong:g}, with a timestep of "
                                                   "0.001 s; allowed: whole timesteps"):
            attached(rate_hz=wrong)


def test_joints_of_the_arm_stand_among_others():
    """A free body before the arm, and joints of the arm that do not follow one another."""
    text = """<mujoco><option timestep="0.001"/><worldbody>
        <body pos="5 0 0" name="stone"><freejoint/><geom name="stone" size="0.1"/></body>
        <body name="arm"><joint name="a" type="slide" axis="1 0 0" armature="1"/>
          <geom name="carriage" size="0.1"/>
          <body name="flap" pos="0 0 1"><joint name="b"/><geom size="0.05" pos="0 0.2 0"/></body>
          <body name="head" pos="0 0 -1"><joint name="c" type="slide" axis="0 1 0" armature="1"/>
            <geom name="head" size="0.1"/><site name="tool"/></body></body></worldbody></mujoco>"""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    with pytest.warns(UserWarning, match="move without the arm, and are no obstacles: stone"):
        sim = repel.mujoco.attach(model, data, site="tool")
    assert sim.left_out == ["stone"] and sim.cell.joints() == ["a", "c"]
    data.qpos[[7, 9]] = 0.01, 0.02
    tick = sim.tick()
    assert list(tick.q) == [0.01, 0.02]
    assert list(data.qfrc_applied[[6, 8]]) == list(tick.torques)
    assert not data.qfrc_applied[[0, 1, 2, 3, 4, 5, 7]].any()


def test_geoms_become_obstacles_as_they_are():
    text = with_geom("<geom name='floor' type='plane' size='0 0 1' pos='0 0 -0.2' "
                     "euler='10 0 0'/><geom type='sphere' size='1' contype='0' conaffinity='0'/>"
                     "<body name='shelf' pos='0 2 0'><geom size='0.1 0.1 0.1' type='box'/></body>")
    sim = attached(text, leave_out=["ball"], law=repel.ForceLaw(range=0.03))
    walls = {wall.name: wall for wall in sim.obstacles}
    assert set(walls) == {"floor", "table", "post", "rail", "wedge", "shelf/geom 7"}
    assert {wall.law.range for wall in sim.obstacles} == {0.03}
    mujoco.mj_forward(sim.model, sim.data)
    sphere, X = repel.Shape.sphere(0.01), np.eye(4)
    X[:3, 3] = 0.3, 0.4, 1.0
    floor = sim.data.geom("floor")
    height = (X[:3, 3] - floor.xpos) @ floor.xmat.reshape(3, 3)[:, 2]
    found = repel.separation(sphere, X, walls["floor"].shape, walls["floor"].X_WP)
    assert found.distance == pytest.approx(height - 0.01, abs=1e-9)


def test_nothing_that_carries_the_arm_is_forgotten_but_its_base():
    text = ARM.replace("<body name=\"base\">",
                       "<body name='pedestal'><geom name='plate' type='box' size='1 1 0.01' "
                       "pos='0 0 -0.5'/><body name='base'>").replace(
                           "</worldbody>", "</body></worldbody>")
    sim = attached(text)
    assert "plate" in [wall.name for wall in sim.obstacles] and sim.left_out == ["foot"]


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize("where", ["qpos", "qvel"])
def test_readings_that_are_not_finite_are_a_fault(where, value):
    sim = attached()
    for _ in range(10):
        sim.step(FORTH)
    getattr(sim.data, where)[2] = value
    tick = sim.tick(FORTH)
    assert tick.status and np.isfinite(sim.data.qfrc_applied).all()
    for _ in range(100):
        getattr(sim.data, where)[2] = value
        tick = sim.tick(FORTH)
    assert tick.stop != "running"


@pytest.mark.parametrize("name", ["geom_size", "body_pos", "geom_quat", "body_mass", "jnt_axis"])
def test_a_model_that_changes_under_the_cell_is_named(name):
    sim = attached()
    sim.step()
    getattr(sim.model, name)[2] *= 1.5
    with pytest.raises(repel.SetupError, match=f"{name} of the model has changed; allowed: to "
                                               "attach again"):
        sim.step()


def test_another_timestep_is_named():
    sim = attached()
    sim.model.opt.timestep = 0.002
    with pytest.raises(repel.SetupError, match="opt.timestep of the model has changed"):
        sim.step()


FINGERS = """<body name="left" pos="0 0 0.12"><joint name="left" type="slide" axis="0 1 0"
    range="0 0.04"/><geom name="left" type="box" size="0.005 0.005 0.02"/></body>
  <body name="right" pos="0 0 0.12"><joint name="right" type="slide" axis="0 -1 0" range="0 0.04"/>
    <geom name="right" type="box" size="0.005 0.005 0.02"/></body>"""
GRIP = """<equality><joint name="couple" joint1="left" joint2="right"/></equality>
  <tendon><fixed name="grip"><joint joint="left" coef="0.5"/><joint joint="right" coef="0.5"/></fixed>
  </tendon><actuator><position name="grip" tendon="grip" kp="100"/></actuator>"""
#: The arm with a gripper of two fingers, 0.01 m from shut.
GRIPPER = with_geom(FINGERS, after='<site name="tool" pos="0 0 0.12"/>').replace(
    "0.9 0\"", "0.9 0 0.01 0.01\"").replace("<keyframe>", GRIP + "<keyframe>")


def test_an_arm_with_a_gripper_is_driven_against_a_wall_and_does_not_touch_it():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim = attached(GRIPPER)
    assert sim.cell.joints() == [f"joint {i}" for i in range(1, 8)] and sim.left_out == ["foot"]
    parts = {part.name: part for part in sim.arm.parts}
    assert parts["left"].link == parts["right"].link == 6
    np.testing.assert_allclose(parts["left"].X_FP[:3, 3], [0, 0.01, 0.12], atol=1e-12)
    np.testing.assert_allclose(parts["right"].X_FP[:3, 3], [0, -0.01, 0.12], atol=1e-12)
    sim.data.ctrl[:] = 0.01
    ticks = []
    for _ in range(2000):
        ticks.append(sim.step(FORTH))
        touched = {sim.model.geom(i).name for i in sim.data.contact.geom.ravel()}
        assert touched <= {"left", "right", "part 7"}
    assert {tick.stop for tick in ticks} == {"running"} and ticks[-1].peak_force > 10.0


def test_what_acts_on_the_arm_in_the_simulation_is_refused_by_name():
    couple = "<equality><joint name='e' joint1='joint 2' joint2='joint 4' active='{}'/></equality>"
    text = ARM.replace("<keyframe>", couple.format("false") + "<keyframe>")
    model, data = made(text)
    assert repel.mujoco.attach(model, data, site="tool")
    data.eq_active[0] = 1
    with pytest.raises(repel.SetupError, match="'e' is an equality constraint, which acts on joint "
                                               "'joint 2' of the arm"):
        repel.mujoco.attach(model, data, site="tool")
    servo = GRIPPER.replace("joint=\"left\" coef", "joint=\"joint 7\" coef")
    with pytest.raises(repel.SetupError, match="actuator 'grip' pulls on joint 'joint 7' by "
                                               "itself.*allowed: motors"):
        attached(servo)


def test_one_of_two_fingers_is_driven():
    rest = GRIP.replace("<position", "<motor").replace(" kp=\"100\"", "")
    finger = FINGERS.replace("<joint ", "<joint damping='5' ").replace("0.02\"/>",
                                                                     "0.02\" density='1e5'/>")
    text = (f"<mujoco><option timestep='0.001' gravity='0 0 0'/><worldbody>"
            f"<body name='palm'>{finger}</body></worldbody>{{}}</mujoco>")
    model = mujoco.MjModel.from_xml_string(text.format(rest))
    with pytest.warns(UserWarning, match="move without the arm, and are no obstacles: right"):
        sim = repel.mujoco.attach(model, mujoco.MjData(model), site="left")
    assert sim.cell.joints() == ["left"]
    for _ in range(300):
        tick = sim.step(repel.Command(linear=[0, 0.02, 0]))
    assert tick.stop == "running"
    assert sim.data.qpos[0] > 0.002 and sim.data.qpos[1] == pytest.approx(sim.data.qpos[0], abs=1e-4)
    model = mujoco.MjModel.from_xml_string(text.format(GRIP))
    with pytest.raises(repel.SetupError, match="actuator 'grip' pulls on joint 'left' by itself"):
        repel.mujoco.attach(model, mujoco.MjData(model), site="left")


SERVO = "<actuator><position name='servo' joint='joint 3' kp='10' group='2'/></actuator>"


def test_servos_that_would_pull_against_the_cell_are_refused():
    text = ARM.replace("<keyframe>", SERVO + "<keyframe>")
    with pytest.raises(repel.SetupError, match="actuator 'servo' pulls on joint 'joint 3' by "
                                               "itself.*allowed: motors"):
        attached(text)
    assert attached(text.replace("<option ", "<option actuatorgroupdisable='2' "))
    assert attached(text.replace("<position", "<motor").replace("kp='10'", "gear='10'"))
    model, data = made(text)
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_ACTUATION
    assert repel.mujoco.attach(model, data, site="tool")


def test_what_cannot_be_attached_is_named():
    model, data = made()
    with pytest.raises(repel.SetupError, match="site is 'tol'; allowed: 'tool', the name of a body"):
        repel.mujoco.attach(model, data, site="tol")
    with pytest.raises(TypeError, match="data: expected a mujoco.MjData, got MjModel"):
        repel.mujoco.attach(model, model, site="tool")
    other = mujoco.MjModel.from_xml_string("<mujoco><worldbody><body><joint/><geom size='1'/>"
                                           "</body></worldbody></mujoco>")
    with pytest.raises(ValueError, match="qpos: expected 7 numbers, got shape"):
        repel.mujoco.attach(model, mujoco.MjData(other), site="tool")
    hill = with_geom("<geom name='hill' type='hfield' hfield='hill'/>").replace(
        "<asset>", "<asset><hfield name='hill' nrow='2' ncol='2' size='1 1 1 1'/>")
    with pytest.raises(repel.SetupError, match="geom 'hill' is of type hfield; allowed: .*mesh"):
        attached(hill)
    assert attached(hill, leave_out=["hill"])
    inside = with_geom("<geom name='block' size='0.1' pos='0.67 0 0.4'/>")
    with pytest.raises(repel.SetupError, match="starts inside 'block'"):
        attached(inside)
    assert "starts inside 'block'" in attached(inside, start_inside="push_out").cell.warnings[0]


#: A wall on a mocap body before the tool, and a ball that falls beside the arm.
MOVING = """<body name="door" mocap="true" pos="0.85 0 0.4"><geom name="door" type="box"
    size="0.02 0.3 0.3"/></body><body name="ball" pos="-1 0 1"><freejoint/><geom name="falling"
    size="0.05"/></body>"""


def moving(**options):
    return attached(with_geom(MOVING).replace('qpos="', 'mpos="0.85 0 0.4" qpos="-1 0 1 1 0 0 0 '),
                    **options)


def to_the_door(sim):
    """[m] from the arm, along x."""
    kinematics = repel.ArmKinematics(sim.arm)
    kinematics.update(sim.data.qpos[7:])
    door = sim.followed[0]
    return min(repel.separation(part.shape, kinematics.X_WL(part.link) @ part.X_FP, door.shape,
                                door.X_WP).distance for part in sim.arm.parts)


def shifted(sim, by, after=0.001):
    """A tick with the door moved along x [m], a time [s] after the last."""
    sim.data.mocap_pos[0, 0] += by
    sim.data.time += after
    return sim.tick()


def test_geoms_that_move_are_followed_where_they_are():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim = moving(follow=True)
    assert [part.name for part in sim.followed] == ["door", "falling"] and sim.left_out == ["foot"]
    sim.tick()
    start = sim.cell.X_WT()[0, 3]
    for _ in range(600):
        sim.data.mocap_pos[0, 0] -= 0.0003  # 0.3 m/s towards the arm
        tick = sim.step()
        seen = sim.cell.loose
        for name in ("door", "falling"):
            part = sim.data.geom(name)
            # mj_step has moved the ball on by a step of at most its speed.
            np.testing.assert_allclose(seen[name]["X_WP"][:3, 3], part.xpos, atol=0.01)
        assert sim.data.ncon == 0 and tick.stop == "running"
    assert tick.hardest_pair.endswith(" - door") and tick.peak_force > 1.0
    assert sim.cell.X_WT()[0, 3] < start - 0.02  # it was pushed away
    assert seen["falling"]["X_WP"][2, 3] == pytest.approx(1 - 0.5 * 9.81 * 0.6 ** 2, abs=0.01)


def test_the_velocity_of_a_followed_geom_is_that_of_its_way():
    """A wall that comes nearer is resisted by its damping. What jumps counts as at rest."""
    pushes = {}
    for speed in (0.0, 0.2, 50.0):
        sim = moving(follow=["door"], leave_out=["falling"])
        shifted(sim, 0.01 + 0.001 * speed - to_the_door(sim), after=1.0)
        pushes[speed] = shifted(sim, -0.001 * speed).peak_force
    assert pushes[0.2] > pushes[0.0] + 1.0 > 2.0
    assert pushes[50.0] == pytest.approx(pushes[0.0], rel=1e-6)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_followed_geom_that_is_nowhere_is_named(value):
    sim = moving(follow=True)
    sim.step()
    sim.data.mocap_pos[0, 1] = value
    with pytest.raises(repel.SetupError, match="'door' has a pose that is not finite"):
        sim.step()
    sim.data.mocap_pos[0, 1] = 0.0
    assert sim.step().stop == "running"


def test_what_is_not_followed_is_warned_of_and_what_does_not_move_is_refused():
    with pytest.warns(UserWarning, match="move without the arm, and are no obstacles: falling$"):
        sim = moving(follow=["door"])
    assert sim.left_out == ["falling", "foot"]
    for wrong in ("table", "part 7", "nothing"):
        with pytest.raises(repel.SetupError, match=f"follow: no geom that moves without the arm is "
                                                   f"called '{wrong}'; allowed: door, falling"):
            moving(follow=[wrong])
    with pytest.raises(repel.SetupError, match="allowed: none, the model has no such geom"):
        attached(follow=["table"])
    with pytest.raises(repel.SetupError, match="loose"):
        moving(follow=True, limits=repel.Capacities(loose=1))


def test_a_followed_geom_can_be_gripped():
    """Held, it is where the tool has it, and does not push the arm."""
    sim = moving(follow=["door"], leave_out=["falling", "table", "post", "rail", "ball",
                                               "wedge"])
    sim.cell.attach("door", over=0.01)
    for _ in range(30):
        sim.step()
    held = sim.cell.loose["door"]
    assert held["holder"] == 0
    tick = shifted(sim, -to_the_door(sim))
    np.testing.assert_allclose(sim.cell.loose["door"]["X_WP"], held["X_WP"], atol=5e-3)
    assert tick.peak_force == 0.0
    sim.cell.release("door", over=0.01)
    for _ in range(30):
        tick = shifted(sim, 0.0)
    np.testing.assert_allclose(sim.cell.loose["door"]["X_WP"], sim.followed[0].X_WP
                               @ [[1, 0, 0, -to_the_door(sim)], [0, 1, 0, 0], [0, 0, 1, 0],
                                  [0, 0, 0, 1]], atol=1e-3)
    assert tick.peak_force > 1.0


def test_a_plane_on_a_mocap_body_is_followed():
    text = with_geom("<body name='plate' mocap='true' pos='0 0 -0.5'><geom name='plate' "
                     "type='plane' size='1 1 1'/></body>").replace("<key ", "<key mpos='0 0 -0.5' ")
    sim = attached(text, follow=True)
    X_WP = sim.followed[0].X_WP
    found = repel.separation(repel.Shape.sphere(0.1), ([5, 5, 0], [1, 0, 0, 0]),
                             sim.followed[0].shape, X_WP)
    assert found.distance == pytest.approx(0.4, abs=1e-12)


def test_nothing_is_warned_of_a_plain_model():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        attached()
