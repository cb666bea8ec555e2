// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/joint_torques.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "loop/slider.hpp"
#include "support/families.hpp"

namespace repel {
namespace joint_torques_test {

constexpr double period = 0.0025;

struct Bench {
  explicit Bench(double effort_limit = 100.0)
      : model(test::slider_model(effort_limit)), torques(model, period, {}), inertia(model) {
    (void)inertia.update(test::SliderKinematics());
    network.setZero(3);
    walls.setZero(3);
    set_weight(0.0);
  }
  void set_weight(double weight) { std::fill_n(torques.gravity().begin(), 3, weight); }
  Status step(const TorqueShares& shares = {}) {
    return torques.compose(network, walls, shares, v, inertia);
  }
  [[nodiscard]] double sent(int joint = 0) const { return torques.torques()[joint]; }

  ArmModel model;  // three sliders of 5 kg
  JointTorques torques;
  ArmInertia inertia;
  JointTorques::Vector network, walls;  // [N]
  std::vector<double> v{0.0, 0.0, 0.0};
};

TEST(JointTorques, AddUpWeightOperatorAndWalls) {
  Bench bench;
  bench.network << 7.0, 0.0, 0.0;
  bench.walls << 3.0, 0.0, 0.0;
  bench.set_weight(20.0);
  EXPECT_EQ(bench.step({.operators = 0.5}), 0U);
  EXPECT_EQ(bench.sent(), 20.0 + 0.5 * 4.0 + 3.0);
  EXPECT_EQ(bench.torques.net()(0), 5.0);
}

TEST(JointTorques, TheShareOfDrivingActsWhereTheOperatorGivesPowerAlone) {
  for (const double rate : {0.1, -0.1}) {
    Bench bench;
    bench.network << 7.0, 0.0, 0.0;
    bench.v[0] = rate;
    EXPECT_EQ(bench.step({.drive = 0.0}), 0U);
    EXPECT_EQ(bench.sent(), rate > 0.0 ? 0.0 : 7.0);
  }
}

TEST(JointTorques, BrakingTakesItsShareOfTheMomentumAndNeverDrives) {
  Bench bench;
  bench.v = {0.1, -0.05, 0.0};
  EXPECT_EQ(bench.step({.brake = 1.0}), 0U);
  EXPECT_NEAR(bench.sent(0), -5.0 * 0.1 / 0.02, 1e-12);
  EXPECT_NEAR(bench.sent(1), 5.0 * 0.05 / 0.02, 1e-12);
  EXPECT_EQ(bench.sent(2), 0.0);
}

TEST(JointTorques, BrakingTakesWhatEffortIsLeftAndKeepsItsDirection) {
  Bench bench;
  bench.set_weight(90.0);
  bench.v = {-0.2, 0.1, 0.0};
  (void)bench.step({.brake = 1.0});
  EXPECT_NEAR(bench.sent(0), 100.0, 1e-9);
  EXPECT_NEAR(bench.sent(1), 85.0, 1e-9);
}

TEST(JointTorques, BrakingStepsBackWhereAWallPushesTheArmAhead) {
  Bench bench;
  bench.v[0] = 0.1;
  bench.walls << 5.0, 0.0, 0.0;
  bench.network = bench.walls;
  (void)bench.step({.brake = 1.0});
  EXPECT_NEAR(bench.sent(), 5.0 - (25.0 - 4.0 * 5.0), 1e-9);
  bench.walls << 50.0, 0.0, 0.0;
  bench.network = bench.walls;
  (void)bench.step({.brake = 1.0});
  EXPECT_GT(bench.sent(), 45.0);
}

TEST(JointTorques, AreWithinTheEffortAndChangeNoFasterThanStated) {
  Bench bench;
  (void)bench.step();
  bench.network << 1e9, 0.0, 0.0;
  EXPECT_EQ(bench.step(), status::torque_limit | status::torque_rate);
  EXPECT_EQ(bench.sent(), 50.0);  // half the slew time
  EXPECT_EQ(bench.step(), status::torque_limit);
  EXPECT_EQ(bench.sent(), 100.0);
  bench.network << -1e9, 0.0, 0.0;
  for (const double expected : {50.0, 0.0, -50.0, -100.0, -100.0}) {
    (void)bench.step();
    EXPECT_EQ(bench.sent(), expected);
  }
}

TEST(JointTorques, ANumberThatIsNoneIsAFaultAndTheWeightIsCarriedOn) {
  for (int which = 0; which < 3; ++which) {
    Bench bench;
    bench.set_weight(20.0);
    (void)bench.step();
    if (which == 0) bench.network(1) = std::nan("");
    if (which == 1) bench.walls(1) = INFINITY;
    if (which == 2) bench.torques.gravity()[1] = std::nan("");
    EXPECT_EQ(bench.step() & status::bad_torque, status::bad_torque) << which;
    for (int joint = 0; joint < 3; ++joint) EXPECT_EQ(bench.sent(joint), 20.0) << which;
  }
}

TEST(JointTorques, SayHowFastEachJointIsExpectedToBe) {
  Bench bench;
  bench.model.links[0].viscous_friction = 0.0;
  bench.network << 10.0, 0.0, 0.0;
  (void)bench.step();
  EXPECT_NEAR(bench.torques.expected_rate()(0), period * 10.0 / 5.0, 1e-12);
  bench.model.links[0].coulomb_friction = 4.0;
  (void)bench.step({.friction = 0.0});
  EXPECT_NEAR(bench.torques.expected_rate()(0), period * 6.0 / 5.0, 1e-12);
}

// Explicit friction multiplied the predicted rate of a light wrist by -13 in every tick.
TEST(JointTorques, ThePredictedRateOfALightJointDiesAway) {
  ArmModel model = test::slider_model(100.0);
  for (ArmLink& link : model.links) {
    link.rotor_inertia = 1.4e-4;
    link.viscous_friction = 2.0;
  }
  JointTorques torques(model, 0.001, {});
  ArmInertia inertia(model);
  (void)inertia.update(test::SliderKinematics());
  const JointTorques::Vector none = JointTorques::Vector::Zero(3);
  std::vector<double> v{0.5, -0.5, 0.0};
  for (int tick = 0; tick < 100; ++tick) {
    (void)torques.compose(none, none, {}, v, inertia);
    for (int i = 0; i < 3; ++i) {
      ASSERT_LE(std::abs(torques.expected_rate()(i)), std::abs(v[i])) << tick;
      v[i] = torques.expected_rate()(i);
    }
  }
  EXPECT_LT(std::abs(v[0]), 1e-6);
}

TEST(JointTorques, AJointThatMayBeFrozenIsPushedAsFarAsTheLimitsAllow) {
  Bench bench;
  bench.network << 7.0, 7.0, -7.0;
  const std::vector<double> probes{20.0, -20.0, 0.0};
  (void)bench.torques.compose(bench.network, bench.walls, {}, bench.v, bench.inertia,
                              {.probes = probes});
  EXPECT_EQ(bench.sent(0), 20.0);
  EXPECT_EQ(bench.sent(1), -20.0);
  EXPECT_EQ(bench.sent(2), -7.0);
}

/// Of the first two sliders, each is moved by the other.
struct CoupledSliders : test::SliderKinematics {
  [[nodiscard]] bool mass_matrix(Eigen::MatrixXd& M) const noexcept override {
    M.setZero();
    M.diagonal().setConstant(5.0);
    M(0, 1) = M(1, 0) = 4.0;
    return true;
  }
};

// A joint that stands still because another one moves, as what holds an arm makes it do, was taken
// for one whose encoder is frozen, and the pose that was then predicted was 60 mm inside a wall.
TEST(JointTorques, SayWhatMovesAJointAloneWhereABarrierHoldsTheArm) {
  Bench bench;
  (void)bench.inertia.update(CoupledSliders());
  EntryBarrier barrier(bench.model, period, 0.0, 0.005, 1);
  bench.network << 10.0, 8.0, 0.0;
  (void)bench.torques.compose(bench.network, bench.walls, {.friction = 0.0}, bench.v, bench.inertia,
                              {.barrier = &barrier});
  EXPECT_NEAR(bench.torques.net()(1), 8.0, 1e-9);
  EXPECT_NEAR(bench.torques.alone()(0), 10.0, 1e-9);
  EXPECT_NEAR(bench.torques.alone()(1), 0.0, 1e-9);
  EXPECT_NEAR(bench.torques.expected_rate()(1), 0.0, 1e-12);
}

// A joint at rest whose encoder toggles between two steps: its rate is their difference, and the
// damping of the operator's coupling turns that into a torque that it is asked for.
TEST(JointTorques, NoiseOfAnEncoderAtStandstillDoesNotSwitchTheCompensationOfFriction) {
  constexpr unsigned seed = 7;
  constexpr double step = 1e-5;      // [m]
  constexpr double damping = 300.0;  // [N s/m]
  constexpr double friction = 25.0;  // [N]
  families::Rng random(seed);
  Bench bench;
  bench.model.links[0].coulomb_friction = friction;
  double sent_last = 0.0;
  double asked_last = 0.0;
  double jump = 0.0;   // [N] of the compensation from tick to tick
  double swing = 0.0;  // [N] of what it is asked for
  double read = 0.0;
  for (int k = 0; k < 4000; ++k) {
    const double now = families::uniform(random, 0.0, 1.0) < 0.5 ? 0.0 : step;
    bench.v[0] = (now - read) / period;
    read = now;
    bench.network(0) = -damping * bench.v[0];
    EXPECT_EQ(bench.step(), 0U);
    jump = std::max(jump, std::abs(bench.sent() - sent_last - bench.network(0) + asked_last));
    swing = std::max(swing, std::abs(bench.network(0) - asked_last));
    sent_last = bench.sent();
    asked_last = bench.network(0);
  }
  EXPECT_LT(jump, 0.02 * friction) << "seed " << seed;
  EXPECT_GT(jump, 0.0);
  EXPECT_GT(swing, 0.05 * friction);
}

// The rate alone moves no torque.
TEST(JointTorques, DoNotFollowTheRateOfAJointWithFriction) {
  Bench bench;
  bench.model.links[0].coulomb_friction = 25.0;
  for (const double rate : {0.02, -0.02, 0.5, -0.5}) {
    bench.v[0] = rate;
    EXPECT_EQ(bench.step(), 0U);
    EXPECT_EQ(bench.sent(), 0.0);
  }
}

TEST(JointTorques, CompensateFrictionAnewAfterItWasSwitchedOff) {
  Bench bench;
  bench.model.links[0].coulomb_friction = 25.0;
  bench.network << 10.0, 0.0, 0.0;
  (void)bench.step();
  const double first = bench.sent();
  EXPECT_GT(first, 10.0);
  for (int k = 0; k < 100; ++k) (void)bench.step();
  EXPECT_NEAR(bench.sent(), 10.0 + 0.8 * 25.0, 1e-9);
  (void)bench.step({.friction = 0.0});
  (void)bench.step({.friction = 0.0});
  EXPECT_EQ(bench.sent(), 10.0);
  (void)bench.step();
  EXPECT_EQ(bench.sent(), first);
}

// Heavy joints may change their torques by less in a tick than they are asked to. A light wrist
// that was sent its own share all the same was thrown to 50 rad/s.
TEST(JointTorques, WhatAHeavyJointLacksThrowsNoLightOne) {
  struct Wrist : test::SliderKinematics {
    [[nodiscard]] bool mass_matrix(Eigen::MatrixXd& M) const noexcept override {
      M.setZero();
      M.diagonal() << 5.0, 5.0, 1e-3;
      M(0, 2) = M(2, 0) = 0.05;
      return true;
    }
  };
  Bench bench;
  for (ArmLink& link : bench.model.links) link.viscous_friction = 0.0;
  ArmInertia inertia(bench.model);
  ASSERT_TRUE(inertia.update(Wrist()));
  const auto step = [&] {
    return bench.torques.compose(bench.network, bench.walls, {.friction = 0.0}, bench.v, inertia);
  };
  EXPECT_EQ(step(), 0U);
  bench.network << 100.0, 0.0, 1.0;  // at the wrist, what the heavy joint gives it
  EXPECT_EQ(step(), status::torque_rate);
  EXPECT_EQ(bench.sent(0), 50.0);
  EXPECT_NEAR(bench.sent(2), 0.5, 1e-9);
}

TEST(JointSpeed, IsKeptByAnArmThatIsAskedToGoFasterAndTheStatusSaysSo) {
  test::SliderCell cell(test::push(20.0, 0.25), {.velocity_limit = 0.2, .walls = 0});
  int said = 0;
  for (int tick = 0; tick < 1000; ++tick) {
    const TickRecord& record = cell.tick();
    ASSERT_LT(cell.arm.v[0], 0.2) << "tick " << tick;
    said += (record.status & status::speed_limit) != 0U ? 1 : 0;
    ASSERT_EQ(record.gain, 1.0);
  }
  EXPECT_GT(said, 500);
  EXPECT_GT(cell.arm.v[0], 0.16) << "it must be asked to go on";
}

}  // namespace joint_torques_test
}  // namespace repel
