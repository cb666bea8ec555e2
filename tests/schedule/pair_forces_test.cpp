// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/pair_forces.hpp>

#include <gtest/gtest.h>

#include <repel/schedule/coprocessor.hpp>

#include "pairs/boxes.hpp"

namespace repel {
namespace pair_forces_test {

TEST(WorkerReport, IsAllZeroWithoutThreads) {
  test::Boxes boxes(1, 4, {}, 77);
  Coprocessor coprocessor(boxes.world, {});
  for (int tick = 0; tick < 5; ++tick) {
    boxes.move();
    const PairForces& forces = coprocessor.exchange();
    EXPECT_EQ(forces.tick, boxes.world.motion().tick);
    const WorkerReport& workers = coprocessor.workers();
    EXPECT_EQ(workers.stood_in, 0);
    EXPECT_EQ(workers.silence, 0);
    EXPECT_EQ(workers.ticks, 0);
    EXPECT_EQ(workers.longest_silence, 0);
  }
}

}  // namespace pair_forces_test
}  // namespace repel
