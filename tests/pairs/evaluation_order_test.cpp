// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/evaluation_order.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

namespace repel::detail {
namespace evaluation_order_test {

std::vector<int> listed(std::span<const std::int32_t> order) {
  return {order.begin(), order.end()};
}

TEST(EvaluationOrder, GoesRoundFromTheFirst) {
  EvaluationOrder order(5);
  const auto none = [](std::int32_t) { return 0.0; };
  EXPECT_EQ(listed(order.arrange(5, 3, 0, none)), (std::vector<int>{3, 4, 0, 1, 2}));
  EXPECT_EQ(listed(order.arrange(3, 0, 0, none)), (std::vector<int>{0, 1, 2}));
  EXPECT_TRUE(order.arrange(0, 0, 0, none).empty());
  // A start one beyond the last wraps around to the first.
  EXPECT_EQ(listed(order.arrange(3, 3, 0, none)), (std::vector<int>{0, 1, 2}));
}

TEST(EvaluationOrder, TheUrgentComeFirstAndTheOthersKeepTheirTurn) {
  EvaluationOrder order(6);
  const std::vector<double> key{5.0, 1.0, 4.0, 0.0, 3.0, 2.0};
  const auto by = [&](std::int32_t i) { return key[static_cast<std::size_t>(i)]; };
  const std::vector<int> got = listed(order.arrange(6, 4, 2, by));
  EXPECT_EQ(std::set<int>(got.begin(), got.begin() + 2), (std::set<int>{1, 3}));
  EXPECT_EQ(std::vector<int>(got.begin() + 2, got.end()), (std::vector<int>{4, 5, 0, 2}));
}

TEST(EvaluationOrder, EveryNumberComesOnce) {
  std::mt19937 random(77);
  EvaluationOrder order(200);
  std::vector<double> key(200);
  for (int run = 0; run < 300; ++run) {
    const int count = static_cast<int>(random() % 200) + 1;
    const int urgent = static_cast<int>(random() % (static_cast<unsigned>(count) + 1));
    for (double& k : key) k = std::floor(static_cast<double>(random() % 20));  // many equal keys
    const auto got =
        order.arrange(count, static_cast<int>(random() % static_cast<unsigned>(count)), urgent,
                      [&](std::int32_t i) { return key[static_cast<std::size_t>(i)]; });
    const std::set<int> all(got.begin(), got.end());
    ASSERT_EQ(all.size(), static_cast<std::size_t>(count)) << "run " << run;
    double worst = -1.0;
    for (int k = 0; k < urgent; ++k) worst = std::max(worst, key[static_cast<std::size_t>(got[k])]);
    for (int k = urgent; k < count; ++k) ASSERT_GE(key[static_cast<std::size_t>(got[k])], worst);
  }
}

}  // namespace evaluation_order_test
}  // namespace repel::detail
