// SPDX-License-Identifier: BSD-3-Clause
#include <repel/force/law_lanes.hpp>

#include <gtest/gtest.h>

#include <repel/base/double_double.hpp>

#include "support/families.hpp"

namespace repel::detail {
namespace law_lanes_test {

// The two must agree bitwise, or a pair's force would jump when it moves into a lane.
TEST(LawLanes, AreTheLawsOneByOne) {
  constexpr unsigned seed = 41;
  families::Rng random(seed);
  int pushing = 0, capped = 0;
  for (int round = 0; round < 3000; ++round) {
    LawLanes lanes;
    std::array<ForceLaw, lane_count> laws;
    Lanes distance{}, rate{};
    for (int k = 0; k < lane_count; ++k) {
      ForceLaw& law = laws[static_cast<std::size_t>(k)];
      law = {.range = families::uniform(random, 0.001, 0.1),
             .surface_force = families::uniform(random, 0.0, 200.0),
             .damping = families::uniform(random, 0.0, 100.0)};
      if (round % 3 == 0) law.ceiling = families::uniform(random, 0.0, 100.0);
      lanes.set(k, law);
      distance[k] = families::uniform(random, -0.05, 0.12);
      rate[k] = families::uniform(random, -0.5, 0.5);
    }
    const Lanes size = lanes(distance, rate);
    for (int k = 0; k < lane_count; ++k) {
      const ForceLaw& law = laws[static_cast<std::size_t>(k)];
      ASSERT_EQ(size[k], law(distance[k], rate[k])) << "round " << round << ", seed " << seed;
      pushing += size[k] > 0.0 ? 1 : 0;
      capped += size[k] > 0.0 && size[k] == law.ceiling ? 1 : 0;
    }
  }
  EXPECT_GT(pushing, 1000);
  EXPECT_GT(capped, 100);
}

// One formula for all number types: in extended precision it agrees to the last digits.
TEST(LawLanes, AreTheFormulaOfExtendedPrecision) {
  constexpr unsigned seed = 43;
  families::Rng random(seed);
  for (int round = 0; round < 3000; ++round) {
    const ForceLaw law{.range = families::uniform(random, 0.001, 0.1),
                       .surface_force = families::uniform(random, 0.0, 200.0),
                       .damping = families::uniform(random, 0.0, 100.0)};
    const LawFormula<DoubleDouble> exact{law.range, law.surface_force, law.damping, 1e9};
    const double distance = families::uniform(random, -0.05, 0.12);
    const double rate = families::uniform(random, -0.5, 0.5);
    const double force = exact(distance, rate).hi;
    ASSERT_NEAR(law(distance, rate), force, 1e-12 * (1.0 + force) + 1e-12 * law.surface_force)
        << "round " << round << ", seed " << seed;
  }
}

}  // namespace law_lanes_test
}  // namespace repel::detail
