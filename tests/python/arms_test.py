# SPDX-License-Identifier: BSD-3-Clause
"""Arms from the models of others: they move, weigh and keep their distances as these do."""

import itertools
import pathlib
import sys

import numpy as np
import pytest

import repel
from problem import ROOT

PUMA = ROOT / "robots/puma560.urdf"
SEED = 20261128


def numbers(values):
    return " ".join(f"{each:.17g}" for each in np.ravel(values))


def kinematics_at(arm, q):
    kinematics = repel.ArmKinematics(arm)
    kinematics.update(q)
    return kinematics


def posed(p, R):
    X = np.eye(4)
    X[:3, :3], X[:3, 3] = np.reshape(R, (3, 3)), p
    return X


class RandomModel:
    """MJCF of an arm that has what arms of models have: several joints in a body, fixed bodies
    between, held joints beside the chain, anchors, references, tilted inertial frames."""

    def __init__(self, rng):
        self.rng, self.joints, self.geoms = rng, 0, 0
        body = self.body("<site name='tool' pos='0.1 0 0.05' quat='0.6 0 0.8 0'/>", 1)
        for _ in range(int(rng.integers(2, 6))):
            body = self.body(body + self.branch())
        self.text = f"""<mujoco><compiler angle="radian" autolimits="true"/>
            <option gravity="{numbers(rng.normal(size=3))}"/>
            <asset><mesh name="lump" vertex="{numbers(rng.normal(size=(20, 3)) * 0.05)}"/></asset>
            <worldbody><body pos="{self.place()}" quat="{self.turn()}">{body}</body></worldbody>
            </mujoco>"""

    def place(self):
        return numbers(self.rng.uniform(-0.5, 0.5, 3))

    def turn(self):
        return numbers(self.rng.normal(size=4))

    def joint(self):
        self.joints += 1
        kind = self.rng.choice(["hinge", "slide"], p=[0.7, 0.3])
        return (f"<joint name='joint {self.joints}' type='{kind}' pos='{self.place()}' "
                f"axis='{self.turn().rsplit(' ', 1)[0]}' ref='{self.rng.uniform(-1, 1)}' "
                f"armature='{self.rng.uniform(0, 0.2)}' damping='{self.rng.uniform(0, 2)}' "
                f"frictionloss='{self.rng.uniform(0, 1)}' range='-2 {self.rng.uniform(1, 2)}'/>")

    def geom(self):
        self.geoms += 1
        kind = self.rng.choice(["sphere", "capsule", "cylinder", "box", "ellipsoid", "mesh"])
        size = "mesh='lump'" if kind == "mesh" else f"size='{numbers(self.rng.uniform(.02, .1, 3))}'"
        return (f"<geom name='geom {self.geoms}' type='{kind}' {size} pos='{self.place()}' "
                f"quat='{self.turn()}'/><geom type='sphere' size='0.3' contype='0' "
                "conaffinity='0'/>")

    def body(self, inside, joints=None):
        joints = self.rng.integers(0, 3) if joints is None else joints
        inertia = self.rng.uniform(0.02, 0.04, 3)
        return (f"<body pos='{self.place()}' quat='{self.turn()}'>"
                f"<inertial mass='{self.rng.uniform(0.5, 5)}' pos='{self.place()}' "
                f"quat='{self.turn()}' diaginertia='{numbers(inertia)}'/>"
                + "".join(self.joint() for _ in range(joints)) + self.geom() + inside + "</body>")

    def branch(self):
        return self.body(self.body("", 0), int(self.rng.integers(0, 2)))


ARMS = range(20)


def random_pair(number):
    """A random arm in both, at a random configuration: (kinematics, arm, model, data, dofs)."""
    mujoco = pytest.importorskip("mujoco")
    rng = np.random.default_rng([SEED, number])
    print("seed", SEED, number)
    model = mujoco.MjModel.from_xml_string(RandomModel(rng).text)
    data = mujoco.MjData(model)
    data.qpos[:] = rng.uniform(-2, 2, model.nq)
    mujoco.mj_forward(model, data)
    arm = repel.Arm.from_mujoco(model, "tool", qpos=data.qpos)
    dofs = [model.joint(link.name).dofadr[0] for link in arm.links]
    return kinematics_at(arm, data.qpos[dofs]), arm, model, data, dofs


@pytest.fixture(params=ARMS)
def pair(request):
    return random_pair(request.param)


