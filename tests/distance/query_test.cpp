// SPDX-License-Identifier: BSD-3-Clause
#include <repel/distance/query.hpp>

#include <gtest/gtest.h>

#include <type_traits>

namespace repel {
namespace query_test {

TEST(Query, TheDefaultEndClaimsNothing) {
  EXPECT_EQ(QueryEnd{}, QueryEnd::bad_input);
}

TEST(Query, TheDefaultOptionsAreUsable) {
  const QueryOptions options;
  EXPECT_GT(options.tolerance, 0.0);
  EXPECT_LE(options.tolerance, 1e-12);
  EXPECT_GE(options.iterations, 100);
  EXPECT_EQ(options.ignore_beyond, std::numeric_limits<double>::infinity());
}

TEST(Query, MeasuresHaveNames) {
  EXPECT_EQ(all_measures.front(), QueryOptions{}.measure);
  for (const Measure measure : all_measures) EXPECT_EQ(measure_named(to_text(measure)), measure);
  EXPECT_EQ(measure_named("reduction"), Measure::reduction);
  EXPECT_EQ(measure_named("deepest point"), std::nullopt);
  EXPECT_EQ(measure_named(""), std::nullopt);
}

TEST(Query, AWarmStartIsEmptyAtFirstAndSmallEnoughToKeepPerPair) {
  EXPECT_EQ(WarmStart{}.size, 0);
  static_assert(std::is_trivially_copyable_v<WarmStart>);
  static_assert(sizeof(WarmStart) <= 128);
}

}  // namespace query_test
}  // namespace repel
