// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/joint_watch.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include <repel/base/setup_error.hpp>

#include "loop/slider.hpp"

namespace repel {
namespace joint_watch_test {

constexpr double period = 0.0025;
constexpr unsigned seed = 311;

/// Three sliders of 5 kg that move under the forces on them.
struct Bench {
  explicit Bench(const JointWatchOptions& options = {})
      : model(test::slider_model(100.0)), watch(model, period, options), inertia(model) {
    (void)inertia.update(test::SliderKinematics());
    net.setZero(3);
  }
  /// One period of the motion.
  void move() {
    for (int i = 0; i < 3; ++i) {
      v[i] += period * (net(i) - 20.0 * v[i]) / 5.0;
      q[i] += period * v[i];
    }
  }
  /// The same, followed by a reading.
  Status step() {
    move();
    return read(q, v);
  }
  Status read(const std::vector<double>& read_q, const std::vector<double>& read_v) {
    const Status status = watch.step(read_q, read_v, period, inertia.matrix());
    JointWatch::Vector rate(3);
    for (int i = 0; i < 3; ++i) rate(i) = watch.rate(i) + period * net(i) / 5.0;
    watch.expect(net, net, std::vector<double>(3, 0.0), rate, false);
    return status;
  }

  ArmModel model;
  JointWatch watch;
  ArmInertia inertia;
  JointWatch::Vector net;  // [N]
  std::vector<double> q{0.1, 0.2, 0.3}, v{0.0, 0.0, 0.0};
};

TEST(JointWatch, BelievesASoundArmWhateverMovesIt) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> force(-100.0, 100.0);
  Bench bench;
  double top = 0.0;
  for (int tick = 0; tick < 20000; ++tick) {
    if (tick % 40 == 0) {
      for (int i = 0; i < 3; ++i) bench.net(i) = force(rng);
    }
    ASSERT_EQ(bench.step(), 0U) << "tick " << tick << ", seed " << seed;
    ASSERT_EQ(bench.watch.position(1), bench.q[1]);
    ASSERT_EQ(bench.watch.rate(2), bench.v[2]);
    top = std::max(top, std::abs(bench.v[0]));
  }
  EXPECT_GT(top, 1.0);  // [m/s]
}

TEST(JointWatch, BelievesReadingsWithNoiseAndJitter) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  Bench bench;
  for (int tick = 0; tick < 20000; ++tick) {
    bench.net(0) = 40.0 * std::sin(0.01 * tick);
    bench.move();
    std::vector<double> q = bench.q;
    std::vector<double> v = bench.v;
    for (int i = 0; i < 3; ++i) {
      q[i] += 1e-4 * noise(rng) + (rng() % 2 == 0 ? 0.2 : -0.2) * period * v[i];
      v[i] += 0.02 * noise(rng);
    }
    ASSERT_EQ(bench.read(q, v), 0U) << "tick " << tick << ", seed " << seed;
  }
}

TEST(JointWatch, LosingAllSpeedAtOnceIsPossibleAndGainingItIsNot) {
  Bench bench;
  bench.net(0) = 20.0;
  for (int tick = 0; tick < 400; ++tick) ASSERT_EQ(bench.step(), 0U);
  const double rate = bench.v[0];
  ASSERT_GT(rate, 0.5);
  bench.q[0] += 0.5 * period * rate;
  bench.v[0] = 0.0;
  bench.net(0) = 0.0;
  EXPECT_EQ(bench.read(bench.q, bench.v), 0U);
  bench.v[0] = rate;
  bench.q[0] += 0.5 * period * rate;
  EXPECT_EQ(bench.read(bench.q, bench.v), status::implausible_joints);
}

TEST(JointWatch, PredictsTheMotionWhileReadingsAreNotBelieved) {
  Bench bench;
  bench.net(0) = 4.0;
  for (int tick = 0; tick < 400; ++tick) ASSERT_EQ(bench.step(), 0U);
  const double q = bench.q[0];
  const double v = bench.v[0];
  for (int tick = 1; tick <= 8; ++tick) {
    (void)bench.read({std::nan(""), 0.2, 0.3}, bench.v);
    EXPECT_NEAR(bench.watch.position(0), q + tick * period * v, 2e-3);
  }
  EXPECT_FALSE(bench.watch.knows_nothing());
}

TEST(JointWatch, AJointThatJumpedIsNotBelievedUntilItIsBack) {
  Bench bench;
  for (int tick = 0; tick < 10; ++tick) ASSERT_EQ(bench.step(), 0U);
  std::vector<double> off = bench.q;
  off[1] += 0.1;
  for (int tick = 0; tick < 40; ++tick) {
    ASSERT_EQ(bench.read(off, bench.v), status::implausible_joints) << tick;
  }
  int needed = 0;
  while (bench.read(bench.q, bench.v) != 0U) ASSERT_LT(++needed, 10);
  EXPECT_GE(needed, 3);
  EXPECT_EQ(bench.watch.position(1), bench.q[1]);
}

