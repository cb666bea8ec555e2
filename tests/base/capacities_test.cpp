// SPDX-License-Identifier: BSD-3-Clause
#include <repel/base/capacities.hpp>

#include <gtest/gtest.h>

#include <type_traits>

namespace repel {
namespace capacities_test {

TEST(Capacities, ArePlainNumbersThatCanBeNamedOneByOne) {
  static_assert(std::is_aggregate_v<Capacities> && std::is_trivially_copyable_v<Capacities>);
  constexpr Capacities capacities{.bodies = 3, .threads = 2};
  static_assert(capacities.bodies == 3 && capacities.parts == Capacities{}.parts);
}

TEST(Capacities, HoldATwentyThousandPartWorldByDefault) {
  constexpr Capacities capacities;
  EXPECT_GE(capacities.parts, 20000);
  EXPECT_GE(capacities.pairs, 1'000'000);
  EXPECT_GE(capacities.bodies, 2);
  EXPECT_GE(capacities.threads, 1);
}

}  // namespace capacities_test
}  // namespace repel
