// SPDX-License-Identifier: BSD-3-Clause
// The response of a position servo, found in logs of servos that are known.
#include <repel/cell/servo_response.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel {
namespace servo_response_test {

struct Log {
  std::vector<double> commanded, measured;
};

// Holds, a ramp of 0.2 rad/s for a second, and holds.
double ramp(double time) {
  return 0.3 + 0.2 * std::clamp(time - 0.3, 0.0, 1.0);
}

/// A servo of second order, critically damped, behind a dead time, by steps of 0.1 ms.
Log of_second_order(double period, double dead_time, double time_constant) {
  Log log;
  constexpr double h = 1e-4;
  double q = ramp(0.0);
  double v = 0.0;
  double time = 0.0;
  for (int k = 0; k * period < 2.0; ++k) {
    for (; time < k * period; time += h) {
      const double w = 1.0 / time_constant;
      v += h * w * (w * (ramp(time - dead_time) - q) - 2.0 * v);
      q += h * v;
    }
    log.commanded.push_back(ramp(k * period));
    log.measured.push_back(q);
  }
  return log;
}

/// Exactly a dead time and a lag.
Log of_first_order(double period, double dead_time, double lag) {
  Log log;
  const auto followed = [&](double time) {
    const auto since = [&](double begun) {
      const double t = std::max(0.0, time - dead_time - begun);
      return t - (lag > 0.0 ? lag * -std::expm1(-t / lag) : 0.0);
    };
    return 0.3 + 0.2 * (since(0.3) - since(1.3));
  };
  for (int k = 0; k * period < 2.0; ++k) {
    log.commanded.push_back(ramp(k * period));
    log.measured.push_back(followed(k * period));
  }
  return log;
}

TEST(ServoResponse, IsFoundAsItIsWhereTheServoHasADeadTimeAndALag) {
  for (const double period : {0.001, 0.002, 0.008}) {
    for (const double dead_time : {0.0, 0.008, 0.1}) {
      for (const double lag : {0.0, 0.03, 0.2}) {
        const Log log = of_first_order(period, dead_time, lag);
        const ServoResponse found = find_response(log.commanded, log.measured, period);
        EXPECT_NEAR(found.response(), dead_time + lag, 0.02 * period) << dead_time << ' ' << lag;
        EXPECT_NEAR(found.dead_time, dead_time, 0.25 * period) << dead_time << ' ' << lag;
        EXPECT_TRUE(found.is_explained());
      }
    }
  }
}

TEST(ServoResponse, OfAServoOfSecondOrderIsTheAreaBetweenTheRates) {
  const Log log = of_second_order(0.002, 0.008, 0.015);
  const ServoResponse found = find_response(log.commanded, log.measured, 0.002);
  EXPECT_NEAR(found.response(), 0.008 + 2 * 0.015, 5e-4);
  EXPECT_GT(found.dead_time, 0.008) << "a rate that begins slowly looks later";
  EXPECT_TRUE(found.is_explained());
}

TEST(ServoResponse, DoesNotDependOnAConstantErrorAndHardlyOnNoise) {
  constexpr unsigned seed = 5;
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0.0, 1e-4);
  Log log = of_first_order(0.002, 0.008, 0.03);
  for (double& q : log.measured) q += 0.01 + noise(generator);
  const ServoResponse found = find_response(log.commanded, log.measured, 0.002);
  EXPECT_NEAR(found.response(), 0.038, 5e-4) << "seed " << seed;
  EXPECT_NEAR(found.error, 1e-4, 2e-5);
}

TEST(ServoResponse, SaysWhereAMotionIsNotThatOfItsCommand) {
  Log log = of_first_order(0.002, 0.008, 0.03);
  for (std::size_t k = 0; k < log.measured.size(); ++k) {
    log.measured[k] = 0.1 * std::sin(0.05 * static_cast<double>(k));
  }
  EXPECT_FALSE(find_response(log.commanded, log.measured, 0.002).is_explained());
  std::fill(log.measured.begin(), log.measured.end(), 0.3);
  EXPECT_FALSE(find_response(log.commanded, log.measured, 0.002).is_explained());
}

TEST(ServoResponse, RefusesLogsThatAreNone) {
  Log log = of_first_order(0.002, 0.008, 0.03);
  EXPECT_THROW((void)find_response(log.commanded, log.measured, 0.0), SetupError);
  log.measured[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)find_response(log.commanded, log.measured, 0.002), SetupError);
  log.measured.pop_back();
  EXPECT_THROW((void)find_response(log.commanded, log.measured, 0.002), SetupError);
  const std::vector<double> few(ServoResponse::fewest - 1);
  EXPECT_THROW((void)find_response(few, few, 0.002), SetupError);
}

}  // namespace servo_response_test
}  // namespace repel
