// SPDX-License-Identifier: BSD-3-Clause
// Where the joints stand that do not move: at a chosen value, at zero, or where what they mimic
// puts them.
#include <cmath>

#include "robot_text.hpp"

namespace repel {
namespace held_joints_test {

using test::expect_refused;
using test::held_joint;
using test::read;
using test::RobotText;

/// An arm with two joints and a finger that slides along x, beside further joints.
RobotText arm_with_finger() {
  RobotText text("base");
  text.line("base", "j", 2).sliding("finger", "jlink2", "tip_of_finger");
  return text;
}

Vec3 place_of(const Robot& robot, const std::string& link) {
  for (const RobotLink& each : robot.links) {
    if (each.name == link) return each.X_LN.translation();
  }
  ADD_FAILURE() << link << " is lost";
  return {};
}

TEST(HeldJoints, AreHeldAtZeroOrAtAChosenValue) {
  EXPECT_EQ(held_joint(read(arm_with_finger()), "finger").position, 0.0);
  EXPECT_EQ(held_joint(read(arm_with_finger()), "finger").reason, "beside the chain");
  const Robot open = read(arm_with_finger(), {.hold = {{"finger", 0.03}}});
  EXPECT_EQ(held_joint(open, "finger").position, 0.03);
  EXPECT_EQ(held_joint(open, "finger").reason, "as chosen");
  EXPECT_EQ(place_of(open, "tip_of_finger"), Vec3(0.03, 0, 1));
  EXPECT_EQ(open.parts.back().X_LP.translation(), Vec3(0.03, 0, 1));
  EXPECT_NEAR(open.arm.links.back().p_LC.x(), 0.015, 1e-15) << "two equal masses";
}

TEST(HeldJoints, ATurnedOneTurnsWhatItCarries) {
  RobotText text("base");
  text.line("base", "j", 2).turning("gripper", "jlink2", "jaw").fixed("jaw", "pad");
  const Robot robot = read(text, {.hold = {{"gripper", std::acos(0.0)}}});
  EXPECT_LT((place_of(robot, "pad") - Vec3(0, -1, 1)).norm(), 1e-15);
}

TEST(HeldJoints, AJointOfTheChainMayBeHeldAnywhereInItsRange) {
  const Robot robot = read(arm_with_finger(), {.hold = {{"j1", 1.5}}});
  ASSERT_EQ(robot.arm.links.size(), 1U);
  EXPECT_NEAR(robot.arm.links[0].X_PJ.translation().y(), -std::sin(1.5), 1e-15);
}

TEST(HeldJoints, AValueOutOfRangeIsRefused) {
  expect_refused(arm_with_finger(), "finger", {"joint 'finger'", "0.05", "0 to 0.04 m"},
                 {.hold = {{"finger", 0.05}}});
  expect_refused(arm_with_finger(), "finger", {"nan", "0 to 0.04 m"},
                 {.hold = {{"finger", std::nan("")}}});
  expect_refused(arm_with_finger(), "finger", {"a length, since it slides"},
                 {.hold = {{"finger", 0.01, JointType::revolute}}});
  expect_refused(arm_with_finger(), "j1", {"an angle, since it turns"},
                 {.hold = {{"j1", 0.01, JointType::prismatic}}});
  expect_refused(arm_with_finger(), "base", {"no joint 'thumb'"}, {.hold = {"thumb"}});
  expect_refused(arm_with_finger(), "finger", {"twice"}, {.hold = {"finger", {"finger", 0.01}}});
}

TEST(HeldJoints, OneThatMimicsFollowsByMultiplierAndOffset) {
  RobotText text = arm_with_finger();
  text.turning("knuckle", "jlink2", "k", "<mimic joint='finger' multiplier='-20' offset='0.25'/>");
  text.turning("pad_joint", "k", "p", "<mimic joint='knuckle' multiplier='2'/>");
  EXPECT_EQ(held_joint(read(text), "knuckle").position, 0.25);
  EXPECT_EQ(held_joint(read(text), "pad_joint").position, 0.5);
  const Robot open = read(text, {.hold = {{"finger", 0.02}}});
  EXPECT_NEAR(held_joint(open, "knuckle").position, -20 * 0.02 + 0.25, 1e-15);
  EXPECT_NEAR(held_joint(open, "pad_joint").position, 2 * (-20 * 0.02 + 0.25), 1e-15);
  EXPECT_EQ(held_joint(open, "knuckle").reason, "mimics finger");
  const Robot named = read(text, {.hold = {{"finger", 0.02}, "knuckle"}});
  EXPECT_EQ(held_joint(named, "knuckle").position, held_joint(open, "knuckle").position);
  EXPECT_EQ(held_joint(read(text, {.hold = {{"knuckle", 1.0}}}), "knuckle").position, 1.0);
}

TEST(HeldJoints, OneThatFollowsBeyondItsRangeStopsThereAndSaysSo) {
  RobotText text = arm_with_finger();
  text.turning("knuckle", "jlink2", "k", "<mimic joint='finger' multiplier='100' offset='-0.5'/>");
  const HeldJoint knuckle = held_joint(read(text, {.hold = {{"finger", 0.04}}}), "knuckle");
  EXPECT_EQ(knuckle.position, 2.0);
  EXPECT_NE(knuckle.reason.find("3.5 rad is out of its range -1 to 2 rad"), std::string::npos)
      << knuckle.reason;
}

TEST(HeldJoints, OneThatMimicsAMovingJointIsRefusedUnlessHeldByChoice) {
  RobotText beside = arm_with_finger();
  beside.turning("rod", "base", "r", "<mimic joint='j1'/>");
  expect_refused(beside, "rod", {"joint 'rod'", "mimics 'j1', which moves", "hold", "tip"});
  EXPECT_EQ(held_joint(read(beside, {.hold = {"rod"}}), "rod").position, 0.0);
  RobotText within("base");
  within.turning("j1", "base", "a").turning("j2", "a", "b", "<mimic joint='j1'/>");
  within.turning("j3", "b", "c");
  expect_refused(within, "j2", {"joint 'j2'", "mimics 'j1', which moves", "to 'c'", "hold"});
  EXPECT_EQ(read(within, {.hold = {"j2"}}).arm.links.size(), 2U);
  const Robot still = read(within, {.hold = {{"j1", 0.5}}});
  EXPECT_EQ(still.arm.links.size(), 1U) << "what j2 mimics does not move";
  EXPECT_EQ(held_joint(still, "j2").position, 0.5);
}

TEST(HeldJoints, MimicsThatLeadNowhereAreRefused) {
  const auto with = [](const std::string& content) {
    RobotText text = arm_with_finger();
    text.turning("a", "base", "al", content).turning("b", "base", "bl", "<mimic joint='a'/>");
    return text;
  };
  expect_refused(with("<mimic joint='c'/>"), "a", {"joint 'a' mimics 'c'", "not in the file"});
  expect_refused(with("<mimic/>"), "a", {"joint 'a' mimics ''", "not in the file"});
  expect_refused(with("<mimic joint='b'/>"), "b", {"'b' mimics 'a'", "no circle"});
  expect_refused(with("<mimic joint='a'/>"), "a", {"'a' mimics 'a'", "no circle"});
  expect_refused(with("<mimic joint='j1' multiplier='x'/>"), "a", {"multiplier", "'x'"});
  expect_refused(with("<mimic joint='j1' offset='inf'/>"), "a", {"offset", "'inf'"});
}

TEST(HeldJoints, ARangeOfNoLengthDoes) {
  RobotText text = arm_with_finger();
  text.joint("revolute", "locked", "base", "l",
             "<axis xyz='1 0 0'/><limit lower='0.5' upper='0.5' velocity='1' effort='1'/>");
  EXPECT_EQ(held_joint(read(text), "locked").position, 0.5);
  text.joint("revolute", "inverted", "base", "i",
             "<axis xyz='1 0 0'/><limit lower='1' upper='0' velocity='1' effort='1'/>");
  expect_refused(text, "inverted", {"joint 'inverted'", "1 to 0 rad", "lower not above upper"});
}

}  // namespace held_joints_test
}  // namespace repel
