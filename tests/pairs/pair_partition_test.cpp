#include <repel/pairs/pair_partition.hpp>

#include <gtest/gtest.h>

namespace repel::detail {
namespace pair_partition_test {

TEST(PairPartition, EveryPairIsInOneBlock) {
  for (const int pairs : {1, 63, 64, 65, 200, 1024, 5000}) {
    for (const int blocks : {1, 2, 3, 16}) {
      int counted = 0;
      for (int block = 0; block < blocks; ++block) {
        const PairPartition partition{block, blocks};
        for (int position = 0; position < partition.count_of(pairs); ++position) {
          const PairId id = partition.pair_at(position);
          ASSERT_LT(id.index, pairs);
          ASSERT_EQ(PairPartition::block_of(id, blocks), block);
          ASSERT_EQ(partition.position_of(id), position);
          ++counted;
        }
      }
      ASSERT_EQ(counted, pairs) << "blocks " << blocks;
    }
  }
}

TEST(PairPartition, BlocksAreNoMoreThanThreadsMayShare) {
  EXPECT_EQ(PairPartition::blocks_of(0, 16), 0);
  EXPECT_EQ(PairPartition::blocks_of(64, 16), 1);
  EXPECT_EQ(PairPartition::blocks_of(65, 16), 2);
  EXPECT_EQ(PairPartition::blocks_of(1000000, 16), PairPartition::most_blocks);
  EXPECT_EQ(PairPartition::blocks_of(1000000, 3), 3);
  EXPECT_EQ(PairPartition::blocks_of(1000000, 0), 1);
}

}  // namespace pair_partition_test
}  // namespace repel::detail