// It was believed again after four readings that agreed with each other, 0.1 m beside the truth.
TEST(JointWatch, AJointThatSlippedIsNotBelievedUntilItsPositionIsConfirmed) {
  Bench bench;
  bench.net(1) = 4.0;
  for (int tick = 0; tick < 100; ++tick) ASSERT_EQ(bench.step(), 0U);
  bench.net(1) = 0.0;
  for (int tick = 0; tick < 4000; ++tick) {
    bench.move();
    std::vector<double> slipped = bench.q;
    slipped[1] += 0.1;
    ASSERT_NE(bench.read(slipped, bench.v), 0U) << tick;
  }
  bench.watch.confirm();
  int needed = 0;
  while (bench.step() != 0U) ASSERT_LT(++needed, 10);
}

// A false alarm: the readings themselves went on all the time, the prediction went elsewhere.
TEST(JointWatch, ReadingsThatFollowFromEachOtherAreBelievedAgain) {
  Bench bench;
  for (int tick = 0; tick < 10; ++tick) ASSERT_EQ(bench.step(), 0U);
  bench.v[0] = 3.0;  // faster than any torque could have made it
  bench.q[0] += 0.5 * period * 3.0;
  ASSERT_EQ(bench.read(bench.q, bench.v), status::implausible_joints);
  int needed = 0;
  while (bench.step() != 0U) ASSERT_LT(++needed, 10);
  EXPECT_EQ(bench.watch.position(0), bench.q[0]);
}

TEST(JointWatch, WhoIsLostAgainAndAgainIsBelievedLater) {
  Bench bench;
  int last = 0;
  for (int loss = 0; loss < 5; ++loss) {
    for (int tick = 0; tick < 40; ++tick) ASSERT_EQ(bench.step(), 0U);
    (void)bench.read({std::nan(""), 0.2, 0.3}, bench.v);
    int needed = 0;
    while (bench.step() != 0U) ASSERT_LT(++needed, 100);
    EXPECT_GT(needed, last);
    last = needed;
  }
}

TEST(JointWatch, WhatMayBeReportedAgainCanBeStated) {
  for (const int repeats : {1, 4}) {
    Bench bench({.repeats = repeats});
    bench.net(0) = 2.0;
    for (int tick = 0; tick < 400; ++tick) ASSERT_EQ(bench.step(), 0U);
    int again = 0;
    while (bench.read(bench.q, bench.v) == 0U) ASSERT_LT(++again, 20);
    EXPECT_EQ(again, repeats);
  }
}

TEST(JointWatch, AJointAtRestMayReportTheSameForEver) {
  Bench bench;
  bench.model.links[0].coulomb_friction = 10.0;
  bench.net(0) = 4.0;  // balanced by its friction
  for (int tick = 0; tick < 4000; ++tick) ASSERT_EQ(bench.read(bench.q, bench.v), 0U);
}

// A wrist of little inertia and much friction stops within a period, even at 100 Hz at the position
// of the last reading.
TEST(JointWatch, AJointThatItsFrictionStopsAtOnceIsBelieved) {
  Bench bench;
  bench.model.links[0].coulomb_friction = 400.0;
  bench.net(0) = 4.0;
  for (int tick = 0; tick < 100; ++tick) ASSERT_EQ(bench.step(), 0U);
  ASSERT_GT(bench.v[0], 0.05);
  bench.v[0] = 0.0;
  for (int tick = 0; tick < 400; ++tick) ASSERT_EQ(bench.read(bench.q, bench.v), 0U) << tick;
  // Without friction it cannot have stopped there.
  bench.model.links[0].coulomb_friction = 0.0;
  for (int tick = 0; tick < 100; ++tick) ASSERT_EQ(bench.step(), 0U);
  bench.v[0] = 0.0;
  Status found = 0;
  for (int tick = 0; tick < 3; ++tick) found |= bench.read(bench.q, bench.v);
  EXPECT_EQ(found, status::frozen_joints);
}

TEST(JointWatch, OptionsOutOfRangeAreRefused) {
  const ArmModel model = test::slider_model(100.0);
  EXPECT_THROW(JointWatch(model, period, {.position_noise = -1.0}), SetupError);
  EXPECT_THROW(JointWatch(model, period, {.mass_uncertainty = 0.5}), SetupError);
  EXPECT_THROW(JointWatch(model, period, {.regain = 0}), SetupError);
}

}  // namespace joint_watch_test
}  // namespace repel