def test_an_arm_moves_as_in_mujoco(pair):
    import mujoco
    kinematics, arm, model, data, dofs = pair
    site = posed(data.site("tool").xpos, data.site("tool").xmat)
    np.testing.assert_allclose(kinematics.X_WT(), site, rtol=0, atol=1e-12)
    J = np.zeros((6, model.nv))
    mujoco.mj_jacSite(model, data, J[:3], J[3:], model.site("tool").id)
    np.testing.assert_allclose(kinematics.tool_jacobian(), J[:, dofs], rtol=0, atol=1e-12)
    assert kinematics.joints == len(dofs) == len(arm.links)
    assert list(arm.start) == list(data.qpos[dofs])
    for part in arm.parts:
        geom = data.geom(part.name)
        np.testing.assert_allclose(kinematics.X_WL(part.link) @ part.X_FP,
                                   posed(geom.xpos, geom.xmat), rtol=0, atol=1e-12)
        point = np.array([0.1, 0.2, 0.3])
        mujoco.mj_jac(model, data, J[:3], J[3:], point, model.geom(part.name).bodyid[0])
        np.testing.assert_allclose(kinematics.jacobian(part.link, point), J[:, dofs], atol=1e-12)


def test_an_arm_weighs_as_in_mujoco(pair):
    import mujoco
    kinematics, arm, model, data, dofs = pair
    M, unit = np.zeros((model.nv, model.nv)), np.eye(model.nv)
    for i in range(model.nv):
        mujoco.mj_mulM(model, data, M[i], unit[i])
    np.testing.assert_allclose(kinematics.mass_matrix(), M[np.ix_(dofs, dofs)], atol=1e-9)
    np.testing.assert_allclose(kinematics.gravity_torques(), data.qfrc_bias[dofs], atol=1e-9)
    for link, dof in zip(arm.links, dofs):
        joint = model.joint(link.name)
        assert [link.lower, link.upper] == list(joint.range)
        assert link.viscous_friction == model.dof_damping[dof]
        assert link.coulomb_friction == model.dof_frictionloss[dof]
        assert link.rotor_inertia == model.dof_armature[dof]


def test_parts_are_as_far_apart_as_in_mujoco():
    mujoco = pytest.importorskip("mujoco", minversion="4", reason="3.2.7 is off by millimetres")
    apart = 0
    for kinematics, arm, model, data, _ in map(random_pair, ARMS):
        model.opt.ccd_tolerance, model.opt.ccd_iterations = 1e-12, 1000
        for a, b in itertools.combinations(arm.parts, 2):
            ours = repel.separation(a.shape, kinematics.X_WL(a.link) @ a.X_FP,
                                    b.shape, kinematics.X_WL(b.link) @ b.X_FP).distance
            if ours > 1e-3:
                ids = model.geom(a.name).id, model.geom(b.name).id
                theirs = mujoco.mj_geomDistance(model, data, *ids, 10.0, None)
                assert ours == pytest.approx(theirs, rel=0, abs=1e-9), (a.name, b.name)
                apart += 1
    assert apart > 200


def of_mjcf(inside, site="tool", options="", **change):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(f"<mujoco>{options}<worldbody>{inside}</worldbody>"
                                           "</mujoco>")
    return repel.Arm.from_mujoco(model, site, **change)


ONE = """<body name="arm"><joint name="hinge" {joint}/><geom name="ball" size="0.1" {geom}/>
         <body name="finger"><joint name="claw" {claw}/><geom name="tip" size="0.1" pos="1 0 0"/>
         </body><site name="tool"/></body><site name="still"/>"""


def one(joint="", geom="", claw="type='slide'"):
    return ONE.format(joint=joint, geom=geom, claw=claw)


@pytest.mark.parametrize("model, site, words", [
    (one(), "tol", "site is 'tol'; allowed: 'still', 'tool', the name of a body"),
    ("<site name='still'/>", "still", "site 'still' stands still in the world; allowed"),
    (one(), "world", "site 'world' stands still in the world; allowed"),
    (one("type='ball'"), "tool", "joint 'hinge' is of type ball; allowed: hinge, slide"),
    (one(claw="type='ball'"), "tool", "joint 'claw' is of type ball; allowed: hinge, slide"),
    (one("type='free'"), "tool", "joint 'hinge' is of type free; allowed"),
    (one("stiffness='5'"), "tool", "joint 'hinge' has a spring of stiffness 5; allowed: 0"),
    (f"<body mocap='true' name='hand'>{one()}</body>", "tool", "body 'hand' is a mocap body"),
    (f"<body gravcomp='1'>{one()}<joint axis='1 0 0'/><geom size='1'/></body>", "tool",
     "gravcomp of the bodies of the arm is 0, 1; allowed: the same"),
])
def test_what_no_arm_can_have_is_named(model, site, words):
    with pytest.raises(repel.SetupError, match=words):
        of_mjcf(model, site)


