// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/tap.hpp>

#include <gtest/gtest.h>

#include <map>

#include <repel/base/setup_error.hpp>

#include "pairs/boxes.hpp"

namespace repel {
namespace tap_test {

using namespace std::chrono_literals;
constexpr unsigned seed = 560;

struct Bench {
  explicit Bench(const TapOptions& options)
      : boxes(4, 80, {.range = 0.05}, seed),
        coprocessor(boxes.world, {}),
        tap(boxes.world, options) {}

  void tick() {
    boxes.move();
    record.pairs = coprocessor.exchange().totals;
    record.virtual_force = coprocessor.exchange().on_body[boxes.tool.index];
    record.tick = boxes.world.motion().tick;
    tap.note(coprocessor, arms, {3us, 7us});
  }

  test::Boxes boxes;
  Coprocessor coprocessor;
  Tap tap;
  TickRecord record;
  const TickRecord* arms[1] = {&record};
};

TEST(Tap, ASnapshotHasTheTickWhole) {
  Bench bench({.picture_period = 0ns, .log = 4});
  for (int i = 0; i < 20; ++i) bench.tick();
  ASSERT_TRUE(bench.tap.pictures().take());
  const Snapshot& s = bench.tap.pictures().newest();
  ASSERT_EQ(s.arms.size(), 1U);
  EXPECT_EQ(s.arms.front().tick, bench.record.tick);
  EXPECT_TRUE(s.X_WB[bench.boxes.tool.index].isApprox(bench.boxes.X_WT));
  EXPECT_EQ(s.times.compute, 7us);
  EXPECT_EQ(s.times.late, 3us);
  EXPECT_EQ(s.pairs_omitted, 0);
  ASSERT_GT(s.pair_count, 1) << "seed " << seed;
  EXPECT_TRUE(std::is_sorted(s.near().begin(), s.near().end(), [](const auto& a, const auto& b) {
    return a.separation.distance < b.separation.distance;
  }));
  EXPECT_EQ(s.near().front().pair, bench.record.pairs.nearest_pair);
}

// The omitted pairs are the farthest ones, and are counted.
TEST(Tap, WithoutRoomForAllTheNearestAreKept) {
  Bench all({.picture_period = 0ns});
  Bench few({.pairs = 3, .picture_period = 0ns});
  int cut = 0;
  for (int i = 0; i < 50; ++i) {
    all.tick();
    few.tick();
    ASSERT_TRUE(all.tap.pictures().take());
    ASSERT_TRUE(few.tap.pictures().take());
    const Snapshot& whole = all.tap.pictures().newest();
    const Snapshot& part = few.tap.pictures().newest();
    ASSERT_EQ(part.pair_count + part.pairs_omitted, whole.pair_count);
    for (int k = 0; k < part.pair_count; ++k) {
      EXPECT_EQ(part.pairs[k].separation.distance, whole.pairs[k].separation.distance);
    }
    cut += part.pairs_omitted > 0 ? 1 : 0;
  }
  EXPECT_GT(cut, 10) << "seed " << seed;
}

TEST(Tap, ALogThatNobodyReadsDropsAndCountsAndKeepsTheFirst) {
  Bench bench({.picture_period = 1h, .samples = 8, .log = 4});
  for (int i = 0; i < 20; ++i) bench.tick();
  EXPECT_EQ(bench.tap.log().dropped(), 16);
  EXPECT_EQ(bench.tap.samples().dropped(), 12);
  for (int i = 0; i < 4; ++i) {
    ASSERT_NE(bench.tap.log().front(), nullptr);
    EXPECT_EQ(bench.tap.log().front()->arms.front().tick, i);
    bench.tap.log().pop();
  }
  EXPECT_EQ(bench.tap.log().front(), nullptr);
}

TEST(Tap, PicturesComeNoMoreOftenThanAskedFor) {
  Bench bench({.picture_period = 1h});
  for (int i = 0; i < 20; ++i) bench.tick();
  ASSERT_TRUE(bench.tap.pictures().take());
  EXPECT_EQ(bench.tap.pictures().newest().arms.front().tick, 0);
  bench.tap.show(bench.coprocessor, bench.arms, {});
  ASSERT_TRUE(bench.tap.pictures().take());
  EXPECT_EQ(bench.tap.pictures().newest().arms.front().tick, bench.record.tick);
}

TEST(Tap, NumbersOutOfRangeAreRefused) {
  const World world;
  EXPECT_THROW(Tap(world, {.arms = 0}), SetupError);
  EXPECT_THROW(Tap(world, {.pairs = 0}), SetupError);
}

}  // namespace tap_test
}  // namespace repel
