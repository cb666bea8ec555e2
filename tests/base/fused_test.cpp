// SPDX-License-Identifier: BSD-3-Clause
// What a user gets who compiles the headers for a machine that fuses products with sums.
#include <repel/reduction/separation.hpp>

#include <gtest/gtest.h>

#include <support/families.hpp>

#include "double_double_test.cpp"

namespace repel {
namespace fused_test {

// The bounds of gaps this narrow come from extended precision; they crossed in nearly all of them.
TEST(Fused, TheBoundsOfNarrowGapsDoNotCross) {
  constexpr unsigned seed = 8;
  families::Rng rng(seed);
  const Shape box = Shape::box({0.1, 0.08, 0.05});
  const Shape egg = Shape::ellipsoid({0.1, 0.2, 0.15});
  int narrow = 0;
  for (int i = 0; i < 500; ++i) {
    Pose X = families::random_pose(rng, 0.0, 0.0);
    X.translation() = 0.5 * families::direction(rng);
    Separation s = separation(box, X, egg, Pose::Identity());
    if (!(s.distance > 0.0)) continue;
    X.translation() -= (s.distance - 1e-8) * s.extraction_W;
    s = separation(box, X, egg, Pose::Identity());
    ASSERT_LE(s.lower, s.distance) << "seed " << seed << ", gap " << i;
    ASSERT_LE(s.distance, s.upper) << "seed " << seed << ", gap " << i;
    narrow += s.upper < 1.1e-8 ? 1 : 0;
  }
  EXPECT_GT(narrow, 400) << "seed " << seed;
}

}  // namespace fused_test
}  // namespace repel
