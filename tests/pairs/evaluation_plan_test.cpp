// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/evaluation_plan.hpp>

#include <gtest/gtest.h>

#include <vector>

namespace repel::detail {
namespace evaluation_plan_test {

/// A number of groups and singles that each cost one unit, and how often each was evaluated.
struct Items {
  Items(int group_total, int single_total) : groups(group_total), singles(single_total) {}
  int groups;
  int singles;
  std::vector<int> group_count = std::vector<int>(static_cast<std::size_t>(groups));
  std::vector<int> single_count = std::vector<int>(static_cast<std::size_t>(singles));
  EvaluationPlan plan{groups, singles};
  PairTotals totals;

  /// @param backwards runs the batches in the opposite order, as other threads might
  void tick(const EvaluationLimit& limit = {}, bool backwards = false) {
    const auto pair_at = [](int k) { return k; };
    const int batches =
        plan.plan(limit, groups, singles, pair_at, [](std::int32_t k) { return 1.0 * k; });
    std::int64_t spent = 0;
    for (int i = 0; i < batches; ++i) {
      spent += plan.run(
          backwards ? batches - 1 - i : i, backwards ? 0 : spent,
          [&](int g, PairTotals& t) {
            ++group_count[static_cast<std::size_t>(g)];
            ++t.evaluated;
            ++t.iterations;
          },
          [&](int k, bool allowed, PairTotals& t) {
            if (!allowed) return;
            ++single_count[static_cast<std::size_t>(k)];
            ++t.evaluated;
            ++t.iterations;
          });
    }
    totals = {};
    plan.finish(totals, pair_at);
  }
};

TEST(EvaluationPlan, EveryItemIsEvaluatedOnceWhoeverTakesTheBatches) {
  for (const auto& [groups, singles] : {std::pair{0, 0}, {1, 0}, {0, 1}, {13, 30}, {40, 3}}) {
    for (const bool backwards : {false, true}) {
      Items items{groups, singles};
      items.tick({}, backwards);
      EXPECT_EQ(items.totals.evaluated, groups + singles);
      for (const int count : items.group_count) EXPECT_EQ(count, 1);
      for (const int count : items.single_count) EXPECT_EQ(count, 1);
    }
  }
}

TEST(EvaluationPlan, NoneStarvesIfTheTimeIsShort) {
  Items items{20, 30};
  for (int tick = 0; tick < 400; ++tick) {
    items.tick({.work_units = 5});
    ASSERT_EQ(items.totals.evaluated, 5);
  }
  for (const int count : items.group_count) EXPECT_GE(count, 20);
  for (const int count : items.single_count) EXPECT_GE(count, 10);
}

TEST(EvaluationPlan, DeadlineThatHasPassedAllowsNothing) {
  Items items{3, 3};
  items.tick({.deadline = EvaluationLimit::Clock::time_point::min()});
  EXPECT_EQ(items.totals.evaluated, 0);
}

}  // namespace evaluation_plan_test
}  // namespace repel::detail