COUPLE = "<equality><joint name='couple' joint1='claw' joint2='thumb'/></equality>"

#: Two joints, and two fingers on the last body.
HAND = """<body name="upper"><joint name="a" axis="0 1 0"/><geom name="ball" size="0.1"/>
  <body name="lower" pos="0 0 0.3"><joint name="b"/><geom size="0.1"/><site name="wrist"/>
    <body name="claw"><joint name="claw" type="slide" axis="0 1 0"/><geom name="claw" size="0.1"/>
      <site name="nail"/></body>
    <body name="thumb"><joint name="thumb" type="slide" axis="0 -1 0" stiffness="5"/>
      <geom name="thumb" size="0.1"/></body></body></body>"""


def hand(rest, site="wrist", **change):
    return of_mjcf(HAND, site, rest + "<actuator><motor joint='a' ctrlrange='-9 9'/><motor "
                   "joint='b' ctrlrange='-9 9'/></actuator>", **change)


def tendon(joints, more=""):
    pulled = "".join(f"<joint joint='{joint}' coef='0.5'/>" for joint in joints.split())
    return (f"<tendon><fixed name='t' {more}>{pulled}</fixed></tendon>"
            "<actuator><motor tendon='t' ctrlrange='-3 3'/></actuator>")


@pytest.mark.parametrize("rest", [
    "", COUPLE, COUPLE + tendon("claw thumb"),
    tendon("claw thumb", "stiffness='3' damping='1' frictionloss='1' range='0 1'"),
    "<equality><joint joint1='a' joint2='b' active='false'/></equality>",
    "<equality><connect body1='claw' body2='thumb' anchor='0 0 0'/>"
    "<weld body1='claw' body2='lower'/><weld site1='nail' site2='wrist'/></equality>",
])
def test_what_acts_on_held_fingers_alone_does_not_matter(rest):
    arm = hand(rest, qpos=[0, 0, 0.1, 0.2])
    assert [link.name for link in arm.links] == ["a", "b"]
    assert [link.effort_limit for link in arm.links] == [9.0, 9.0]
    parts = {part.name: part for part in arm.parts}
    for finger, y in ("claw", 0.1), ("thumb", -0.2):
        assert parts[finger].link == 1
        assert list(parts[finger].X_FP[:3, 3]) == pytest.approx([0, y, 0])


@pytest.mark.parametrize("rest, words", [
    ("<equality><joint name='e' joint1='a' joint2='b'/></equality>",
     "'e' is an equality constraint, which acts on joint 'a' of the arm; allowed: one of held"),
    ("<equality><joint name='e' joint1='b'/></equality>", "acts on joint 'b' of the arm"),
    ("<equality><joint joint1='a' joint2='claw'/></equality>", "acts on joint 'a' of the arm"),
    ("<equality><weld name='w' body1='claw'/></equality>", "'w' is an equality constraint"),
    ("<equality><connect site1='nail' site2='still'/></equality>", "acts on joint 'a'"),
    (tendon("b claw", "stiffness='1'"), "'t' is a tendon with a spring, which acts on joint 'b'"),
    (tendon("b", "damping='1'"), "'t' is a tendon with damping"),
    (tendon("b", "frictionloss='1'"), "'t' is a tendon with dry friction"),
    (tendon("b", "range='0 1'"), "'t' is a tendon with limits"),
    ("<equality><tendon name='e' tendon1='t'/></equality>" + tendon("b"), "'e' is an equality"),
])
def test_what_acts_on_the_arm_is_named(rest, words, tmp_path):
    with pytest.raises(repel.SetupError, match=words):
        hand("<worldbody><site name='still'/></worldbody>" + rest)
    (tmp_path / "arm.xml").write_text(f"<mujoco>{rest}<worldbody><site name='still'/>{HAND}"
                                      "</worldbody></mujoco>")
    with pytest.raises(repel.SetupError, match=f"arm.xml: .*{words}") as told:
        repel.Arm.from_mjcf(tmp_path / "arm.xml", "wrist")
    assert told.value.file == str(tmp_path / "arm.xml")


