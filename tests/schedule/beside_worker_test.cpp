// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/beside_worker.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel::detail {
namespace beside_worker_test {

using namespace std::chrono_literals;
constexpr unsigned seed = 417;

CoprocessorOptions in_lock_step() {
  CoprocessorOptions options;
  options.lock_step = true;
  return options;
}

/// A worker with all pairs of a world, and the same pairs evaluated by the caller.
struct Both {
  test::Boxes boxes{4, 40, {.range = 0.2}, seed};
  std::shared_ptr<const PairIndex> pairs = std::make_shared<PairIndex>(boxes.world);
  PartPoses poses{boxes.world};
  CoprocessorOptions options = in_lock_step();
  BesideWorker there{boxes.world, boxes.world.motion(), pairs, poses, options, 0, 0, 0.0, 160};
  PairTeam here{boxes.world, pairs, poses, options, 0, 0, 0.0};

  Both() {
    here.prime(boxes.world.motion());
    there.prime();
  }
  void post(std::int64_t exchange) {
    boxes.move();
    (void)here.run(boxes.world.motion());
    there.post(exchange, boxes.world.motion());
  }
  bool comes(std::int64_t exchange, std::chrono::nanoseconds timeout) {
    const auto until = std::chrono::steady_clock::now() + timeout;
    while (there.newest().exchange != exchange) {
      if (std::chrono::steady_clock::now() > until) return false;
    }
    return true;
  }
};

TEST(BesideWorker, AnswersAreThoseOfTheSamePairsInTheCaller) {
  Both both;
  EXPECT_EQ(both.there.newest().exchange, 0);
  both.there.start();
  for (int exchange = 1; exchange <= 50; ++exchange) {
    SCOPED_TRACE(families::of_seed(seed, "exchange", exchange));
    both.post(exchange);
    ASSERT_TRUE(both.comes(exchange, 10s));
    const WholeAnswer& answer = both.there.newest();
    EXPECT_EQ(answer.motion.tick, both.boxes.world.motion().tick);
    EXPECT_EQ(answer.totals.evaluated, both.here.pairs().forces().totals.evaluated);
    EXPECT_EQ(answer.totals.nearest, both.here.pairs().forces().totals.nearest);
    EXPECT_EQ(answer.totals.peak_force, both.here.pairs().forces().totals.peak_force);
  }
}

TEST(BesideWorker, StaysWithItsLastAnswerWhileNobodyWorks) {
  Both both;
  both.post(1);
  EXPECT_FALSE(both.comes(1, 1ms));
  EXPECT_EQ(both.there.newest().exchange, 0);
  both.there.start();
  EXPECT_TRUE(both.comes(1, 10s));
  both.there.stop();
  both.post(2);
  EXPECT_FALSE(both.comes(2, 1ms));
}

}  // namespace beside_worker_test
}  // namespace repel::detail
