// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/pair_memory.hpp>

#include <gtest/gtest.h>

#include <set>

#include "pairs/boxes.hpp"

namespace repel::detail {
namespace pair_memory_test {

constexpr unsigned seed = 31;

TEST(PairMemory, EveryPairHasASlotOfItsOwnWhileThereAreEnough) {
  const test::Boxes boxes(2, 5, {}, seed);
  PairMemory memory(boxes.world, 100);
  EXPECT_EQ(memory.slots(), 10);
  std::set<int> slots;
  for (std::int32_t i = 0; i < 10; ++i) {
    EXPECT_EQ(memory.slot_of({i}), PairMemory::none);
    slots.insert(memory.slot_for({i}));
  }
  EXPECT_EQ(slots.size(), 10U);
  for (std::int32_t i = 0; i < 10; ++i) EXPECT_EQ(memory.slot_for({i}), memory.slot_of({i}));
}

TEST(PairMemory, TakesSlotsOnlyFromPairsOnNoList) {
  const test::Boxes boxes(2, 5, {}, seed);
  PairMemory memory(boxes.world, 2);
  const int kept = memory.slot_for({3});
  EXPECT_TRUE(memory.add_to_list(kept, 7));
  EXPECT_FALSE(memory.add_to_list(kept, 7));
  memory.answer(kept).last.distance = 0.25;
  const int other = memory.slot_for({4});
  memory.answer(other).last.distance = 0.5;
  EXPECT_EQ(memory.slot_for({5}), other);
  EXPECT_EQ(memory.slot_of({4}), PairMemory::none);
  EXPECT_EQ(memory.answer(other).last.distance, PairAnswer{}.last.distance);
  EXPECT_EQ(memory.tracking(other).pair, PairId{5});
  EXPECT_EQ(memory.slot_of({3}), kept);
  EXPECT_EQ(memory.answer(kept).last.distance, 0.25);

  EXPECT_TRUE(memory.add_to_list(other, 7));
  const int temporary = memory.slot_for({6});
  EXPECT_TRUE(memory.is_temporary(temporary));
  EXPECT_EQ(memory.slot_of({6}), PairMemory::none);
  memory.remove_from_list(kept);
  EXPECT_EQ(memory.slot_for({6}), kept);
}

TEST(PairMemory, ExtremesOutliveTheSlot) {
  const test::Boxes boxes(2, 5, {}, seed);
  PairMemory memory(boxes.world, 1);
  (void)memory.slot_for({3});
  memory.extremes({3}).peak_force = 4.0;
  (void)memory.slot_for({4});
  EXPECT_EQ(memory.extremes({3}).peak_force, 4.0);
}

}  // namespace pair_memory_test
}  // namespace repel::detail
