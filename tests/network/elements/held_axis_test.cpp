// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/held_axis.hpp>

#include <gtest/gtest.h>

#include <repel/network/machinery/ledger.hpp>
#include "network/drawn.hpp"

namespace repel::network {
namespace held_axis_test {

using test::period;

constexpr unsigned seed = 606;

TEST(HeldAxis, GivesNoMoreThanItTookAndTheHandSupplied) {
  families::Rng rng(seed);
  for (const double limit : {0.0, 2.0, 1e3}) {
    SCOPED_TRACE("limit " + std::to_string(limit) + ", seed " + std::to_string(seed));
    HeldAxis axis({.inertia = 0.3,
                   .friction = 1.0,
                   .hand_stiffness = 300.0,
                   .hand_damping = 10.0,
                   .limit = limit},
                  period);
    Ledger ledger;
    int saturated = 0;
    for (int tick = 0; tick < families::draws(100000); ++tick) {
      axis.move(families::uniform(rng, -0.3, 0.3), false);
      const double a = families::uniform(rng, -30.0, 30.0);
      const double b = axis.reflected();
      axis.incident(a);
      const double in = (a * a - b * b) / (4.0 * axis.resistance());
      ledger.add(period * in, period * std::abs(in), period * axis.supplied());
      ASSERT_LE(std::abs(axis.felt()), limit * (1.0 + 1e-12) + 1e-12);
      saturated += axis.saturated() ? 1 : 0;
    }
    EXPECT_GT(ledger.passed, 1.0);
    EXPECT_LE(ledger.deficit(), 1e-9);
    EXPECT_EQ(saturated > 0, limit < 100.0);
  }
}

TEST(HeldAxis, FollowsTheHandAndYieldsByEffortOverStiffness) {
  HeldAxis axis({.inertia = 0.3,
                 .friction = 0.0,
                 .hand_stiffness = 300.0,
                 .hand_damping = 10.0,
                 .limit = 30.0},
                period);
  const auto push = [&](double effort, double hand) {
    axis.move(hand, false);
    // f = (a + b) / 2
    axis.incident(2.0 * effort - axis.reflected());
  };
  for (int tick = 0; tick < 4000; ++tick) push(6.0, 0.0);
  EXPECT_NEAR(axis.position(), 6.0 / 300.0, 1e-6);
  EXPECT_NEAR(axis.felt(), 6.0, 1e-9);
  for (int tick = 0; tick < 4000; ++tick) push(0.0, 0.1);
  EXPECT_NEAR(axis.rate(), 0.1, 1e-6);
  axis.move(0.0, true);
  EXPECT_EQ(axis.rate(), 0.0);
  EXPECT_EQ(axis.reflected(), 0.0);
}

}  // namespace held_axis_test
}  // namespace repel::network