def test_a_motor_on_a_tendon_makes_the_effort_of_its_joints_unknown():
    assert [link.effort_limit for link in hand(tendon("b claw")).links] == [9.0, 0.0]
    across = ("<worldbody><site name='still' pos='0 1 0'/></worldbody><tendon><spatial name='s'>"
              "<site site='still'/><site site='wrist'/></spatial></tendon>"
              "<actuator><motor tendon='s'/></actuator>")
    assert [link.effort_limit for link in hand(across).links] == [0.0, 0.0]
    within = across.replace("still", "nail").replace("<worldbody><site name='nail' pos='0 1 0'/>",
                                                     "<worldbody>")
    assert [link.effort_limit for link in hand(within).links] == [9.0, 9.0]
    around = within.replace("<site site='wrist'/>", "<geom geom='ball'/><site site='wrist'/>")
    assert [link.effort_limit for link in hand(around).links] == [9.0, 0.0]


def test_one_finger_is_an_arm_and_the_other_follows():
    arm = hand(COUPLE + tendon("claw thumb"), "nail")
    assert [link.name for link in arm.links] == ["a", "b", "claw"]
    assert {part.name: part.link for part in arm.parts}["thumb"] == 1
    with pytest.raises(repel.SetupError, match="joint 'thumb' has a spring of stiffness 5"):
        hand("", "thumb")


def test_the_tool_frame_may_be_that_of_a_body():
    arm = hand("", "claw")
    assert [link.name for link in arm.links] == ["a", "b", "claw"]
    np.testing.assert_array_equal(kinematics_at(arm, [0, 0, 0.1]).X_WT()[:3, 3], [0, 0.1, 0.3])


def test_a_geom_without_a_shape_is_named(monkeypatch):
    pytest.importorskip("mujoco")
    from repel import _mujoco_arm
    monkeypatch.delitem(_mujoco_arm._SIZES, "sphere")
    with pytest.raises(repel.SetupError, match="geom 'ball' is of type sphere; allowed: capsule, "
                                               "cylinder, box, ellipsoid, mesh, or contype"):
        of_mjcf(one())
    assert of_mjcf(one(), leave_out=["ball", "tip"]).parts == []
    flat = one(geom="type='ellipsoid'").replace('size="0.1"', 'size="1 1 1e-7"', 1)
    with pytest.raises(repel.SetupError, match="geom 'ball': "):
        of_mjcf(flat)


def test_what_is_asked_for_wrongly_is_named(monkeypatch, tmp_path):
    mujoco = pytest.importorskip("mujoco")
    with pytest.raises(TypeError, match="model: expected a mujoco.MjModel, got str"):
        repel.Arm.from_mujoco("arm.xml", "tool")
    with pytest.raises(ValueError, match="qpos: expected 2 numbers, got shape"):
        of_mjcf(one(), qpos=[1.0])
    with pytest.raises(repel.SetupError, match="leave_out: no geom is called 'bal'"):
        of_mjcf(one(), leave_out=["bal"])
    with pytest.raises(repel.SetupError, match="arm.xml"):
        repel.Arm.from_mjcf(tmp_path / "arm.xml", "tool")
    (tmp_path / "arm.xml").write_text(f"<mujoco><worldbody>{one()}</worldbody></mujoco>")
    assert repel.Arm.from_mjcf(tmp_path / "arm.xml", "tool", name="own").name == "own"
    assert mujoco is sys.modules["mujoco"]


def test_without_mujoco_it_says_how_to_have_it(monkeypatch):
    for name in ("mujoco", "pinocchio"):
        monkeypatch.setitem(sys.modules, name, None)
        monkeypatch.delitem(sys.modules, f"repel._{name}_arm", raising=False)
        monkeypatch.delattr(repel, f"_{name}_arm", raising=False)
    with pytest.raises(repel.SetupError, match=r"pip install mujoco, .*repel-haptics\[mujoco\]"):
        repel.Arm.from_mujoco(None, "tool")
    with pytest.raises(repel.SetupError, match=r"pip install pin, .*repel-haptics\[pinocchio\]"):
        repel.Arm.from_pinocchio(None, "tool")


def test_efforts_are_those_of_joints_and_actuators():
    mujoco = pytest.importorskip("mujoco")
    text = """<mujoco><worldbody><body><joint name="a"/><geom size="0.1"/>
        <body><joint name="b" actuatorfrcrange="-4 4"/><geom size="0.1"/>
        <body><joint name="c"/><geom size="0.1"/><site name="tool"/></body></body></body></worldbody>
        <actuator><motor joint="a" gear="3" ctrlrange="-2 2"/>
        <general joint="b" forcerange="-7 7"/><motor joint="c"/></actuator></mujoco>"""
    arm = repel.Arm.from_mujoco(mujoco.MjModel.from_xml_string(text), "tool")
    assert [link.effort_limit for link in arm.links] == [6.0, 4.0, 0.0]
    assert [link.upper for link in arm.links] == [np.inf] * 3


