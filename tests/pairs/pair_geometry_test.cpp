// SPDX-License-Identifier: BSD-3-Clause
#include <repel/pairs/pair_geometry.hpp>

#include <gtest/gtest.h>

#include "pairs/boxes.hpp"

namespace repel::detail {
namespace pair_geometry_test {

constexpr unsigned seed = 288;

BodyState random_state(families::Rng& random) {
  BodyState state;
  state.X_WB = test::random_pose(random, 0.5);
  state.V_WB = {families::direction(random), families::direction(random)};
  state.turn = families::uniform(random, 0.0, 1.0);
  return state;
}

TEST(ProvenDistance, IsTheBoundWhileApartAndTheMeasureInOverlap) {
  EXPECT_EQ(proven_distance(0.25, 0.2), 0.2);
  EXPECT_EQ(proven_distance(-0.1, -0.3), -0.1);
  const Lanes lanes = proven_distance(lanes_of([](int k) { return k == 0 ? 0.25 : -0.1; }),
                                      lanes_of([](int k) { return k == 0 ? 0.2 : -0.3; }));
  for (int k = 0; k < lane_count; ++k) EXPECT_EQ(lanes[k], k == 0 ? 0.2 : -0.1);
}

TEST(RelativeMotion, IsThatOfTheOriginOfAAsSeenFromB) {
  families::Rng random(seed);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "sample", i));
    const BodyState A = random_state(random);
    const BodyState B = random_state(random);
    const auto relative = relative_motion(A, B);
    const Vec3 p_BA = A.X_WB.translation() - B.X_WB.translation();
    const Vec3 v = A.V_WB.linear - moved_to(B.V_WB, p_BA).linear;
    EXPECT_EQ(to_vec3(relative.p_WoA), A.X_WB.translation());
    EXPECT_EQ(to_vec3(relative.p_BA_W), p_BA);
    EXPECT_LE((to_vec3(relative.v_BA_W) - v).norm(), 1e-14);
    EXPECT_EQ(to_vec3(relative.w_BA_W), A.V_WB.angular - B.V_WB.angular);
    EXPECT_EQ(relative.turn, A.turn + B.turn);
  }
}

TEST(RelativeMotion, LanesHaveTheBitsOfTheirPairs) {
  families::Rng random(seed);
  RelativeMotion<Lanes, LaneVec> lanes;
  const auto expect_same = [&](int k, const RelativeMotion<double, Vec<double>>& one) {
    EXPECT_EQ(lanes.p_WoA.at(k), to_vec3(one.p_WoA));
    EXPECT_EQ(lanes.p_BA_W.at(k), to_vec3(one.p_BA_W));
    EXPECT_EQ(lanes.v_BA_W.at(k), to_vec3(one.v_BA_W));
    EXPECT_EQ(lanes.w_BA_W.at(k), to_vec3(one.w_BA_W));
    EXPECT_EQ(lanes.turn[k], one.turn);
  };
  const auto first = relative_motion(random_state(random), random_state(random));
  lanes = in_all_lanes(first);
  for (int k = 0; k < lane_count; ++k) expect_same(k, first);
  const auto other = relative_motion(random_state(random), random_state(random));
  set_lane(lanes, 1, other);
  expect_same(0, first);
  expect_same(1, other);
}

}  // namespace pair_geometry_test
}  // namespace repel::detail
