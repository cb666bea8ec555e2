#include <repel/base/limits.hpp>

#include <gtest/gtest.h>

#include <type_traits>

namespace repel {
namespace limits_test {

TEST(Limits, ArePlainNumbersThatCanBeNamedOneByOne) {
  static_assert(std::is_aggregate_v<Limits> && std::is_trivially_copyable_v<Limits>);
  constexpr Limits limits{.bodies = 3, .threads = 2};
  static_assert(limits.bodies == 3 && limits.parts == Limits{}.parts);
}

TEST(Limits, HoldATwentyThousandPartWorldByDefault) {
  constexpr Limits limits;
  EXPECT_GE(limits.parts, 20000);
  EXPECT_GE(limits.pairs, 1'000'000);
  EXPECT_GE(limits.bodies, 2);
  EXPECT_GE(limits.threads, 1);
}

}  // namespace limits_test
}  // namespace repel
