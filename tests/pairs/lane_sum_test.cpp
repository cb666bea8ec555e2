// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/lane_sum.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

#include "pairs/near_pairs.hpp"

namespace repel::detail {
namespace lane_sum_test {

constexpr unsigned seed = 5120;

/// Groups of the same two bodies, of others and of many, in random order, and their sum.
struct Groups {
  test::NearPairs scene;
  std::vector<LaneGroup> groups;
  PairForces forces;
  std::vector<Wrench>& sum = forces.on_body;

  explicit Groups(unsigned run) : scene(3, run) {
    constexpr int count = 6;
    for (int g = 0; g < count; ++g) add_group(families::count_between(scene.random, 0, 2));
    PartPoses poses(scene.world);
    groups.resize(count);
    for (int i = 0; i < count * lane_count; ++i) {
      scene.set(groups[static_cast<std::size_t>(i / lane_count)], i % lane_count, {i}, poses);
    }
    scene.move(0.001, 0.002);
    poses.begin_tick();
    forces = PairForces(scene.world.body_count());
    for (LaneGroup& group : groups) group.evaluate(scene.world.motion(), poses);
    LaneSum(scene.world.motion(), forces).add(groups);
  }
  void add_group(int kind) {
    for (int k = 0; k < lane_count; ++k) {
      if (kind == 0) scene.add(scene.bodies[1], scene.bodies[2]);
      if (kind == 1) scene.add(scene.bodies[3], World::fixed);
      if (kind == 2) scene.add();
    }
  }
  [[nodiscard]] Vec3 origin(BodyId id) const {
    return scene.world.motion().bodies[id.index].X_WB.translation();
  }
};

TEST(LaneSum, IsTheSumOfThePairsOneByOne) {
  int pushing = 0, mixed = 0, same = 0;
  for (unsigned run = 0; run < 60; ++run) {
    const Groups all(seed + run);
    std::vector<Wrench> plain(all.sum.size());
    BodyId last;
    for (const LaneGroup& group : all.groups) {
      mixed += group.same_bodies() ? 0 : 1;
      same += group.same_bodies() && group.body_a(0) == last ? 1 : 0;
      last = group.same_bodies() ? group.body_a(0) : BodyId{};
      for (int k = 0; k < lane_count; ++k) {
        if ((group.in_range() >> k & 1U) == 0U) continue;
        const Vec3 f = group.force().at(k);
        const Vec3 m = group.torque().at(k);
        const Vec3 p_BA = all.origin(group.body_a(k)) - all.origin(group.body_b(k));
        plain[group.body_a(k).index] += {f, m};
        plain[group.body_b(k).index] += {-f, -m - p_BA.cross(f)};
        pushing += f.norm() > 1.0 ? 1 : 0;
      }
    }
    for (std::size_t body = 0; body < plain.size(); ++body) {
      ASSERT_LE((all.sum[body].force - plain[body].force).norm(), 1e-9) << "seed " << seed + run;
      ASSERT_LE((all.sum[body].torque - plain[body].torque).norm(), 1e-9) << "seed " << seed + run;
    }
  }
  EXPECT_GT(pushing, 200);
  EXPECT_GT(mixed, 50);
  EXPECT_GT(same, 30);
}

TEST(LaneSum, ActionAndReactionCancelAboutACommonPoint) {
  for (unsigned run = 0; run < 60; ++run) {
    const Groups all(seed + run);
    Wrench sum;
    for (const BodyId id : all.scene.bodies) {
      sum += moved_to(all.sum[static_cast<std::size_t>(id.index)], -all.origin(id));
    }
    ASSERT_LE(sum.force.norm(), 1e-10) << "seed " << seed + run;
    ASSERT_LE(sum.torque.norm(), 1e-10) << "seed " << seed + run;
  }
}

TEST(LaneSum, GroupsThatWereNotEvaluatedAtThisTickAddNothing) {
  double most = 0.0;
  for (unsigned run = 0; run < 20; ++run) {
    Groups all(seed + run);
    PairForces some(all.scene.world.body_count());
    PairForces others(all.scene.world.body_count());
    const auto& sum = some.on_body;
    const auto& without = others.on_body;
    const auto count = all.groups.size();
    const auto old = run % count;
    LaneSum(all.scene.world.motion(), others).add(std::span(all.groups).first(old));
    LaneSum(all.scene.world.motion(), others).add(std::span(all.groups).subspan(old + 1));
    all.groups[old].begin_tick();
    LaneSum(all.scene.world.motion(), some).add(all.groups);
    for (std::size_t body = 0; body < sum.size(); ++body) {
      ASSERT_LE((sum[body].force - without[body].force).norm(), 1e-9) << "seed " << seed + run;
      ASSERT_LE((sum[body].torque - without[body].torque).norm(), 1e-9) << "seed " << seed + run;
      most = std::max(most, (sum[body].force - all.sum[body].force).norm());
    }
  }
  EXPECT_GT(most, 1.0);
}

}  // namespace lane_sum_test
}  // namespace repel::detail
