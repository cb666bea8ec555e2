// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/attraction.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "support/families.hpp"

namespace repel::network {
namespace attraction_test {

constexpr unsigned seed = 5;

AttractionLimits drawn(families::Rng& rng) {
  return {.stiffness = families::log_uniform(rng, 10.0, 1e5),
          .most_force = families::log_uniform(rng, 1.0, 100.0),
          .range = families::log_uniform(rng, 1e-3, 0.5),
          .most_energy = families::log_uniform(rng, 1e-3, 10.0)};
}

// Over draws in which the force, the range and the energy are what limits it.
TEST(Attraction, IsTheSlopeOfItsPotentialAndKeepsAllLimits) {
  families::Rng rng(seed);
  int by_force = 0, by_range = 0, by_energy = 0;
  for (int draw = 0; draw < 2000; ++draw) {
    const AttractionLimits limits = drawn(rng);
    const Attraction attraction(limits, draw % 2 == 1);
    const double r = limits.range, k = limits.stiffness;
    SCOPED_TRACE(families::of_seed(seed, "draw", draw));
    EXPECT_LE(attraction.peak(), limits.most_force * (1.0 + 1e-12));
    EXPECT_LE(attraction.depth(), limits.most_energy * (1.0 + 1e-9));
    EXPECT_NEAR(attraction.border(), r, 1e-12 * r);
    const bool is_at_force = attraction.peak() > 0.999 * limits.most_force;
    const bool is_at_energy = attraction.depth() > 0.999 * limits.most_energy;
    by_force += is_at_force ? 1 : 0;
    by_energy += is_at_energy ? 1 : 0;
    by_range += !is_at_force && !is_at_energy ? 1 : 0;
    double highest = 0.0;
    constexpr int steps = 400;
    const double h = 1.1 * r / steps;
    for (int i = 0; i < steps; ++i) {
      const double d = i * h;
      const double f = attraction.force(d);
      highest = std::max(highest, f);
      // The error of the trapezoid rule: slopes change by at most k / (e or a) over a step.
      const double work = attraction.energy(d + h) - attraction.energy(d);
      ASSERT_NEAR(work, 0.5 * (f + attraction.force(d + h)) * h, 0.13 * k * h * h) << d;
      ASSERT_LE(std::abs(attraction.force(d + h) - f), k * h * (1.0 + 1e-9)) << d;
      ASSERT_LE(f, k * d * (1.0 + 1e-12));
      ASSERT_GE(attraction.damping_share(d + h), 0.0);
      ASSERT_LE(attraction.damping_share(d + h), 1.0);
    }
    EXPECT_NEAR(highest, attraction.peak(), 0.02 * attraction.peak());
    EXPECT_EQ(attraction.force(r), 0.0);
    EXPECT_EQ(attraction.force(0.0), 0.0);
    EXPECT_EQ(attraction.energy(2.0 * r), attraction.depth());
  }
  EXPECT_GT(by_force, 100);
  EXPECT_GT(by_range, 100);
  EXPECT_GT(by_energy, 100);
}

// The force has no kink at its border, nor at a soft start.
TEST(Attraction, BeginsAndEndsWithoutASlope) {
  const AttractionLimits limits;
  for (const bool soft : {false, true}) {
    const Attraction attraction(limits, soft);
    const double r = limits.range;
    EXPECT_LE(attraction.force(r - 1e-6) / 1e-6, 0.01 * limits.stiffness);
    const double start = attraction.force(1e-6) / 1e-6;
    EXPECT_NEAR(start, soft ? 0.0 : limits.stiffness, 0.01 * limits.stiffness);
  }
}

// Where the spring is stiff, its damper is there as well.
TEST(Attraction, DampsInProportionToItsSlopeAtASoftStart) {
  const AttractionLimits limits;
  const Attraction attraction(limits, true);
  for (double d = 1e-5; d < 0.3 * limits.range; d += 1e-4) {
    const double slope = (attraction.force(d + 1e-7) - attraction.force(d - 1e-7)) / 2e-7;
    EXPECT_GE(attraction.damping_share(d) * (1.0 + 1e-3), slope / limits.stiffness) << d;
  }
}

TEST(Attraction, WithoutStiffnessIsNothing) {
  const Attraction attraction({.stiffness = 0.0});
  EXPECT_EQ(attraction.force(0.01), 0.0);
  EXPECT_EQ(attraction.energy(0.01), 0.0);
  EXPECT_EQ(attraction.damping_share(0.01), 0.0);
}

TEST(Attraction, RefusesNumbersOutOfRange) {
  EXPECT_THROW(Attraction({.stiffness = -1.0}), SetupError);
  EXPECT_THROW(Attraction({.most_force = 0.0}), SetupError);
  EXPECT_THROW(Attraction({.range = 0.0}), SetupError);
  EXPECT_THROW(Attraction({.most_energy = std::nan("")}), SetupError);
}

TEST(ShareWithin, IsTheLargestThatFits) {
  families::Rng rng(seed);
  int cut = 0, none = 0;
  for (int i = 0; i < 10000; ++i) {
    const Vec3 spring = families::uniform(rng, 0.0, 11.0) * families::direction(rng);
    const Vec3 damper = families::uniform(rng, 0.0, 30.0) * families::direction(rng);
    const double share = share_within(spring, damper, 10.0);
    SCOPED_TRACE(families::of_seed(seed, "draw", i));
    ASSERT_GE(share, 0.0);
    ASSERT_LE(share, 1.0);
    const double length = (spring + Vec3(share * damper)).norm();
    ASSERT_LE(length, std::max(10.0, spring.norm()) * (1.0 + 1e-9));
    if (share > 0.0 && share < 1.0 && spring.norm() < 10.0) {
      ASSERT_NEAR(length, 10.0, 1e-9);
      ++cut;
    }
    none += share == 0.0 ? 1 : 0;
  }
  EXPECT_GT(cut, 1000);
  EXPECT_GT(none, 100);
  EXPECT_EQ(share_within({1, 0, 0}, {0, 0, 0}, 10.0), 1.0);
}

}  // namespace attraction_test
}  // namespace repel::network
