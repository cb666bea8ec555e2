// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/candidates.hpp>

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace repel::detail {
namespace candidates_test {

TEST(Candidates, StayInTheOrderOfTheirListsAndPairsWhateverComesAndGoes) {
  constexpr unsigned seed = 12;
  std::mt19937 random(seed);
  Candidates candidates(100);
  std::map<std::pair<int, int>, int> truth;  // list and pair, to slot
  std::size_t most = 0;
  for (int round = 0; round < 2000; ++round) {
    const auto list = static_cast<int>(random() % 5);
    const auto gone = static_cast<int>(random() % 3);
    std::erase_if(truth, [&](const auto& item) {
      return item.first.first == list && item.second % 3 == gone;
    });
    for (int tries = 0; tries < 9 && truth.size() < 80; ++tries) {
      const int pair = static_cast<int>(random() % 1000);
      const int slot = static_cast<int>(random() % 100);
      if (!truth.contains({list, pair})) {
        if (slot % 3 != gone) truth.emplace(std::pair(list, pair), slot);
        candidates.add({pair}, slot, list);
      }
    }
    candidates.update(list, [&](std::int32_t slot) { return slot % 3 == gone; });
    ASSERT_EQ(static_cast<std::size_t>(candidates.count()), truth.size()) << "seed " << seed;
    const Candidate* next = candidates.begin();
    for (const auto& [place, slot] : truth) {
      ASSERT_EQ(next->list, place.first);
      ASSERT_EQ(next->pair.index, place.second);
      ASSERT_EQ(next++->slot, slot);
    }
    most = std::max(most, truth.size());
  }
  EXPECT_GT(most, 20U);
}

TEST(Candidates, ConditionIsCalledOnceForEachOfTheList) {
  Candidates candidates(6);
  candidates.add({7}, 7, 1);
  candidates.update(1, [](std::int32_t) { return false; });
  for (std::int32_t i = 0; i < 4; ++i) candidates.add({i}, i, 2);
  std::vector<int> called;
  candidates.update(2, [&](std::int32_t slot) {
    called.push_back(slot);
    return true;
  });
  EXPECT_EQ(called, (std::vector<int>{0, 1, 2, 3}));
  ASSERT_EQ(candidates.count(), 1);
  EXPECT_EQ(candidates[0].slot, 7);
}

}  // namespace candidates_test
}  // namespace repel::detail
