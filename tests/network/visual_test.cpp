#include <repel/network/visual.hpp>

#include <gtest/gtest.h>

#include "network/drawn.hpp"

namespace repel::network {
namespace visual_test {

using test::Cell;
using test::DrawnEnds;
using test::DrawnSignals;
using test::Rng;

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

TEST(Visual, ShowsTheNewestTickWhole) {
  Rng rng(seed);
  DrawnSignals drawn(rng, 3);
  DrawnEnds ends(rng, 6, 20.0);
  Cell cell(Visual(), Side::right);
  Mailbox<Picture>& pictures = cell.module.pictures();
  EXPECT_FALSE(pictures.take());
  for (int tick = 0; tick < 1000; ++tick) {
    const Signals& signals = drawn.next();
    ASSERT_TRUE(cell.run(signals, ends.definite(), ends.definite()));
    if (tick % 7 != 0) continue;
    ASSERT_TRUE(pictures.take());
    const Picture& picture = pictures.newest();
    EXPECT_EQ(picture.tick, tick);
    EXPECT_EQ(picture.joints, signals.joints);
    EXPECT_EQ(picture.walls.force, signals.walls.force);
    EXPECT_EQ(picture.walls.torque, signals.walls.torque);
    EXPECT_TRUE(picture.X_WT.isApprox(signals.X_WT, 0.0));
    EXPECT_EQ(picture.port.effort, cell.at_root.effort);
    EXPECT_EQ(picture.port.flow, cell.at_root.flow);
    EXPECT_FALSE(pictures.take());  // seen already
  }
}

// Two networks of one plan once posted into one mailbox, which has room for one writer only.
TEST(Visual, CopyHasAMailboxOfItsOwn) {
  Visual tap;
  Visual copy = tap;
  EXPECT_NE(&tap.pictures(), &copy.pictures());
  copy = tap;
  EXPECT_NE(&tap.pictures(), &copy.pictures());
  const Mailbox<Picture>* const before = &tap.pictures();
  const Visual moved = std::move(tap);
  EXPECT_EQ(&moved.pictures(), before);
}

}  // namespace visual_test
}  // namespace repel::network
