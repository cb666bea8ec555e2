// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/series_source.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace series_source_test {

using test::period;

constexpr unsigned seed = 41;

struct Torques : JointSource {
  explicit Torques(const Vector& effort) { effort_ = effort; }
};

struct Push : ToolSource {
  explicit Push(const PassivityOptions& options = {}) : ToolSource(checked_passivity(options)) {}
  /// Corrects an effort that does not depend on the motion.
  void push(const Vector& effort, const Signals& signals) {
    effort_ = effort;
    keep_passive(signals, signals.tool_flow());
  }
};

TEST(SeriesSource, AddsItsEffortAtTheSameFlow) {
  Rng rng(seed);
  for (int i = 0; i < families::draws(2000); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "draw", i));
    const int n = families::count_between(rng, 1, 8);
    const Vector effort = test::drawn_vector(rng, n, 10.0);
    DrawnEnds ends(rng, n, 10.0);
    Cell<Torques> cell(Torques(effort), Side::right);
    const auto behind = i % 2 == 0 ? ends.slack() : ends.moved(1.0);
    ASSERT_TRUE(cell.run(Signals{}, behind, ends.definite()));
    EXPECT_EQ(cell.at_leaf.flow, cell.at_root.flow);
    EXPECT_EQ(cell.at_leaf.effort, Vector(cell.at_root.effort - effort));
    EXPECT_LE(cell.error_behind(behind), 1e-9);
  }
}

TEST(JointSource, PushesTheJointsAgainstItsEffort) {
  const Torques source(Vector::Constant(2, -3.0));
  EXPECT_EQ(source.torques(), Vector(Vector::Constant(2, 3.0)));
  Vector torques = Vector::Ones(2);
  source.add_walls({}, torques);
  EXPECT_EQ(torques, Vector(Vector::Constant(2, 4.0)));
}

TEST(ToolSource, HasTheSamePowerAtToolAndJoints) {
  Rng rng(seed);
  DrawnSignals drawn(rng, 6);
  Push source;
  for (int tick = 0; tick < 2000; ++tick) {
    const Signals& signals = drawn.next();
    source.push(test::drawn_vector(rng, 6, 10.0), signals);
    Vector torques = Vector::Zero(6);
    source.add_walls(signals.jacobian, torques);
    const double at_tool = to_vec(source.on_tool()).dot(signals.tool_flow());
    ASSERT_NEAR(torques.dot(signals.rates), at_tool, 1e-9 * (1.0 + std::abs(at_tool)))
        << "tick " << tick << ", seed " << seed;
  }
}

TEST(ToolSource, GivesNoMoreEnergyThanItTookOrIsSupplied) {
  Rng rng(seed);
  DrawnSignals drawn(rng, 6);
  Push source;
  double energy = 0.0;
  double asked = 0.0;
  for (int tick = 0; tick < 20000; ++tick) {
    const Signals& signals = drawn.next();
    const Vector effort = test::drawn_vector(rng, 6, 10.0);
    source.push(effort, signals);
    asked += period * std::max(0.0, -effort.dot(signals.tool_flow()));
    energy -= period * to_vec(source.on_tool()).dot(signals.tool_flow());
    ASSERT_GE(energy, -1e-9 * (1.0 + asked)) << "tick " << tick << ", seed " << seed;
  }
  EXPECT_GT(source.passivity().dissipated, 1.0);  // so it had to be held back
  EXPECT_EQ(source.supplied(), 0.0);
}

TEST(ToolSource, RefusesAControllerOutOfRange) {
  EXPECT_THROW(Push({.most_energy = -1.0}), SetupError);
  EXPECT_THROW(Push({.most_damping = 1e7}), SetupError);
  EXPECT_THROW(Push({.lever = 0.0}), SetupError);
}

}  // namespace series_source_test
}  // namespace repel::network
