#include <repel/schedule/pair_memory.hpp>

#include <gtest/gtest.h>

#include <set>

#include "schedule/boxes.hpp"

namespace repel::detail {
namespace pair_memory_test {

constexpr unsigned seed = 31;

TEST(PairShare, SharesOutEveryPairOnce) {
  for (const int pairs : {1, 63, 64, 65, 200, 1024, 5000}) {
    for (const int stride : {1, 2, 3, 16}) {
      int owned = 0;
      for (int index = 0; index < stride; ++index) {
        const PairShare share{index, stride};
        for (int place = 0; place < share.count_of(pairs); ++place) {
          const PairId id = share.pair_at(place);
          ASSERT_LT(id.index, pairs);
          ASSERT_EQ(PairShare::block_of(id, stride), index);
          ASSERT_EQ(share.place_of(id), place);
          ++owned;
        }
      }
      ASSERT_EQ(owned, pairs) << "stride " << stride;
    }
  }
}

TEST(PairMemory, EveryPairHasASlotOfItsOwnWhileThereAreEnough) {
  const test::Boxes boxes(2, 5, {}, seed);
  PairMemory memory(boxes.world, {}, 100);
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
  PairMemory memory(boxes.world, {}, 2);
  const int kept = memory.slot_for({3});
  EXPECT_TRUE(memory.enlist(kept, 7));
  EXPECT_FALSE(memory.enlist(kept, 7));
  memory.answer(kept).last.distance = 0.25;
  const int other = memory.slot_for({4});
  memory.answer(other).last.distance = 0.5;
  EXPECT_EQ(memory.slot_for({5}), other);
  EXPECT_EQ(memory.slot_of({4}), PairMemory::none);
  EXPECT_EQ(memory.answer(other).last.distance, PairAnswer{}.last.distance);
  EXPECT_EQ(memory.watch(other).pair, PairId{5});
  EXPECT_EQ(memory.slot_of({3}), kept);
  EXPECT_EQ(memory.answer(kept).last.distance, 0.25);

  EXPECT_TRUE(memory.enlist(other, 7));
  const int lent = memory.slot_for({6});
  EXPECT_TRUE(memory.is_lent(lent));
  EXPECT_EQ(memory.slot_of({6}), PairMemory::none);
  memory.strike(kept);
  EXPECT_EQ(memory.slot_for({6}), kept);
}

TEST(PairMemory, ExtremesOutliveTheSlot) {
  const test::Boxes boxes(2, 5, {}, seed);
  PairMemory memory(boxes.world, {}, 1);
  (void)memory.slot_for({3});
  memory.extremes({3}).peak_force = 4.0;
  (void)memory.slot_for({4});
  EXPECT_EQ(memory.extremes({3}).peak_force, 4.0);
}

}  // namespace pair_memory_test
}  // namespace repel::detail
