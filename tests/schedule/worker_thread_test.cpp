#include <repel/schedule/worker_thread.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel::detail {
namespace worker_thread_test {

using namespace std::chrono_literals;
using Clock = WorkerThread::Clock;
constexpr unsigned seed = 417;

/// A worker with all pairs of a world, and the same pairs evaluated by the caller.
struct Both {
  test::Boxes boxes{4, 40, {.range = 0.2}, seed};
  std::shared_ptr<const PairIndex> pairs = std::make_shared<PairIndex>(boxes.world);
  WorkerThread there{boxes.world, pairs, {.threads = 1, .budget = {}, .lock_step = true}, 0};
  WorkerShare here{boxes.world, pairs, {}, 0, 1};

  Both() { here.prime(boxes.world.motion()); }
  void post(std::int64_t exchange) {
    boxes.move();
    here.run(boxes.world.motion());
    there.post(exchange, Clock::now(), boxes.world.motion());
  }
  void expect_same_forces() const {
    ASSERT_EQ(there.forces().size(), here.blocks().size());
    for (std::size_t b = 0; b < here.blocks().size(); ++b) {
      const PairForces& mine = here.blocks()[b].forces();
      EXPECT_EQ(there.forces()[b].tick, mine.tick);
      EXPECT_EQ(there.forces()[b].totals.evaluated, mine.totals.evaluated);
      for (std::size_t body = 0; body < mine.on_body.size(); ++body) {
        EXPECT_EQ(there.forces()[b].on_body[body].force, mine.on_body[body].force);
        EXPECT_EQ(there.forces()[b].on_body[body].torque, mine.on_body[body].torque);
      }
    }
  }
};

TEST(WorkerThread, ForcesAreThoseOfTheSamePairsInTheCaller) {
  Both both;
  both.there.start();
  for (int exchange = 1; exchange <= 50; ++exchange) {
    SCOPED_TRACE(families::of_seed(seed, "exchange", exchange));
    both.post(exchange);
    ASSERT_TRUE(both.there.wait(exchange, Clock::now() + 10s));
    both.expect_same_forces();
  }
}

TEST(WorkerThread, WaitGivesUpWhenNobodyAnswers) {
  Both both;
  both.post(1);
  EXPECT_FALSE(both.there.wait(1, Clock::now() + 1ms));
  both.there.start();
  EXPECT_TRUE(both.there.wait(1, Clock::now() + 10s));
  both.there.stop();
  both.post(2);
  EXPECT_FALSE(both.there.wait(2, Clock::now() + 1ms));
}

}  // namespace worker_thread_test
}  // namespace repel::detail
