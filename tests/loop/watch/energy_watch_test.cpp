// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/energy_watch.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <repel/base/setup_error.hpp>

namespace repel {
namespace energy_watch_test {

constexpr double T = 0.0025;

/// Feeds a constant power by sampling [W] for a time [s]; returns the status bits seen.
Status feed(EnergyWatch& watch, double& energy, double power, double time) {
  Status seen = 0;
  for (double t = 0.0; t < time; t += T) seen |= watch.step(energy += T * power, T);
  return seen;
}

TEST(EnergyWatch, WhatIsGainedSlowlyIsNoFaultAndDoesNotBrake) {
  EnergyWatch watch(T);
  double energy = 0.0;
  EXPECT_EQ(feed(watch, energy, 0.8, 60.0), 0U);
  EXPECT_EQ(watch.brake(), 0.0);
  EXPECT_NEAR(watch.gained(), 0.8, 0.01);  // of the last second
}

TEST(EnergyWatch, BrakesInProportionAndThenReports) {
  EnergyWatch watch(T);
  double energy = 0.0;
  EXPECT_EQ(feed(watch, energy, 3.0, 10.0), 0U);
  EXPECT_NEAR(watch.brake(), 0.5, 0.01);  // midway from 1 to 5 J
  EXPECT_EQ(feed(watch, energy, 20.0, 1.0), status::energy_gain);
  EXPECT_EQ(watch.brake(), 1.0);
}

// What a sampled arm gains by its own acceleration grows with the period.
TEST(EnergyWatch, AllowsMoreAtLowRates) {
  EnergyWatch slow(0.01);
  EXPECT_EQ(slow.step(19.0, 0.01), 0U);
  EXPECT_EQ(slow.step(22.0, 0.01), status::energy_gain);
}

TEST(EnergyWatch, NothingIsWatchedBelowTenTicksASecond) {
  EnergyWatch watch(1.0);
  EXPECT_EQ(watch.step(1e9, 1.0), 0U);
  EXPECT_EQ(watch.brake(), 0.0);
}

TEST(EnergyWatch, ForgetsAFaultThatIsOver) {
  EnergyWatch watch(T);
  double energy = 0.0;
  EXPECT_EQ(feed(watch, energy, 1000.0, 0.01), status::energy_gain);
  (void)feed(watch, energy, 0.0, 5.0);
  EXPECT_EQ(watch.step(energy, T), 0U);
  EXPECT_EQ(watch.brake(), 0.0);
}

TEST(EnergyWatch, WhatIsNoNumberIsAFaultAndForgotten) {
  EnergyWatch watch(T);
  double energy = 0.0;
  EXPECT_EQ(watch.step(std::nan(""), T), status::energy_gain);
  EXPECT_EQ(feed(watch, energy, 0.0, 1.0), 0U);
  EXPECT_EQ(feed(watch, energy, 1000.0, 0.01), status::energy_gain) << "it still watches";
}

TEST(EnergyWatch, AFaultThatIsLatchedStaysLongerEachTime) {
  EnergyWatch watch(T, {.latch = 1.0});
  double energy = 0.0;
  for (const double stays : {1.0, 2.0, 4.0}) {
    ASSERT_EQ(feed(watch, energy, 1000.0, 0.01), status::energy_gain);
    double time = 0.0;
    while (watch.step(energy, T) != 0U) ASSERT_LT(time += T, 10.0);
    EXPECT_GE(time, stays - 2.0 * T);
  }
}

// An arm that gave a lot back may not gain as much unseen.
TEST(EnergyWatch, WhatWasGivenBackIsNoCredit) {
  EnergyWatch watch(T);
  double energy = 0.0;
  (void)feed(watch, energy, -100.0, 1.0);
  EXPECT_EQ(feed(watch, energy, 100.0, 0.1), status::energy_gain);
}

TEST(EnergyWatch, OptionsOutOfRangeAreRefused) {
  EXPECT_THROW(EnergyWatch(T, {.taken_back = 6.0}), SetupError);
  EXPECT_THROW(EnergyWatch(T, {.memory = 0.0}), SetupError);
}

}  // namespace energy_watch_test
}  // namespace repel
