// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/obstacle.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace obstacle_test {

using test::period;

constexpr unsigned seed = 23;

/// Tool and joint coincide, along x.
Signals along_x(double force, double rate, double mean_rate) {
  Signals signals;
  signals.joints = signals.rates = signals.mean_rates = Vector::Zero(1);
  signals.rates(0) = rate;
  signals.mean_rates(0) = mean_rate;
  signals.jacobian.setZero(6, 1);
  signals.jacobian(0, 0) = 1.0;
  signals.walls.force = Vec3(force, 0.0, 0.0);
  signals.period = period;
  return signals;
}

// `draw` ticks with forces independent of any motion: far worse than any wall.
void push_at_random(const ObstacleOptions& options, int ticks) {
  Rng rng(seed);
  DrawnSignals drawn(rng, 6);
  Obstacle obstacle(options);
  double account = 0.0;
  double passed = 0.0;
  int corrected = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    const Signals& signals = drawn.next();
    obstacle.read(signals);
    const Vector flow = signals.tool_flow();
    const double asked = to_vec(signals.walls).dot(flow);  // power to the tool
    const double given = to_vec(obstacle.on_tool()).dot(flow);
    const double rounding = 1e-10 * (1.0 + std::abs(asked));
    if (signals.released) {
      ASSERT_EQ(to_vec(obstacle.on_tool()).norm(), 0.0);
      continue;
    }
    ASSERT_LE(given, asked + rounding) << "tick " << tick << ", seed " << seed;
    // On the way out it may push less, but never resist; it never pulls where it pushed.
    if (asked >= 0.0) {
      ASSERT_GE(given, -rounding) << "tick " << tick << ", seed " << seed;
    }
    account -= period * given;
    passed += period * std::abs(given);
    ASSERT_GE(account, -1e-9 * (1e-3 + passed)) << "tick " << tick << ", seed " << seed;
    corrected += given < asked - rounding ? 1 : 0;
  }
  EXPECT_GT(corrected, ticks / 50);
  EXPECT_LT(corrected, ticks * 9 / 10);
  EXPECT_GT(obstacle.passivity().dissipated, 0.0);
}

TEST(Obstacle, NeverGivesMoreThanItTookNorTurnsItsForceRound) {
  const int ticks = families::draws(1000000) / 4;
  push_at_random({}, ticks);
  push_at_random({{.most_energy = 0.0}}, ticks);
  push_at_random({{.most_damping = 1e6}}, ticks);
  push_at_random({{.lever = 1e-3}}, ticks);
}

TEST(Obstacle, AddsItsForceOnTheSameFlowWithALedgerAboveZero) {
  for (const Side root : {Side::left, Side::right}) {
    Rng rng(seed);
    DrawnSignals drawn(rng, 6);
    DrawnEnds ends(rng, 6, 20.0);
    Cell cell(Obstacle(), root);
    for (int tick = 0; tick < families::draws(100000); ++tick) {
      const Signals& signals = drawn.next();
      Equivalent<any_size> measured;
      measured.set_admittance(test::Matrix::Zero(6, 6), signals.tool_flow());
      const auto behind = tick % 2 == 0 ? ends.slack() : ends.definite();
      ASSERT_TRUE(cell.run(signals, behind, measured));
      ASSERT_EQ(cell.at_root.flow, cell.at_leaf.flow);
      const Vector added = cell.at_leaf.effort - cell.at_root.effort;
      const double scale = 1.0 + cell.at_leaf.effort.norm();
      ASSERT_LE((added - to_vec(cell.module.on_tool())).norm(), 1e-12 * scale);
      ASSERT_LE(cell.error_behind(behind), 1e-9);
    }
    EXPECT_GT(cell.ledger.passed, 1.0);
    EXPECT_LE(cell.ledger.deficit(), 1e-9) << test::to_text(root) << ", seed " << seed;
  }
}

// A wall that returns less force than on the way in is passed on unchanged.
TEST(Obstacle, LeavesAWallThatTakesEnergyAlone) {
  Obstacle obstacle;
  for (int tick = 0; tick < 200; ++tick) {
    obstacle.read(along_x(-20.0, 0.1, 0.1));
    EXPECT_EQ(obstacle.on_tool().force.x(), -20.0);
  }
  for (int tick = 0; tick < 200; ++tick) {
    obstacle.read(along_x(-10.0, -0.1, -0.1));
    EXPECT_EQ(obstacle.on_tool().force.x(), -10.0);
  }
  EXPECT_EQ(obstacle.passivity().dissipated, 0.0);
}

TEST(Obstacle, HoldsAToolThatStartsInsideAWallAndDoesNotThrowItOut) {
  Obstacle obstacle;
  for (int tick = 0; tick < 100; ++tick) {
    obstacle.read(along_x(-50.0, 0.0, 0.0));
    EXPECT_EQ(obstacle.on_tool().force.x(), -50.0);
  }
  obstacle.read(along_x(-50.0, -0.01, -0.01));
  EXPECT_NEAR(obstacle.on_tool().force.x(), 0.0, 1e-12);
}

// The motion of a period is known only at its end; the wall has kept pushing meanwhile.
TEST(Obstacle, TakesBackWhatSamplingGaveAsSoonAsItIsPressedAgain) {
  Obstacle obstacle({{.most_damping = 1e6}});
  obstacle.read(along_x(-10.0, 0.1, 0.1));
  obstacle.read(along_x(-10.0, -0.001, -0.4));  // the tool was thrown back within the period
  EXPECT_GT(obstacle.passivity().owed, 0.0);
  EXPECT_LE(obstacle.on_tool().force.x(), 1e-12);
  obstacle.read(along_x(0.0, -0.4, 0.0));  // out of the wall: owed, and not resisted
  EXPECT_EQ(obstacle.on_tool().force.x(), 0.0);
  const double owed = obstacle.passivity().owed;
  EXPECT_GT(owed, 0.0);
  obstacle.read(along_x(-1.0, 0.5, 0.5));
  EXPECT_LT(obstacle.on_tool().force.x(), -1.0);
  obstacle.read(along_x(-1.0, 0.5, 0.5));
  EXPECT_LT(obstacle.passivity().owed, owed);
}

TEST(Obstacle, RefusesNumbersOutOfRange) {
  EXPECT_THROW(Obstacle({{.most_energy = -1.0}}), SetupError);
  EXPECT_THROW(Obstacle({{.most_damping = std::nan("")}}), SetupError);
  EXPECT_THROW(Obstacle({{.lever = 0.0}}), SetupError);  // a rotation could not be damped
  EXPECT_THROW(Obstacle({{.lever = 101.0}}), SetupError);
}

}  // namespace obstacle_test
}  // namespace repel::network
