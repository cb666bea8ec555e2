// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/polygon_search.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <vector>

#include "contact/contacts.hpp"

namespace repel::detail {
namespace polygon_search_test {

using families::Rng;

constexpr unsigned seed = 43;

/// Pairs of boxes and prisms over each other, one per lane, and what is known of each.
struct Group {
  std::vector<test::Contacts> pairs;
  std::vector<Separation> found;
  FeatureLanes features;
  Lanes tilt{};

  explicit Group(Rng& rng) {
    const auto& kinds = test::kinds_of_contacts();
    for (int k = 0; k < lane_count; ++k) {
      const auto& kind = kinds[static_cast<std::size_t>(families::count_between(rng, 0, 3))];
      pairs.push_back(test::draw_contacts(kind, families::uniform(rng, 0.002, 0.01), rng));
      const test::Contacts& pair = pairs.back();
      WarmStart warm;
      found.push_back(separation(pair.A, pair.X_WA, pair.B, pair.X_WB, {}, warm));
      features.set(k, pair.A.level(0).core, pair.B.level(0).core, warm);
      features.A.X_W.set(k, pair.X_WA);
      features.B.X_W.set(k, pair.X_WB);
      tilt[k] = pair.tilt;
    }
    features.A.turn();
    features.B.turn();
  }
};

/// The patches of a group, with what is known of its faces.
struct Found {
  PolygonPatches small, large;

  Found(const Group& group, const LaneGap& gap, FaceLanes& faces_a, FaceLanes& faces_b) {
    const auto pair = [&](int k) -> const test::Contacts& {
      return group.pairs[static_cast<std::size_t>(k)];
    };
    PolygonSearch search(group.features, gap, group.tilt);
    search.find_flats(
        gap.proven, [&](int k) -> const Pose& { return pair(k).X_WA; },
        [&](int k) -> const Pose& { return pair(k).X_WB; }, faces_a, faces_b);
    small = search.patches<4>(gap.proven, Lanes{});
    large = search.patches<PolygonLanes::most>(gap.proven, Lanes{});
  }
};

TEST(PolygonSearch, FindsThePatchOfEachPairAlone) {
  Rng rng(seed);
  int found = 0, large = 0, all = 0;
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "group", i));
    const Group group(rng);
    const LaneGap gap = group.features.prove({});
    const auto pair = [&](int k) -> const test::Contacts& {
      return group.pairs[static_cast<std::size_t>(k)];
    };
    FaceLanes faces_a, faces_b;
    const Found patches_of(group, gap, faces_a, faces_b);
    const auto compare = [&](const PolygonPatches& patches) {
      for (int k = 0; k < lane_count; ++k) {
        if (patches.valid[k] == 0) continue;
        ++found;
        ContactPatch alone;
        ASSERT_TRUE(find_patch(group.found[static_cast<std::size_t>(k)], {pair(k).A, pair(k).X_WA},
                               {pair(k).B, pair(k).X_WB}, pair(k).tilt, alone));
        EXPECT_NEAR(patches.nearer[k], alone.nearer, 1e-11);
        EXPECT_LE((patches.force.at(k) - alone.gradient.force).norm(), 1e-10);
        EXPECT_LE((patches.torque.at(k) - alone.gradient.torque).norm(), 1e-10);
      }
    };
    compare(patches_of.small);
    compare(patches_of.large);
    large += std::popcount(bits_of(patches_of.large.valid));
    all += lane_count;
  }
  EXPECT_GT(found, all / 8);
  EXPECT_GT(large, 50);
}

/// Expects the same bits in both; counts the lanes of `counted` with a patch.
void expect_same(const PolygonPatches& one, const PolygonPatches& other, unsigned counted,
                 int& count) {
  ASSERT_EQ(bits_of(one.valid), bits_of(other.valid));
  count += std::popcount(bits_of(one.valid) & counted);
  for (int k = 0; k < lane_count; ++k) {
    if (one.valid[k] == 0) continue;
    EXPECT_EQ(one.nearer[k], other.nearer[k]);
    EXPECT_EQ(one.force.at(k), other.force.at(k));
    EXPECT_EQ(one.torque.at(k), other.torque.at(k));
  }
}

// Pairs move from lane to lane, and what a lane knows is lost with that: it must not show.
TEST(PolygonSearch, KnownFacesChangeNoBit) {
  Rng rng(seed);
  int compared = 0;
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "group", i));
    Group group(rng);
    FaceLanes kept_a, kept_b;
    for (int tick = 0; tick < 4; ++tick) {
      const LaneGap gap = group.features.prove({});
      const unsigned known = bits_of(kept_a.holds(gap.n_A, group.tilt) & gap.proven);
      FaceLanes new_a, new_b;
      const Found with(group, gap, kept_a, kept_b);
      const Found without(group, gap, new_a, new_b);
      expect_same(with.small, without.small, known, compared);
      expect_same(with.large, without.large, known, compared);
      for (int k = 0; k < lane_count; ++k) {
        Pose& X = group.pairs[static_cast<std::size_t>(k)].X_WA;
        X.linear() = Eigen::AngleAxisd(0.002, families::direction(rng)) * X.linear();
        group.features.A.X_W.set(k, X);
      }
      group.features.A.turn();
    }
  }
  EXPECT_GT(compared, 20);
}

}  // namespace polygon_search_test
}  // namespace repel::detail
