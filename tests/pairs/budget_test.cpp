// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/budget.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace budget_test {

using detail::EvaluationLimit;
using namespace std::chrono_literals;

TEST(EvaluationLimit, WithoutABudgetThereIsNone) {
  const EvaluationLimit limit = EvaluationLimit::from_now({});
  EXPECT_FALSE(limit.is_set());
  EXPECT_FALSE(limit.is_reached(EvaluationLimit::no_limit - 1));
}

TEST(EvaluationLimit, OfWorkIsReachedByCounting) {
  const EvaluationLimit limit = EvaluationLimit::from_now({.work_units = 10});
  EXPECT_TRUE(limit.is_set());
  EXPECT_TRUE(limit.is_counted());
  EXPECT_FALSE(limit.is_reached(9));
  EXPECT_TRUE(limit.is_reached(10));
}

TEST(EvaluationLimit, OfTimeIsReachedWhenItHasPassed) {
  const EvaluationLimit limit = EvaluationLimit::from_now({.wall = 1ns});
  EXPECT_TRUE(limit.is_set());
  EXPECT_FALSE(limit.is_counted());
  while (EvaluationLimit::Clock::now() < limit.deadline) {
  }
  EXPECT_TRUE(limit.is_reached(0));
  EXPECT_FALSE(EvaluationLimit::from_now({.wall = 1h}).is_reached(0));
}

}  // namespace budget_test
}  // namespace repel
