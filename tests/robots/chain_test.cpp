// SPDX-License-Identifier: BSD-3-Clause
// Which joints of a robot are those of its arm, and which link is its tool, if nobody says so.
#include "robot_text.hpp"

namespace repel {
namespace chain_test {

using test::expect_refused;
using test::held;
using test::moving;
using test::read;
using test::RobotText;
using Names = std::vector<std::string>;
using Set = std::set<std::string>;

const Names seven{"j1", "j2", "j3", "j4", "j5", "j6", "j7"};

/// Seven joints, a flange, and a hand with two fingers, the second of which mimics the first.
RobotText panda(const std::string& finger = "finger_joint") {
  RobotText text("base");
  text.line("base", "j", 7).fixed("jlink7", "flange").fixed("flange", "hand");
  text.sliding(finger + "1", "hand", "left");
  text.sliding(finger + "2", "hand", "right", "<mimic joint='" + finger + "1'/>");
  return text;
}

TEST(Chain, AnArmWithTwoFingersEndsBeforeThem) {
  const Robot robot = read(panda());
  EXPECT_EQ(moving(robot), seven);
  EXPECT_EQ(held(robot), (Set{"finger_joint1", "finger_joint2"}));
  EXPECT_EQ(robot.end, "jlink7");
  EXPECT_EQ(robot.tool, "hand");
  EXPECT_EQ(robot.arm.X_LT.translation(), Vec3(0, 0, 2));
  EXPECT_EQ(robot.arm.links.back().mass, 5.0) << "the last link, flange, hand and fingers";
  EXPECT_EQ(robot.parts.back().link, 6);
}

TEST(Chain, AToolFrameOfTheHandIsTheTool) {
  RobotText text = panda();
  text.fixed("hand", "camera").fixed("hand", "panda_hand_tcp");
  EXPECT_EQ(read(text).tool, "panda_hand_tcp");
  EXPECT_EQ(read(text).arm.X_LT.translation(), Vec3(0, 0, 3));
  text.fixed("hand", "link_ee");
  EXPECT_EQ(read(text).tool, "hand") << "neither is the only one";
}

// A tool frame of the arm alone is where its hand is mounted.
TEST(Chain, AToolFrameBesideTheHandIsNotTheTool) {
  RobotText text = panda();
  text.fixed("flange", "ee_link");
  EXPECT_EQ(read(text).tool, "hand");
}

TEST(Chain, FingersAreKnownByTheJointThatMimics) {
  const Robot robot = read(panda("slide"));
  EXPECT_EQ(moving(robot), seven);
  EXPECT_EQ(held(robot), (Set{"slide1", "slide2"}));
  EXPECT_EQ(robot.tool, "hand");
}

TEST(Chain, FingersAreKnownByTheirEqualLength) {
  RobotText text("base");
  text.line("base", "j", 7).fixed("jlink7", "palm");
  text.line("palm", "a", 3).line("palm", "b", 3).line("palm", "c", 2);
  const Robot robot = read(text);
  EXPECT_EQ(moving(robot), seven);
  EXPECT_EQ(robot.held.size(), 8U);
  EXPECT_EQ(robot.tool, "palm");
}

TEST(Chain, AGripperWithOneJointIsKnownByItsName) {
  RobotText text("base");
  text.line("base", "joint", 6).fixed("jointlink6", "stator");
  text.turning("jointGripper", "stator", "mover");
  const Robot robot = read(text);
  EXPECT_EQ(robot.arm.links.size(), 6U);
  EXPECT_EQ(held(robot), Set{"jointGripper"});
  EXPECT_EQ(robot.tool, "stator");
  EXPECT_EQ(read(text, {.tip = "mover"}).arm.links.size(), 7U) << "as chosen";
}

// A wrist joint may carry the gripper's name, and does in small arms.
TEST(Chain, AJointOfTheArmMayHaveTheNameOfTheGripper) {
  RobotText text("base");
  text.line("base", "j", 3).turning("gripper_pitch", "jlink3", "fork");
  text.turning("gripper_roll", "fork", "wrist").line("wrist", "k", 1);
  EXPECT_EQ(read(text).arm.links.size(), 6U);
  RobotText only("base");
  only.turning("gripper_a", "base", "a").turning("gripper_b", "a", "b");
  EXPECT_EQ(read(only).arm.links.size(), 2U) << "there is no other arm";
}

RobotText legged(int joints_of_arm) {
  RobotText text("trunk");
  for (const char* leg : {"fl", "fr", "rl", "rr"}) {
    text.line("trunk", leg, 2);
    text.joint("revolute", leg + std::string("_calf"), leg + std::string("link2"),
               leg + std::string("_foot"),
               "<axis xyz='0 1 0'/><limit lower='-2.7' upper='-0.9' velocity='1' effort='1'/>");
  }
  text.line("trunk", "j", joints_of_arm);
  return text;
}

TEST(Chain, TheArmOfALeggedBaseIsTheLongestBranch) {
  RobotText text = legged(6);
  text.fixed("jlink6", "stator").turning("jointGripper", "stator", "mover");
  const Robot robot = read(text);
  EXPECT_EQ(moving(robot), (Names{"j1", "j2", "j3", "j4", "j5", "j6"}));
  EXPECT_EQ(robot.held.size(), 13U);
  EXPECT_EQ(test::held_joint(robot, "fl1").position, 0.0);
  EXPECT_EQ(test::held_joint(robot, "rr_calf").position, -0.9) << "its limit nearest to zero";
  EXPECT_EQ(robot.tool, "stator");
}

TEST(Chain, EquallyLongArmsAreRefusedWithTheirTips) {
  RobotText text("base");
  text.line("base", "torso", 2).line("torsolink2", "left", 6).line("torsolink2", "right", 6);
  text.line("torsolink2", "head", 2);
  expect_refused(text, "torsolink2",
                 {"link 'torsolink2'", "2 branches of 6 moving joints", "tip_link", "--tip",
                  "'leftlink6', 'rightlink6'"});
  const Robot right = read(text, {.tip = "rightlink6"});
  EXPECT_EQ(right.arm.links.size(), 8U);
  EXPECT_EQ(right.held.size(), 8U);
  expect_refused(legged(3), "trunk", {"5 branches of 3 moving joints"});
}

TEST(Chain, ARodBesideTheArmDoesNotEndIt) {
  RobotText text("base");
  text.line("base", "j", 5).turning("rod", "jlink2", "r");
  const Robot robot = read(text);
  EXPECT_EQ(robot.arm.links.size(), 5U);
  EXPECT_EQ(held(robot), Set{"rod"});
  EXPECT_EQ(robot.tool, "jlink5");
}

TEST(Chain, ABaseThatMayStandAnywhereIsHeldWhereItIs) {
  RobotText text("world");
  text.joint("floating", "stand", "world", "base").line("base", "j", 3);
  const Robot robot = read(text);
  EXPECT_EQ(moving(robot), (Names{"j1", "j2", "j3"}));
  EXPECT_EQ(test::held_joint(robot, "stand").type, "floating");
}

TEST(Chain, AWristHeldByChoiceStillLeadsToTheTool) {
  RobotText text("base");
  text.line("base", "j", 3).fixed("jlink3", "flange");
  const Robot robot = read(text, {.hold = {"j3"}});
  EXPECT_EQ(moving(robot), (Names{"j1", "j2"}));
  EXPECT_EQ(robot.tool, "flange");
  EXPECT_EQ(robot.arm.X_LT.translation(), Vec3(0, 0, 2));
}

TEST(Chain, TheReasonsAreGiven) {
  const Robot robot = read(panda());
  EXPECT_EQ(robot.end_reason, "the longest chain of joints that move on their own");
  EXPECT_EQ(robot.tool_reason, "the link that carries the held fingers");
  EXPECT_EQ(read(panda(), {.tip = "flange"}).tool_reason, "the chosen tip");
  EXPECT_EQ(read(panda(), {.tip = "flange"}).held.size(), 2U);
}

TEST(Chain, ARobotWithoutANameHasThatOfItsFile) {
  RobotText text("base", "");
  text.line("base", "j", 1);
  EXPECT_EQ(parse_arm(text.urdf(), {}, "some/where/z1.urdf").arm.name, "z1");
}

}  // namespace chain_test
}  // namespace repel
