#include <repel/pairs/candidates.hpp>

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace repel::detail {
namespace candidates_test {

TEST(Candidates, StayInTheOrderOfThePairsWhateverComesAndGoes) {
  constexpr unsigned seed = 12;
  std::mt19937 random(seed);
  Candidates candidates(100);
  std::map<int, int> truth;  // pair to slot
  std::size_t most = 0;
  for (int round = 0; round < 500; ++round) {
    const auto gone = static_cast<int>(random() % 3);
    candidates.remove_if([&](std::int32_t slot) { return slot % 3 == gone; });
    std::erase_if(truth, [&](const auto& item) { return item.second % 3 == gone; });
    for (int tries = 0; tries < 20 && truth.size() < 100; ++tries) {
      const int pair = static_cast<int>(random() % 1000);
      const int slot = static_cast<int>(random() % 100);
      if (truth.emplace(pair, slot).second) candidates.add({pair}, slot);
    }
    candidates.sort();
    const auto all = candidates.all();
    ASSERT_EQ(all.size(), truth.size()) << "seed " << seed;
    std::size_t i = 0;
    for (const auto& [pair, slot] : truth) {
      ASSERT_EQ(all[i].pair.index, pair);
      ASSERT_EQ(all[i++].slot, slot);
    }
    most = std::max(most, truth.size());
  }
  EXPECT_GT(most, 20U);
}

TEST(Candidates, ConditionIsCalledOnceForEach) {
  Candidates candidates(4);
  for (std::int32_t i = 0; i < 4; ++i) candidates.add({i}, i);
  std::vector<int> called;
  candidates.remove_if([&](std::int32_t slot) {
    called.push_back(slot);
    return true;
  });
  EXPECT_EQ(called, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_TRUE(candidates.all().empty());
}

}  // namespace candidates_test
}  // namespace repel::detail
