// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/turn.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <support/families.hpp>

namespace repel {
namespace turn_test {

using detail::all_of;
using detail::turns_of;

double turn_of(double y, double x) {
  return turns_of(all_of(y), all_of(x))[0];
}

TEST(Turn, IsThatOfTheStandardLibrary) {
  families::Rng rng(7);
  double most = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    const double angle = families::uniform(rng, -M_PI, M_PI);
    const double length = families::log_uniform(rng, 1e-12, 1e6);
    const double x = length * std::cos(angle);
    const double y = length * std::sin(angle);
    most = std::max(most, std::abs(turn_of(y, x) - std::atan2(y, x)));
  }
  EXPECT_LE(most, 1e-13) << "seed 7";
}

TEST(Turn, OfAxesAndDiagonals) {
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      EXPECT_NEAR(turn_of(y, x), std::atan2(y, x), 1e-13) << y << ", " << x;
    }
  }
}

}  // namespace turn_test
}  // namespace repel
