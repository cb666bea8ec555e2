// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/plan.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "network/drawn_network.hpp"

namespace repel::network {
namespace plan_test {

using test::period;

Mass<any_size> mass(int size) {
  return Mass<any_size>(Matrix::Identity(size, size));
}
std::string complaint(const Plan& plan, double at = period) {
  try {
    (void)plan.build(at);
  } catch (const SetupError& error) {
    return error.what();
  }
  return {};
}
void expect_says(const std::string& text, const std::string& what) {
  EXPECT_NE(text.find(what), std::string::npos) << text;
}

/// From the torque arm to the robot as in the comment on Plan, with all optional modules.
Plan figure_9() {
  return Plan()
      .add("torque_arm", TorqueArm())
      .add("multiplex", Multiplex())
      .add("kbb2", Kbb2())
      .add("spaceball", Spaceball())
      .add("relief", Relief({.compliant = {false, false, true, false, false, false}}))
      .add("obstacle", Obstacle())
      .add("visual", Visual())
      .add("puma_kin", PumaKin())
      .add("limits", Limits({}, std::vector<JointRange>(6, {-2.0, 2.0})))
      .add("puma_joints", PumaJoints(6));
}

TEST(Plan, OfTheCommentIsBuilt) {
  const Network network = Plan()
                              .add("torque_arm", TorqueArm())
                              .add("multiplex", Multiplex())
                              .add("kbb2", Kbb2())
                              .add("puma_kin", PumaKin())
                              .add("puma_joints", PumaJoints(6))
                              .build(0.0025);
  EXPECT_EQ(network.nodes().size(), 5U);
  ASSERT_EQ(network.connections().size(), 4U);
  const std::array<Space, 4> spaces{Space::lever, Space::tool, Space::tool, Space::joints};
  for (std::size_t i = 0; i < 4; ++i) {
    const Connection& c = network.connections()[i];
    EXPECT_EQ(c.space, spaces[i]);
    EXPECT_EQ(c.size, c.space == Space::lever ? 1 : 6);
    EXPECT_TRUE(c.root_on_right);
    EXPECT_EQ(c.left, network.nodes()[i].name);
    EXPECT_EQ(c.right, network.nodes()[i + 1].name);
  }
}

TEST(Plan, BranchOfTheCommentEndsAtAJunction) {
  const Network network = Plan()
                              .add("hand", mass(6), "junction")
                              .add("ball", EffortSource<any_size>(Vector::Ones(6)), "junction")
                              .add("junction", Junction())
                              .add("relief", Relief())
                              .add("end", mass(6))
                              .build(period);
  EXPECT_EQ(network.find("junction")->branches.size(), 2U);
  EXPECT_EQ(network.find("nobody"), nullptr);
  EXPECT_NE(network.find<Junction>(), nullptr);
  EXPECT_EQ(network.find<TorqueArm>(), nullptr);
}

// The lever follows the hand, the tool follows the lever through the coupling, and the arm, which
// is fixed, gets a torque along the direction only.
TEST(Plan, LeverDrivesTheArmOfFigure9) {
  Network network = figure_9().build(period);
  Signals signals = detail::neutral_signals(6, period);
  signals.hand.lever_rate = 0.2;
  signals.hand.direction_W = Vec3::UnitY();
  for (int tick = 0; tick < 100; ++tick) ASSERT_TRUE(network.run(signals));
  const Vector& torques = network.find<PumaJoints>()->torques();
  EXPECT_GT(torques(1), 1.0);
  for (const int still : {0, 2, 3, 4, 5}) EXPECT_NEAR(torques(still), 0.0, 1e-9);
  EXPECT_NEAR(network.find<TorqueArm>()->felt(), -0.1 * torques(1), 1e-9);
  // From left to right, towards the robot: an effort along y.
  EXPECT_NEAR(network.connections().back().effort()(1), torques(1), 1e-12);
  signals.walls.force = Vec3(0.0, -7.0, 0.0);
  const double before = torques(1);
  ASSERT_TRUE(network.run(signals));
  EXPECT_NEAR(network.find<PumaJoints>()->torques()(1), before - 7.0, 0.5);
  test::expect_passive(network);
}

TEST(Plan, NamesAreUniqueAndKnown) {
  expect_says(complaint(Plan().add("ball", mass(6)).add("ball", Spaceball()).add("end", mass(6))),
              "two modules are called 'ball'");
  const std::string unknown =
      complaint(Plan().add("mass", mass(6), "nobody").add("ball", Spaceball()).add("end", mass(6)));
  expect_says(unknown, "'mass'");
  expect_says(unknown, "'nobody'");
  expect_says(complaint(Plan().add("a", Junction(), "a").add("b", mass(6))), "'a'");
}

TEST(Plan, HoldsOneModuleToMostModules) {
  const auto chain = [](std::size_t modules) {
    Plan plan;
    plan.add("first", mass(6));
    for (std::size_t i = 2; i < modules; ++i) plan.add("ball " + std::to_string(i), Spaceball());
    plan.add("last", mass(6));
    return plan;
  };
  EXPECT_EQ(complaint(chain(Plan::most_modules)), "");
  const std::string text = complaint(chain(Plan::most_modules + 1));
  expect_says(text, "number of modules is 33");
  expect_says(text, "32");
  expect_says(complaint(Plan()), "number of modules is 0");
}

TEST(Plan, PeriodIsCheckedByTheModuleThatNeedsIt) {
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    const std::string text = complaint(figure_9(), bad);
    expect_says(text, "module 'torque_arm'");
    expect_says(text, "period");
  }
}

// The multiplex lets the tool move along one direction only; the arm moves it in all.
TEST(Plan, WhatInsistsOnBothSidesIsRefused) {
  const std::string rigid = complaint(Plan()
                                          .add("torque_arm", TorqueArm())
                                          .add("multiplex", Multiplex())
                                          .add("puma_kin", PumaKin())
                                          .add("puma_joints", PumaJoints(6)));
  expect_says(rigid, "'puma_kin'");
  expect_says(rigid, "insist");
  expect_says(rigid, "kbb2");
  const FlowSource<any_size> moved(Vector::Zero(6));
  const EffortSource<any_size> pushed(Vector::Zero(6));
  expect_says(complaint(Plan().add("a", moved).add("ball", Spaceball()).add("b", moved)), "'b'");
  expect_says(complaint(Plan().add("a", pushed).add("ball", Spaceball()).add("b", pushed)), "'b'");
  EXPECT_EQ(complaint(Plan().add("a", moved).add("ball", Spaceball()).add("b", pushed)), "");
  EXPECT_EQ(
      complaint(
          Plan().add("a", moved).add("kbb2", Kbb2()).add("ball", Spaceball()).add("b", moved)),
      "");
  const std::string meeting = complaint(Plan()
                                            .add("a", moved, "junction")
                                            .add("b", moved, "junction")
                                            .add("junction", Junction())
                                            .add("ball", Spaceball())
                                            .add("c", mass(6)));
  expect_says(meeting, "'junction'");
}

TEST(Plan, TrialAtSetUpLeavesNoTrace) {
  const Network network = figure_9().build(period);
  EXPECT_EQ(network.find<TorqueArm>()->angle(), 0.0);
  for (const Node& node : network.nodes()) {
    EXPECT_EQ(node.ledger.passed, 0.0) << node.name;
  }
}

TEST(Plan, IsBuiltAsOftenAsOneLikes) {
  const Plan plan = figure_9();
  Network one = plan.build(period);
  Signals signals = detail::neutral_signals(6, period);
  signals.hand.lever_rate = 0.3;
  for (int tick = 0; tick < 100; ++tick) ASSERT_TRUE(one.run(signals));
  Network two = plan.build(period);
  EXPECT_EQ(two.find<TorqueArm>()->angle(), 0.0);
  for (int tick = 0; tick < 100; ++tick) ASSERT_TRUE(two.run(signals));
  EXPECT_EQ(one.find<PumaJoints>()->torques(), two.find<PumaJoints>()->torques());
}

}  // namespace plan_test
}  // namespace repel::network
