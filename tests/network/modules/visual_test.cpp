// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/visual.hpp>

#include <gtest/gtest.h>

#include "network/drawn.hpp"

namespace repel::network {
namespace visual_test {

constexpr unsigned seed = 71;

TEST(Visual, ChangesNothing) {
  for (const Side root : {Side::left, Side::right}) {
    Rng rng(seed);
    DrawnSignals drawn(rng, 3);
    DrawnEnds ends(rng, 6, 20.0);
    Cell cell(Visual(), root);
    for (int tick = 0; tick < families::draws(100000); ++tick) {
      const auto behind = tick % 2 == 0 ? ends.slack() : ends.moved(0.5);
      ASSERT_TRUE(cell.run(drawn.next(), behind, ends.definite()));
      ASSERT_EQ(cell.shown.form, behind.form);
      ASSERT_EQ(cell.shown.matrix, behind.matrix);
      ASSERT_EQ(cell.shown.offset, behind.offset);
      ASSERT_EQ(cell.at_root.effort, cell.at_leaf.effort);
      ASSERT_EQ(cell.at_root.flow, cell.at_leaf.flow);
    }
    EXPECT_EQ(cell.ledger.energy, 0.0) << "seed " << seed;
    EXPECT_GT(cell.ledger.passed, 1.0);
  }
}

}  // namespace visual_test
}  // namespace repel::network