def test_what_actuators_add_is_seen_at_the_joint():
    pytest.importorskip("mujoco", minversion="4", reason="3 has no armature in actuators")
    text = """<worldbody><body><joint name="a" armature="0.3" damping="1"/><geom size="0.1"/>
        <site name="tool"/></body></worldbody><actuator><motor joint="a" gear="3" armature="2"
        damping="0.5"/></actuator><worldbody>"""
    link = of_mjcf(f"</worldbody>{text}").links[0]
    assert link.rotor_inertia == pytest.approx(18.3)
    assert link.viscous_friction == pytest.approx(5.5)


def test_gravity_that_the_model_compensates_is_not_held():
    heavy = of_mjcf(one())
    light = of_mjcf(one().replace("<body ", "<body gravcomp='0.75' "))
    assert list(heavy.gravity_W) == [0, 0, -9.81]
    assert light.gravity_W == pytest.approx([0, 0, -9.81 / 4])
    none = of_mjcf(one(), options="<option><flag gravity='disable'/></option>")
    assert not none.gravity_W.any()


needs_robots = pytest.mark.skipif(not hasattr(repel._repel, "_read_urdf"),
                                  reason="built without robots")


@needs_robots
@pytest.mark.skipif(not hasattr(repel, "load_scene"), reason="built without scenes")
def test_the_arm_of_a_urdf_file_is_that_of_its_scene():
    rng = np.random.default_rng(SEED)
    scene = repel.load_scene("anderson_4x8")
    arm = repel.Arm.from_urdf(scene.robot)
    tools = []  # that of the scene in the tip of the file
    for _ in range(10):
        q = rng.uniform(-1, 1, len(arm.links))
        cell = repel.Cell.from_scene(scene)  # another one: a joint that jumps is not believed
        assert [link.name for link in arm.links] == cell.joints()
        cell.sense([(q, 0 * q)])
        tools.append(np.linalg.inv(kinematics_at(arm, q).X_WT()) @ cell.X_WT())
    np.testing.assert_allclose(tools, [tools[0]] * 10, atol=1e-12)


@needs_robots
def test_a_urdf_file_gives_parts_as_asked_for():
    collision = repel.Arm.from_urdf(PUMA)
    assert len(collision.parts) > 3
    assert all(0 <= part.link < len(collision.links) for part in collision.parts)
    assert repel.Arm.from_urdf(PUMA, parts=None).parts == []
    visual = repel.Arm.from_urdf(str(PUMA), parts="visual", start=np.full(6, 0.1))
    assert len(visual.parts) > 3 and list(visual.start) == [0.1] * 6
    middle = repel.Arm.from_urdf(PUMA, tip=collision.links[2].name.replace("joint", "link"))
    assert len(middle.links) == 3
    cell = repel.Cell(rate_hz=400.0, arms=[collision])
    assert cell.joints() == [link.name for link in collision.links]


@needs_robots
@pytest.mark.parametrize("options, words", [
    ({"tip": "nothing"}, "nothing"), ({"parts": "all"}, "parts is 'all'; allowed: collision"),
])
def test_a_urdf_file_is_refused_by_name(options, words):
    with pytest.raises(repel.SetupError, match=words):
        repel.Arm.from_urdf(PUMA, **options)
    with pytest.raises(repel.SetupError, match="none.urdf"):
        repel.Arm.from_urdf(pathlib.Path("none.urdf"))


@needs_robots
@pytest.mark.parametrize("file", ["puma560.urdf", "puma560_armstrong.urdf", "long_reach.urdf"])
def test_a_urdf_file_weighs_as_in_pinocchio(file):
    pinocchio = pytest.importorskip("pinocchio")
    rng = np.random.default_rng(SEED)
    read = repel.Arm.from_urdf(ROOT / "robots" / file)
    model = pinocchio.buildModelFromUrdf(str(ROOT / "robots" / file))
    tool = [f.name for f in model.frames if f.type == pinocchio.FrameType.BODY][-1]
    arm = repel.Arm.from_pinocchio(model, tool)
    for link, other in zip(arm.links, read.links):
        link.rotor_inertia = other.rotor_inertia  # not in the standard: Pinocchio reads none
    for _ in range(10):
        q = rng.uniform(-1, 1, model.nq)
        ours, theirs = kinematics_at(read, q), kinematics_at(arm, q)
        np.testing.assert_allclose(ours.mass_matrix(), theirs.mass_matrix(), atol=1e-9)
        np.testing.assert_allclose(ours.gravity_torques(), theirs.gravity_torques(), atol=1e-9)
        np.testing.assert_allclose(ours.X_WL(2)[:3, :3], theirs.X_WL(2)[:3, :3], atol=1e-9)


