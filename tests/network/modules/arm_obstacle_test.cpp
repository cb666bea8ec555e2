// SPDX-License-Identifier: BSD-3-Clause
// Forces on the links become torques on the joints, without generating energy.
#include <gtest/gtest.h>

#include <repel/network/modules.hpp>
#include <repel/network/plan.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace arm_obstacle_test {

constexpr unsigned seed = 37;
constexpr double period = 0.001;

Signals signals_of(int joints) {
  return detail::neutral_signals(joints, period);
}

TEST(ArmObstacle, AddsItsTorquesToThoseFromTheLeft) {
  ArmObstacle module;
  module.fit(Space::joints, 3);
  Signals signals = signals_of(3);
  signals.arm_torques << 1.0, -2.0, 3.0;
  module.read(signals);
  EXPECT_EQ(module.torques(), signals.arm_torques);
  PortState<any_size> left;
  left.effort = Vec<any_size>::Constant(3, 10.0);
  left.flow = Vec<any_size>::Constant(3, 0.5);
  PortState<any_size> right = left;
  module.incident(left, {}, right);
  EXPECT_EQ(right.flow, left.flow);
  EXPECT_EQ(right.effort, left.effort + signals.arm_torques);
}

TEST(ArmObstacle, LetsGoAtRest) {
  ArmObstacle module;
  module.fit(Space::joints, 2);
  Signals signals = signals_of(2);
  signals.arm_torques << 1.0, -2.0;
  signals.released = true;
  module.read(signals);
  EXPECT_EQ(module.torques(), Vec<any_size>::Zero(2));
}

TEST(ArmObstacle, NeverGivesMoreThanItTook) {
  families::Rng rng(seed);
  for (const int joints : {1, 6, 7}) {
    ArmObstacle module;
    module.fit(Space::joints, joints);
    Signals signals = signals_of(joints);
    double energy = 0.0;
    double passed = 0.0;
    int gave = 0;
    const int ticks = families::draws(1000000) / 3;
    for (int tick = 0; tick < ticks; ++tick) {
      for (int i = 0; i < joints; ++i) {
        signals.arm_torques(i) = families::uniform(rng, -50.0, 50.0);
        signals.rates(i) = families::uniform(rng, -2.0, 2.0);
        signals.mean_rates(i) = families::uniform(rng, -2.0, 2.0);
      }
      module.read(signals);
      const double power = -module.torques().dot(signals.rates);
      energy += period * power;
      passed += period * std::abs(power);
      gave += power < 0.0 ? 1 : 0;
      ASSERT_GE(energy, -1e-9 * passed) << "seed " << seed << " tick " << tick;
    }
    EXPECT_GT(gave, ticks / 20) << "the sample must ask for energy";
  }
}

}  // namespace arm_obstacle_test
}  // namespace repel::network
