// SPDX-License-Identifier: BSD-3-Clause
// Properties of the shaping curve for random options, and the options refused at set-up.
#include <repel/devices/shaping.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <support/draws.hpp>

namespace repel::devices {
namespace shaping_test {

using Uniform = std::uniform_real_distribution<double>;

ShapingOptions drawn(std::mt19937_64& rng) {
  ShapingOptions options;
  options.dead_band = Uniform(0.0, 0.9)(rng);
  options.exponent = Uniform(1.0, 5.0)(rng);
  return options;
}

TEST(Shaping, IsOddMonotoneContinuousAndFullAtTheStop) {
  const std::uint64_t seed = std::random_device{}();
  std::mt19937_64 rng(seed);
  for (int i = 0; i < families::draws(2000); ++i) {
    const ShapingOptions options = drawn(rng);
    const Shaping shaping(options);
    SCOPED_TRACE("seed " + std::to_string(seed) + ", draw " + std::to_string(i));
    ASSERT_EQ(shaping.share(0.0), 0.0);
    ASSERT_EQ(shaping.share(1.0), 1.0);
    ASSERT_EQ(shaping.share(7.0), 1.0);
    // The steepest slope is at the stop: e / (1 - d).
    const double steepest = options.exponent / (1.0 - options.dead_band);
    const double step = 1e-3;
    for (double x = 0.0; x < 1.0; x += step) {
      const double low = shaping.share(x);
      const double high = shaping.share(x + step);
      ASSERT_GE(high, low);
      ASSERT_LE(high - low, 1.0001 * steepest * step);
      ASSERT_EQ(shaping.share(-x), -low);
      ASSERT_EQ(low > 0.0, x > options.dead_band);
    }
  }
}

TEST(Shaping, HasNoStepAtTheEdgeOfTheDeadBand) {
  const Shaping shaping({.dead_band = 0.1});
  EXPECT_EQ(shaping.share(0.1), 0.0);
  EXPECT_GT(shaping.share(0.1001), 0.0);
  EXPECT_LT(shaping.share(0.1001), 2e-4);
}

TEST(Shaping, GivesTheScaleAtFullTravelOnTheAxesTheMapNames) {
  const Shaping shaping({.full_travel = 350.0, .linear_scale = 0.2, .angular_scale = 0.8});
  // spacenavd: x right, y up, z forward; repel: x forward, y left, z up.
  const Twist right = shaping.twist(std::array<double, 6>{350, 0, 0, 0, 0, 0});
  EXPECT_TRUE(right.linear.isApprox(Vec3(0.0, -0.2, 0.0)));
  const Twist up = shaping.twist(std::array<double, 6>{0, 350, 0, 0, 0, 0});
  EXPECT_TRUE(up.linear.isApprox(Vec3(0.0, 0.0, 0.2)));
  const Twist forward = shaping.twist(std::array<double, 6>{0, 0, 350, 0, 0, 0});
  EXPECT_TRUE(forward.linear.isApprox(Vec3(0.2, 0.0, 0.0)));
  const Twist about_up = shaping.twist(std::array<double, 6>{0, 0, 0, 0, -350, 0});
  EXPECT_TRUE(about_up.angular.isApprox(Vec3(0.0, 0.0, -0.8)));
  EXPECT_TRUE(about_up.linear.isZero(0.0));
}

TEST(Shaping, TakesWhatIsNotFiniteForRest) {
  const Shaping shaping;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(shaping.share(nan), 0.0);
  EXPECT_EQ(shaping.share(infinity), 0.0);
  const Twist twist = shaping.twist(std::array<double, 6>{nan, infinity, 350, -infinity, nan, nan});
  EXPECT_TRUE(twist.linear.isApprox(Vec3(0.25, 0.0, 0.0)));
  EXPECT_TRUE(twist.angular.isZero(0.0));
}

void expect_refused(const ShapingOptions& options, const std::string& says) {
  try {
    const Shaping shaping(options);
    FAIL() << "accepted: " << says;
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
  }
}

TEST(Shaping, RefusesWhatIsOutOfRangeWithValueAndRange) {
  expect_refused({.full_travel = 0.0}, "full travel is 0 counts; allowed: 1 to 10000 counts");
  expect_refused({.dead_band = 0.95}, "dead band is 0.95 of full travel; allowed: 0 to 0.9");
  expect_refused({.exponent = 0.5}, "exponent is 0.5");
  expect_refused({.linear_scale = 11.0}, "linear scale is 11 m/s; allowed: 0 to 10 m/s");
  expect_refused({.angular_scale = std::nan("")}, "angular scale is nan rad/s");
  ShapingOptions options;
  options.axes[4].axis = 6;
  expect_refused(options, "axis of a device is 6; allowed: 0 to 5");
  options = {};
  options.axes[1].sign = 0.5;
  expect_refused(options, "sign of an axis is 0.5; allowed: 1 and -1");
}

}  // namespace shaping_test
}  // namespace repel::devices