def test_an_arm_weighs_as_in_pinocchio():
    pinocchio = pytest.importorskip("pinocchio")
    rng = np.random.default_rng(SEED)
    model = pinocchio.buildSampleModelManipulator()
    model.armature = rng.uniform(0, 1, model.nv)
    data = model.createData()
    frame = model.frames[model.nframes - 1].name
    arm = repel.Arm.from_pinocchio(model, frame)
    for _ in range(10):
        q = rng.uniform(-3, 3, model.nq)
        kinematics = kinematics_at(arm, q)
        M = pinocchio.crba(model, data, q)
        M = np.triu(M) + np.triu(M, 1).T
        np.testing.assert_allclose(kinematics.mass_matrix(), M, atol=1e-9)
        weight = pinocchio.computeGeneralizedGravity(model, data, q)
        np.testing.assert_allclose(kinematics.gravity_torques(), weight, atol=1e-9)
        pinocchio.framesForwardKinematics(model, data, q)
        np.testing.assert_allclose(kinematics.X_WT(),
                                   data.oMf[model.getFrameId(frame)].homogeneous, atol=1e-12)


def test_joints_beside_the_chain_of_a_pinocchio_model_are_held():
    pinocchio = pytest.importorskip("pinocchio")
    model = pinocchio.buildSampleModelManipulator()
    frame = model.names[3]
    q = np.linspace(0.1, 0.6, model.nq)
    arm = repel.Arm.from_pinocchio(model, frame, q=q)
    assert [link.name for link in arm.links] == list(model.names)[1:4]
    data = model.createData()
    weight = pinocchio.computeGeneralizedGravity(model, data, q)[:3]
    np.testing.assert_allclose(kinematics_at(arm, q[:3]).gravity_torques(), weight, atol=1e-9)
    with pytest.raises(repel.SetupError, match="frame is 'nothing'; allowed: universe"):
        repel.Arm.from_pinocchio(model, "nothing")
    with pytest.raises(repel.SetupError, match="frame 'universe' stands still"):
        repel.Arm.from_pinocchio(model, "universe")
    model.addJoint(3, pinocchio.JointModelSpherical(), pinocchio.SE3.Identity(), "wrist")
    model.addJointFrame(model.njoints - 1)
    with pytest.raises(repel.SetupError, match="joint 'wrist' is of type JointModelSpherical"):
        repel.Arm.from_pinocchio(model, "wrist")


def test_kinematics_name_what_they_refuse():
    arm = repel.Arm([repel.Link("one"), repel.Link("two", X_PJ=([1, 0, 0], [1, 0, 0, 0]), mass=2)])
    kinematics = repel.ArmKinematics(arm)
    kinematics.update([np.pi / 2, 0])
    np.testing.assert_allclose(kinematics.X_WL(1)[:3, 3], [0, 1, 0], atol=1e-15)
    np.testing.assert_allclose(kinematics.jacobian(0, [0, 1, 0])[:, 0], [-1, 0, 0, 0, 0, 1])
    with pytest.raises(ValueError, match="q: expected 2 numbers, one for each joint, got 3"):
        kinematics.update(np.zeros(3))
    for wrong in (-2, 2):
        with pytest.raises(repel.SetupError, match=f"link is {wrong}; allowed: -1 to 1"):
            kinematics.X_WL(wrong)
    with pytest.raises(repel.SetupError, match="has no link"):
        repel.ArmKinematics(repel.Arm([]))
    kinematics.update([np.nan, 0])
    assert np.isnan(kinematics.X_WT()[0, 3])
    arm.links[0].rotor_inertia = arm.links[1].rotor_inertia = 1.0
    own = repel.Arm(arm.links, kinematics=repel.ArmKinematics(arm))  # it is a repel.Kinematics
    assert repel.Cell(rate_hz=1000.0, arms=[own]).joints() == ["one", "two"]
