// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/any_pair_set.hpp>

#include <gtest/gtest.h>

#include <repel/pairs/pairs.hpp>

#include "pairs/boxes.hpp"

namespace repel {
namespace any_pair_set_test {

constexpr unsigned seed = 4546;

// What passes through the table of functions is what the header computes, compiled here.
TEST(AnyPairSet, GivesWhatAPairSetGives) {
  test::Boxes boxes(4, 40, {.range = 0.1}, seed);
  const detail::PairIndex index(boxes.world);
  detail::PartPoses poses(boxes.world);
  detail::PairSet here(boxes.world, 160);
  const auto any = detail::make_pair_set(boxes.world, 160, {}, 0.0);
  const auto run = [&](auto& set) {
    const Motion& motion = boxes.world.motion();
    poses.begin_tick();
    set.begin_tick(motion.tick);
    (void)set.select(motion, poses, {});
    set.evaluate_all(motion, poses);
    set.finish(motion, poses);
  };
  here.track_all(index);
  any->track_all(index);
  int near = 0;
  for (int tick = 0; tick < 100; ++tick) {
    boxes.move();
    run(here);
    run(*any);
    const Wrench& of_here = here.forces().on_body[static_cast<std::size_t>(boxes.tool.index)];
    const Wrench& of_any = any->forces().on_body[static_cast<std::size_t>(boxes.tool.index)];
    EXPECT_EQ(of_here.force, of_any.force);
    EXPECT_EQ(of_here.torque, of_any.torque);
    std::vector<double> distances;
    here.for_each_near(boxes.world.motion(), [&](const NearPair& pair) {
      distances.push_back(pair.separation.distance);
    });
    std::size_t k = 0;
    any->for_each_answer(boxes.world.motion(),
                         [&](const NearPair& pair, const detail::NearAnswer& answer) {
                           ASSERT_LT(k, distances.size());
                           EXPECT_EQ(pair.separation.distance, distances[k++]);
                           EXPECT_EQ(pair.pair, answer.pair);
                         });
    EXPECT_EQ(k, distances.size());
    near += static_cast<int>(k);
  }
  EXPECT_GT(near, 1000) << "seed " << seed;
}

}  // namespace any_pair_set_test
}  // namespace repel
