// SPDX-License-Identifier: BSD-3-Clause
// Arms from MJCF files, compared with MuJoCo itself, and what is refused.
#include <repel/robots/mjcf.hpp>

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/robots/describe_arm.hpp>
#include <repel/robots/dynamics.hpp>

#ifdef REPEL_TESTS_MJCF
#include <mujoco/mujoco.h>
#endif

#include "end_to_end/folder.hpp"

namespace repel {
namespace mjcf_test {

using test::Folder;

std::string complaint(const std::string& path, const MjcfOptions& options = {}) {
  try {
    (void)load_mjcf_arm(path, options);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "accepted";
}

bool says(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

std::string mjcf_of(const std::string& bodies, const std::string& rest = "") {
  return "<mujoco model=\"test\">\n<compiler angle=\"radian\"/>\n<worldbody>\n" + bodies +
         "</worldbody>\n" + rest + "</mujoco>\n";
}

#ifndef REPEL_TESTS_MJCF
TEST(Mjcf, WithoutMujocoTheErrorSaysWhatWouldBringIt) {
  const std::string text = complaint("arm.xml");
  EXPECT_TRUE(says(text, "apt-get install libmujoco-dev")) << text;
  EXPECT_FALSE(reads_mjcf());
}
#else

/// Joints beside their bodies, with references and armatures, two of them in one body, a slide, a
/// fixed body with a mass, and a site at its end.
const std::string arm_bodies = R"(
<geom type="plane" size="1 1 1"/>
<body name="base" pos="0.1 -0.2 0.3" quat="0.9 0.1 -0.3 0.2">
  <geom name="foot" type="cylinder" size="0.1 0.2" mass="3"/>
  <body name="upper" pos="0.2 0.1 0.4" quat="0.7 -0.2 0.4 0.5">
    <inertial pos="0.05 -0.1 0.2" mass="4" fullinertia="0.3 0.25 0.2 0.01 -0.02 0.03"/>
    <joint name="yaw" axis="0.1 0.2 1" pos="0.03 -0.02 0.1" ref="0.4" armature="0.5"
           range="-3 2" limited="true" damping="1.5" frictionloss="0.7"/>
    <joint name="pitch" axis="0 1 0.3" pos="-0.1 0.02 0.2"/>
    <geom name="pill" type="capsule" size="0.05 0.2" pos="0 0 0.2" quat="0.5 0.5 -0.5 0.5"/>
    <geom name="seen" type="sphere" size="0.3" contype="0" conaffinity="0"/>
    <body name="rail" pos="0.1 0 0.5" quat="0.6 0.1 0.7 -0.2">
      <joint name="lift" type="slide" axis="1 0.2 -0.4" pos="0.3 0.1 0.2" ref="-0.2" armature="2"/>
      <geom type="box" size="0.1 0.05 0.2" pos="0.02 0.03 0.04" mass="2"/>
      <body name="hand" pos="0.2 -0.1 0.1" quat="0.3 0.2 0.8 0.4">
        <joint name="roll" axis="0 0 1" pos="0 0.01 0"/>
        <geom name="palm" type="mesh" mesh="wedge" mass="0.8"/>
        <body name="flange" pos="0.01 0.02 0.3" quat="0.2 0.9 0.1 0.3">
          <geom name="ball" type="sphere" size="0.04" mass="0.5"/>
          <site name="tip" pos="0.02 0.01 0.1" quat="0.8 0.1 0.5 0.2"/>
        </body>
        <body name="finger" pos="0 0.05 0.1">
          <joint name="squeeze" type="slide" axis="0 1 0" range="0.01 0.04" limited="true"/>
          <geom name="nail" type="box" size="0.01 0.01 0.03" mass="0.1"/>
        </body>
      </body>
    </body>
  </body>
</body>
)";
const std::string arm_rest = R"(
<option gravity="0.5 -1 -9"/>
<asset><mesh name="wedge" vertex="0 0 0  0.1 0 0  0 0.1 0  0.1 0.1 0  0 0 0.2  0.1 0 0.2
                                  0.03 0.03 0.05"/></asset>
<actuator><motor joint="yaw" gear="50" ctrlrange="-2 1" ctrllimited="true"/>
<position joint="pitch" kp="100" forcerange="-30 20" forcelimited="true"/></actuator>
)";

struct EndModel {
  void operator()(mjModel* ended) const { mj_deleteModel(ended); }
};
struct EndData {
  void operator()(mjData* ended) const { mj_deleteData(ended); }
};

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Pose pose_of(const mjtNum* p, const mjtNum* R) {
  Pose X = Pose::Identity();
  X.translation() = Eigen::Map<const Vec3>(p);
  X.linear() = Eigen::Map<const RowMajor>(R);
  return X;
}

double apart(const Pose& a, const Pose& b) {
  return std::max((a.translation() - b.translation()).norm(), (a.linear() - b.linear()).norm());
}

TEST(Mjcf, EllipsoidHasTheSemiAxesOfItsGeom) {
  const Folder folder;
  const std::string body =
      "<body name=\"b\"><joint name=\"j\"/>"
      "<geom name=\"e\" type=\"ellipsoid\" size=\"0.1 0.2 0.3\"/></body>";
  const Robot robot = load_mjcf_arm(folder.with("arm.xml", mjcf_of(body)));
  ASSERT_EQ(robot.parts.size(), 1U);
  EXPECT_EQ(robot.parts[0].kind, PartKind::ellipsoid);
  EXPECT_EQ(robot.parts[0].size, Vec3(0.1, 0.2, 0.3));
}

TEST(Mjcf, PosesInertiaAndBiasAreThoseOfMujoco) {
  const Folder folder;
  const std::string path = folder.with("arm.xml", mjcf_of(arm_bodies, arm_rest));
  const Robot robot = load_mjcf_arm(path, {.tip = "tip"});
  char message[1000] = "";
  const std::unique_ptr<mjModel, EndModel> model(
      mj_loadXML(path.c_str(), nullptr, message, sizeof message));
  ASSERT_TRUE(model) << message;
  const std::unique_ptr<mjData, EndData> data(mj_makeData(model.get()));
  const int n = 4;
  ASSERT_EQ(robot.arm.links.size(), std::size_t{n});
  ASSERT_EQ(model->nv, n + 1);  // the finger is held
  ASSERT_EQ(robot.held.size(), 1U);
  Kinematics kinematics(robot.arm);
  Dynamics dynamics(robot.arm);
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> any(-2.0, 2.0);
  for (int trial = 0; trial < 100; ++trial) {
    std::vector<double> q(n), v(n);
    for (double& value : q) value = any(generator);
    for (double& value : v) value = any(generator);
    std::copy(q.begin(), q.end(), data->qpos);
    std::copy(v.begin(), v.end(), data->qvel);
    data->qpos[n] = robot.held[0].position;
    data->qvel[n] = 0.0;
    mj_forward(model.get(), data.get());
    kinematics.update(q);
    const int site = mj_name2id(model.get(), mjOBJ_SITE, "tip");
    EXPECT_LT(
        apart(kinematics.X_WT(), pose_of(data->site_xpos + 3 * site, data->site_xmat + 9 * site)),
        1e-12);
    for (const RobotLink& link : robot.links) {
      const int body = mj_name2id(model.get(), mjOBJ_BODY, link.name.c_str());
      const Pose X_WL = link.link < 0 ? Pose::Identity() : kinematics.X_WL(link.link);
      EXPECT_LT(apart(X_WL * link.X_LN, pose_of(data->xpos + 3 * body, data->xmat + 9 * body)),
                1e-12)
          << link.name;
    }
    Eigen::MatrixXd M(n, n), all(n + 1, n + 1);
    dynamics.inertia(q, M);
    mj_fullM(model.get(), all.data(), data->qM);
    EXPECT_LT((M - all.topLeftCorner(n, n)).norm(), 1e-9 * all.norm());
    std::vector<double> bias(n);
    dynamics.bias(q, v, bias);
    const Eigen::Map<const Eigen::VectorXd> here(bias.data(), n);
    const Eigen::Map<const Eigen::VectorXd> there(data->qfrc_bias, n);
    EXPECT_LT((here - there).norm(), 1e-9 * there.norm());
  }
}

TEST(Mjcf, PartsAndLimitsAreThoseOfTheFile) {
  const Folder folder;
  const std::string path = folder.with("arm.xml", mjcf_of(arm_bodies, arm_rest));
  const Robot robot = load_mjcf_arm(path, {.tip = "hand"});
  EXPECT_EQ(robot.arm.name, "test");
  EXPECT_EQ(robot.arm.gravity_W, Vec3(0.5, -1, -9));
  const ArmLink& yaw = robot.arm.links[0];
  EXPECT_EQ(yaw.name, "upper/yaw");
  EXPECT_EQ(yaw.mass, 0.0);
  EXPECT_EQ(robot.arm.links[1].name, "upper");
  EXPECT_EQ(robot.arm.links[1].mass, 4.0);
  EXPECT_EQ(yaw.lower, -3.0);
  EXPECT_EQ(yaw.upper, 2.0);
  EXPECT_EQ(yaw.viscous_friction, 1.5);
  EXPECT_EQ(yaw.coulomb_friction, 0.7);
  EXPECT_EQ(yaw.rotor_inertia, 0.5);
  EXPECT_EQ(yaw.effort_limit, 100.0);
  EXPECT_EQ(robot.arm.links[1].effort_limit, 30.0);
  EXPECT_EQ(robot.arm.links[2].effort_limit, 0.0) << "unknown";
  EXPECT_EQ(robot.held[0].position, 0.01);
  EXPECT_EQ(robot.held[0].type, "prismatic");
  std::string names;
  for (const RobotPart& part : robot.parts) {
    names += part.name + " " + to_text(part.kind) + " " + std::to_string(part.link) + "; ";
  }
  EXPECT_EQ(names,
            "foot cylinder -1; pill capsule 1; rail_0 box 2; palm hull 3; ball sphere 3; "
            "nail box 3; ");
  EXPECT_EQ(robot.parts[1].size, Vec3(0.05, 0.2, 0));
  EXPECT_EQ(robot.parts[3].points.size(), 6U) << "the corners of its hull";
  const ArmDescription arm = arm_from_mjcf(path, {.tip = "hand"});
  EXPECT_EQ(arm.parts.size(), 5U) << "without what stands with the base";
}

TEST(Mjcf, PartsStandWhereMujocoPutsThemWithTheWorldsToo) {
  const Folder folder;
  const std::string shelf =
      "<geom name=\"shelf\" type=\"box\" size=\"0.1 0.2 0.3\" pos=\"1 2 3\"/>"
      "<geom name=\"picture\" type=\"sphere\" size=\"1\" contype=\"0\" conaffinity=\"0\"/>"
      "<body name=\"ball\" pos=\"0 0 5\"><freejoint/><geom size=\"0.1\"/></body>";
  std::string bodies = arm_bodies;
  bodies.replace(0, bodies.find("<body"), shelf);
  const std::string path = folder.with("arm.xml", mjcf_of(bodies, arm_rest));
  const std::vector<RobotPart> parts = load_mjcf_parts(path);
  char message[1000] = "";
  const std::unique_ptr<mjModel, EndModel> model(
      mj_loadXML(path.c_str(), nullptr, message, sizeof message));
  ASSERT_TRUE(model) << message;
  const std::unique_ptr<mjData, EndData> data(mj_makeData(model.get()));
  mj_kinematics(model.get(), data.get());
  int touching = 0;
  for (int i = 0; i < model->ngeom; ++i) touching += model->geom_contype[i] != 0 ? 1 : 0;
  EXPECT_LT(touching, model->ngeom);
  ASSERT_EQ(parts.size(), static_cast<std::size_t>(touching));
  EXPECT_EQ(parts[0].in_link, "world");
  for (const RobotPart& part : parts) {
    const int geom = mj_name2id(model.get(), mjOBJ_GEOM, part.name.c_str());
    const int shown =
        geom >= 0 ? geom
                  : model->body_geomadr[mj_name2id(model.get(), mjOBJ_BODY, part.in_link.c_str())];
    EXPECT_LT(apart(part.X_LP, pose_of(data->geom_xpos + 3 * shown, data->geom_xmat + 9 * shown)),
              1e-9)
        << part.name;
  }
  const std::string floor = folder.with("floor.xml", mjcf_of(arm_bodies, arm_rest));
  try {
    (void)load_mjcf_parts(floor);
    ADD_FAILURE() << "accepted";
  } catch (const SetupError& error) {
    EXPECT_TRUE(says(error.what(), "a plane, which has no end")) << error.what();
  }
}

TEST(Mjcf, AHeldJointStandsWhereItIsHeld) {
  const Folder folder;
  const std::string path = folder.with("arm.xml", mjcf_of(arm_bodies, arm_rest));
  const Robot robot = load_mjcf_arm(path, {"tip", {{"lift", 0.1, JointType::prismatic}}});
  EXPECT_EQ(robot.arm.links.size(), 3U);
  const auto held = [&](const Hold& hold) { return complaint(path, {"tip", {hold}}); };
  EXPECT_TRUE(says(held({"lift", 0.1, JointType::revolute}), "allowed: a length"));
  EXPECT_TRUE(says(held({"yaw", 2.5}), "allowed: -3 to 2 rad"));
  EXPECT_TRUE(says(held("nowhere"), "no joint 'nowhere'"));
}

TEST(Mjcf, WhatIsNoSerialArmIsRefusedByName) {
  const Folder folder;
  const auto of = [&](const std::string& text) { return complaint(folder.with("m.xml", text)); };
  const auto link = [](const std::string& joint, const std::string& more = "") {
    return "<body name=\"b\">" + joint + "<geom name=\"g\" size=\"0.1\"/>" + more + "</body>\n";
  };
  const std::string hinge = "<joint name=\"j\"/>";
  EXPECT_EQ(of(mjcf_of(link(hinge))), "accepted");
  const struct {
    std::string text, words;
  } cases[] = {
      {mjcf_of(link("<freejoint name=\"j\"/>")),
       "joint 'j' is a free joint; allowed: hinge, slide"},
      {mjcf_of(link("<joint name=\"j\" type=\"ball\"/>")), "joint 'j' is a ball joint"},
      {mjcf_of(link("<joint name=\"j\" stiffness=\"3\"/>")),
       "joint 'j' has a spring, stiffness 3; allowed: 0, or a joint that is held"},
      {mjcf_of(link("")), "no joint moves"},
      {mjcf_of(link(hinge), "<equality><joint name=\"e\" joint1=\"j\"/></equality>"),
       "'e' is an equality constraint, which acts on joint 'j' of the arm; allowed: one of held"},
      {mjcf_of(link(hinge), "<equality><weld name=\"w\" body1=\"b\"/></equality>"),
       "'w' is an equality constraint, which acts on joint 'j'"},
      {mjcf_of(link(hinge), "<option density=\"1.2\"/>"), "density"},
      {mjcf_of(link(hinge) + "<body name=\"m\" mocap=\"true\"/>"), "body 'm' is a mocap body"},
      {mjcf_of("<body name=\"base\"><geom name=\"p\" type=\"plane\" size=\"1 1 1\"/>" +
               link(hinge) + "</body>"),
       "geom 'p' of body 'base' is a plane"},
      {mjcf_of(link(hinge) + "<body name=\"c\"><joint/><geom size=\"1\"/></body>"),
       "bodies 'b' and 'c' move on branches of their own"},
      {mjcf_of(link("<joint name=\"j\" colour=\"3\"/>")),
       "m.xml:4: MuJoCo refuses the file: XML Error: Schema violation: unrecognized attribute: "
       "'colour'"},
      {"<mujoco><worldbody>", "m.xml:1"},
      {"<robot name=\"r\"/>", "begins with <robot>; allowed: <mujoco>; this is URDF"},
  };
  for (const auto& each : cases) {
    const std::string text = of(each.text);
    EXPECT_TRUE(says(text, each.words)) << each.words << "\n" << text;
    EXPECT_TRUE(says(text, "m.xml")) << text;
  }
  const std::string path = folder.with("m.xml", mjcf_of(link(hinge)));
  EXPECT_TRUE(says(complaint(path, {.tip = "nowhere"}), "no body or site 'nowhere'"));
  EXPECT_TRUE(says(complaint(folder / "none.xml"), "none.xml: cannot be opened"));
  EXPECT_TRUE(says(complaint(""), "the name of the file is empty"));
  try {
    (void)load_arm(path);
    FAIL() << "nothing was thrown";
  } catch (const SetupError& error) {
    EXPECT_TRUE(says(error.what(), "this is MJCF")) << error.what();
  }
}

/// Two fingers on a palm, coupled as `rest` says.
const std::string fingers = R"(
<body name="palm" pos="0 0 0.1"><geom name="palm" size="0.03"/>
  <body name="left" pos="0 0 0.05">
    <joint name="left" type="slide" axis="0 1 0" range="0 0.04" limited="true" stiffness="2"/>
    <geom name="left" type="box" size="0.01 0.01 0.03"/>
  </body>
  <body name="right" pos="0 0 0.05">
    <joint name="right" type="slide" axis="0 -1 0" range="0 0.04" limited="true"/>
    <geom name="right" type="box" size="0.01 0.01 0.03"/>
  </body>
</body>
)";
const std::string coupled =
    "<equality><joint name=\"couple\" joint1=\"left\" joint2=\"right\"/></equality>\n";

/// A tendon of those joints, with further attributes, and a motor of 3 N on it.
std::string tendon_of(const std::vector<std::string>& joints, const std::string& more = "") {
  std::string text = "<tendon><fixed name=\"t\" " + more + ">";
  for (const std::string& joint : joints) text += "<joint joint=\"" + joint + "\" coef=\"0.5\"/>";
  return text +
         "</fixed></tendon>\n<actuator><motor tendon=\"t\" ctrlrange=\"-3 3\" "
         "ctrllimited=\"true\"/></actuator>\n";
}

/// Seven joints in one line, 1 to 7, each with a motor of 9 N m, and `inside` on the last body.
std::string seven_joints(const std::string& inside, const std::string& rest = "") {
  std::string bodies;
  std::string motors;
  for (int i = 1; i <= 7; ++i) {
    const std::string number = std::to_string(i);
    bodies += "<body name=\"link " + number + "\" pos=\"0 0 0.2\"><joint name=\"" + number +
              "\" axis=\"" + (i % 2 == 0 ? "0 1 0" : "0 0 1") +
              "\"/><geom type=\"capsule\" size=\"0.03 0.05\"/>";
    motors +=
        "<motor joint=\"" + number + "\" gear=\"9\" ctrlrange=\"-1 1\" ctrllimited=\"true\"/>";
  }
  bodies += inside;
  for (int i = 1; i <= 7; ++i) bodies += "</body>";
  return mjcf_of(bodies + "\n", "<actuator>" + motors + "</actuator>\n" + rest);
}

TEST(Mjcf, FingersThatAreTiedToOneAnotherAreHeldOnTheBodyThatCarriesThem) {
  const Folder folder;
  for (const std::string& ties :
       {coupled, coupled + tendon_of({"left", "right"}),
        tendon_of({"left", "right"},
                  "stiffness=\"3\" damping=\"1\" frictionloss=\"1\" "
                  "limited=\"true\" range=\"0 0.1\""),
        std::string("<equality><connect body1=\"left\" body2=\"right\" anchor=\"0 0 0\"/>"
                    "</equality>")}) {
    const Robot robot = load_mjcf_arm(folder.with("arm.xml", seven_joints(fingers, ties)));
    ASSERT_EQ(robot.arm.links.size(), 7U);
    for (const ArmLink& link : robot.arm.links) EXPECT_EQ(link.effort_limit, 9.0);
    EXPECT_EQ(robot.tool, "palm");
    EXPECT_EQ(robot.tool_reason, "the body that carries the fingers");
    ASSERT_EQ(robot.held.size(), 2U);
    EXPECT_EQ(robot.parts.back().name, "right");
    EXPECT_EQ(robot.parts.back().link, 6);
    EXPECT_NEAR(
        robot.arm.links[6].mass,
        robot.arm.links[5].mass + robot.links[8].mass + robot.links[9].mass + robot.links[10].mass,
        1e-9);
  }
}

TEST(Mjcf, AFingerThatIsCoupledWithAHeldOneIsHeldToo) {
  const Folder folder;
  const std::string path = folder.with("arm.xml", seven_joints(fingers, coupled));
  const Robot robot = load_mjcf_arm(path, {.hold = {{"right", 0.02}}});
  EXPECT_EQ(robot.arm.links.size(), 7U);
  ASSERT_EQ(robot.held.size(), 2U);
  EXPECT_EQ(robot.held[0].reason, "coupled with a held joint");
  EXPECT_EQ(robot.held[1].position, 0.02);
}

TEST(Mjcf, BranchesThatMayBeArmsAreRefusedByName) {
  const Folder folder;
  const auto of = [&](const std::string& text) { return complaint(folder.with("m.xml", text)); };
  const std::string words =
      "bodies 'left' and 'right' move on branches of their own; allowed: one "
      "line of joints, which may end in fingers that a constraint or tendon "
      "ties to one another, or a chosen tip";
  EXPECT_TRUE(says(of(seven_joints(fingers)), words)) << "not tied";
  EXPECT_TRUE(says(of(mjcf_of(fingers, coupled)), words)) << "on no arm";
  const std::string turret = "<body name=\"turret\"><joint name=\"yaw\"/><geom size=\"0.1\"/>";
  EXPECT_TRUE(says(of(mjcf_of(turret + fingers + "</body>", coupled)), words)) << "as long as it";
}

TEST(Mjcf, OneOfTwoFingersIsAnArmOfOneJoint) {
  const Folder folder;
  std::string loose = fingers;
  loose.erase(loose.find(" stiffness"), 14);
  for (const std::string& ties : {coupled, tendon_of({"left", "right"})}) {
    const std::string path = folder.with("hand.xml", mjcf_of(loose, ties));
    const Robot robot = load_mjcf_arm(path, {.tip = "left"});
    ASSERT_EQ(robot.arm.links.size(), 1U);
    EXPECT_EQ(robot.arm.links[0].joint_name, "left");
    EXPECT_EQ(robot.arm.links[0].effort_limit, 0.0) << "unknown";
    EXPECT_EQ(robot.held[0].name, "right");
  }
  EXPECT_TRUE(says(complaint(folder.with("hand.xml", mjcf_of(fingers, coupled)), {.tip = "left"}),
                   "joint 'left' has a spring, stiffness 2"));
}

TEST(Mjcf, WhatActsOnTheArmIsRefusedByName) {
  const Folder folder;
  const auto of = [&](const std::string& rest) {
    return complaint(folder.with("m.xml", seven_joints(fingers, coupled + rest)));
  };
  const struct {
    std::string rest, words;
  } cases[] = {
      {"<equality><joint name=\"e\" joint1=\"2\" joint2=\"3\"/></equality>",
       "'e' is an equality constraint, which acts on joint '2' of the arm"},
      {"<equality><joint name=\"e\" joint1=\"3\" joint2=\"left\"/></equality>",
       "'e' is an equality constraint, which acts on joint '3' of the arm"},
      {"<equality><joint name=\"e\" joint1=\"7\"/></equality>", "acts on joint '7'"},
      {"<equality><connect name=\"e\" body1=\"left\" body2=\"link 3\" anchor=\"0 0 "
       "0\"/></equality>",
       "'e' is an equality constraint, which acts on joint '4' of the arm"},
      {tendon_of({"left", "3"}, "stiffness=\"1\""),
       "'t' is a tendon with a spring, which acts on joint '3' of the arm"},
      {tendon_of({"3"}, "damping=\"1\""), "'t' is a tendon with damping"},
      {tendon_of({"3"}, "frictionloss=\"1\""), "'t' is a tendon with dry friction"},
      {tendon_of({"3"}, "limited=\"true\" range=\"0 1\""), "'t' is a tendon with limits"},
      {"<tendon><fixed name=\"t\"><joint joint=\"3\" coef=\"1\"/></fixed></tendon>"
       "<equality><tendon name=\"e\" tendon1=\"t\"/></equality>",
       "'e' is an equality constraint, which acts on joint '3' of the arm"},
  };
  for (const auto& each : cases) {
    const std::string text = of(each.rest);
    EXPECT_TRUE(says(text, each.words)) << each.words << "\n" << text;
    EXPECT_TRUE(says(text, "m.xml")) << text;
  }
  EXPECT_EQ(of("<equality><joint joint1=\"2\" joint2=\"3\" active=\"false\"/></equality>"),
            "accepted");
  EXPECT_EQ(of("<equality><weld body1=\"left\" body2=\"link 7\"/></equality>"), "accepted");
}

TEST(Mjcf, AMotorOnATendonMakesTheEffortOfItsJointsUnknown) {
  const Folder folder;
  std::string text = seven_joints(fingers, coupled + tendon_of({"3"}) +
                                               "<tendon><spatial name=\"s\"><site site=\"from\"/>"
                                               "<site site=\"to\"/></spatial></tendon><actuator>"
                                               "<motor tendon=\"s\"/></actuator>");
  const auto after = [&](const std::string& words, const std::string& more) {
    text.insert(text.find(words) + words.size(), more);
  };
  after("<joint name=\"5\" axis=\"0 0 1\"/>", "<site name=\"from\"/>");
  after("<joint name=\"7\" axis=\"0 0 1\"/>", "<site name=\"to\" pos=\"0.1 0 0\"/>");
  const Robot robot = load_mjcf_arm(folder.with("arm.xml", text));
  std::vector<double> limits;
  for (const ArmLink& link : robot.arm.links) limits.push_back(link.effort_limit);
  EXPECT_EQ(limits, (std::vector<double>{9, 9, 0, 9, 9, 0, 0}));
}
#endif

}  // namespace mjcf_test
}  // namespace repel
