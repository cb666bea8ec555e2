// SPDX-License-Identifier: BSD-3-Clause
#include <repel/distance/feature_lanes.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include <repel/distance/feature_search.hpp>
#include <support/gaps.hpp>

namespace repel::detail {
namespace feature_lanes_test {

using families::Pair;
using families::Rng;

constexpr unsigned seed = 3307;

/// As many pairs as there are lanes, each with the feature found by a search.
struct Group {
  std::vector<Convex> A, B;
  std::vector<Pose> X_WA, X_WB;
  std::vector<WarmStart> warm;

  Group(Rng& rng, double scale_of_gap) {
    for (int k = 0; k < lane_count; ++k) {
      A.push_back(families::convex(draw(rng)));
      B.push_back(families::convex(draw(rng)));
      X_WA.push_back(families::random_pose(rng, 0.1, 2.0));
      X_WB.push_back(X_WA.back());
      X_WB.back().linear() = families::rotation(rng);
      X_WB.back().translation() += scale_of_gap * families::direction(rng);
      warm.emplace_back();
    }
    for (std::size_t k = 0; k < B.size(); ++k) {
      Gap gap;
      FeatureSearch search({A[k], X_WA[k], B[k], X_WB[k]});
      (void)search.run({}, warm[k], gap);
    }
  }

  static families::Solid draw(Rng& rng) {
    const int vertices = families::count_between(rng, 0, 40);
    return vertices < 16 ? families::random_box(rng, 0.1, 0.5)
                         : families::cloud(rng, vertices, 0.5);
  }
  [[nodiscard]] LaneGap prove(const QueryOptions& options) const {
    FeatureLanes lanes;
    for (std::size_t k = 0; k < B.size(); ++k) {
      lanes.set(static_cast<int>(k), A[k], B[k], warm[k]);
    }
    for (std::size_t k = 0; k < B.size(); ++k) {
      lanes.A.X_W.set(static_cast<int>(k), X_WA[k]);
      lanes.B.X_W.set(static_cast<int>(k), X_WB[k]);
    }
    lanes.A.turn();
    lanes.B.turn();
    return lanes.prove(options);
  }
};

TEST(FeatureLanes, ProvesWhatTheProofOfOnePairProves) {
  Rng rng(seed);
  const double infinite = std::numeric_limits<double>::infinity();
  int proven = 0, refused = 0, disputed = 0;
  for (int i = 0; i < 2000; ++i) {
    Group group(rng, families::uniform(rng, 0.8, 2.0));
    // Some have moved so far that another feature is the nearest now.
    for (Pose& X_WA : group.X_WA) {
      if (i % 3 == 0) X_WA.linear() = families::small_rotation(rng, 0.5) * X_WA.linear();
    }
    const LaneGap lanes = group.prove({});
    const auto n = lanes.n_BA_W.each();
    const auto a = lanes.p_AQa_W.each();
    const auto b = lanes.p_AQb_W.each();
    for (std::size_t k = 0; k < group.B.size(); ++k) {
      SCOPED_TRACE(families::of_seed(seed, "group", i) + ", lane " + std::to_string(k));
      if (group.warm[k].size < 1 || group.warm[k].size > 3) continue;
      Gap one;
      const bool holds = confirm_nearest({group.A[k], group.X_WA[k], group.B[k], group.X_WB[k]},
                                         group.warm[k], {}, infinite, one);
      if (holds != ((bits_of(lanes.proven) >> k & 1U) != 0U)) {
        ++disputed;
        continue;
      }
      ++(holds ? proven : refused);
      if (!holds) continue;
      const int lane = static_cast<int>(k);
      EXPECT_NEAR(lanes.distance[lane], one.distance, 2e-14);
      EXPECT_LE(lanes.lower[lane], one.upper);
      EXPECT_GE(lanes.upper[lane], one.lower);
      EXPECT_LE(lanes.upper[lane] - lanes.lower[lane], 2.0 * (one.upper - one.lower));
      EXPECT_LE((to_vec3(n[k]) - to_vec3(one.n_BA_W)).norm(), 1e-12);
      EXPECT_LE((to_vec3(a[k]) - to_vec3(one.p_AQa_W)).norm(), 1e-12);
      EXPECT_LE((to_vec3(b[k]) - to_vec3(one.p_AQb_W)).norm(), 1e-12);
    }
  }
  EXPECT_GT(proven, 1000);
  EXPECT_GT(refused, 200);
  EXPECT_LE(disputed, (proven + refused) / 1000);  // decided by rounding
}

TEST(FeatureLanes, AnyContentOfAWarmStartAndAnyPoseIsSafe) {
  Rng rng(seed);
  for (int i = 0; i < 200; ++i) {
    Group group(rng, 1.5);
    for (WarmStart& warm : group.warm) {
      for (std::size_t k = 0; k < 4; ++k) {
        warm.a[k] = static_cast<std::uint32_t>(rng());
        warm.b[k] = static_cast<std::uint32_t>(rng());
      }
    }
    group.X_WB[0](i % 3, i / 3 % 4) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(bits_of(group.prove({}).proven) & 1U, 0U) << "seed " << seed << ", group " << i;
  }
}

}  // namespace feature_lanes_test
}  // namespace repel::detail
