// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/pointed.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <repel/contact/flat.hpp>
#include <repel/reduction/shape.hpp>
#include <support/families.hpp>

namespace repel::detail {
namespace pointed_test {

constexpr unsigned seed = 41;
constexpr double tilt = 0.005;

Shape draw(families::Rng& rng, int i) {
  const auto length = [&] { return families::uniform(rng, 0.02, 0.1); };
  if (i % 3 == 0) return Shape::box({length(), length(), i % 2 == 0 ? 0.0 : length()});
  const int count = families::count_between(rng, 4, 40);
  if (i % 3 == 1) return Shape::hull(families::cloud(rng, count, 0.1).vertices);
  return Shape::hull(
      families::prism(families::count_between(rng, 3, 9), length(), length()).vertices);
}

Flat seen(const Convex& set, const Vec3& n) {
  const PlanarAxes axes{Vec<double>(n)};
  const Vec<double> nearest = set.support(Vec<double>(n)).p;
  return FlatSearch(set, Pose::Identity(), axes, Facing::up, nearest, tilt).run();
}

/// A direction close to an edge's, a face's, or any.
Vec3 direction_at(const Convex& set, families::Rng& rng) {
  const Vec3 any = families::direction(rng);
  if (set.kind() == Convex::Kind::box) {
    Vec3 n = any;
    n[families::count_between(rng, 0, 2)] *= families::uniform(rng, 0.0, 0.2);
    return n.normalized();
  }
  const auto at = set.faces().at(set.support(Vec<double>(any)).name);
  const Vec<double> one = set.faces().normal(at[0].face);
  const Vec<double> other = set.faces().normal(at[1].face);
  const double share = families::uniform(rng, 0.0, 1.0);
  return (to_vec3(share * one + (1.0 - share) * other) +
          families::uniform(rng, 0.0, 0.1) * families::direction(rng))
      .normalized();
}

// Wherever it says so, the set shows a corner or that edge.
TEST(Pointed, NoFlatFeatureIsFoundWithin) {
  families::Rng rng(seed);
  int corners = 0, edges = 0;
  for (int i = 0; i < 1500; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "set", i));
    const Shape shape = draw(rng, i);
    const Convex& set = shape.level(0).core;
    const Vec3 n = direction_at(set, rng);
    const Pointed pointed = PointedSearch(set, Vec<double>(n), tilt).run();
    if (!(pointed.within > 0.0)) continue;
    PointedLanes lanes;
    for (int k = 0; k < lane_count; ++k) lanes.set(k, pointed);
    for (int k = 0; k < 10; ++k) {
      const double by = std::min(1.0, pointed.within) * families::uniform(rng, 0.0, 1.1);
      const Vec3 near = (n + by * families::direction(rng)).normalized();
      if (!((near - n).norm() < pointed.within)) continue;
      EXPECT_NE(bits_of(lanes.holds(LaneVec::all(Vec<double>(near)))), 0U);
      const bool is_edge = bits_of(lanes.has_edge(LaneVec::all(Vec<double>(near)))) != 0U;
      (is_edge ? edges : corners) += 1;
      const Flat flat = seen(set, near);
      ASSERT_LE(flat.outline.size, is_edge ? 2 : 1);
      if (flat.outline.size < 2) continue;
      const PlanarAxes axes{Vec<double>(near)};
      const Planar edge = flat.outline.at(1).r - flat.outline.at(0).r;
      const Planar along = axes.in_plane(pointed.along);
      EXPECT_NEAR(cross(edge, along) / norm(edge), 0.0, 1e-9);
    }
  }
  EXPECT_GT(corners, 1000);
  EXPECT_GT(edges, 1000);
}

TEST(Pointed, FacesAreNot) {
  const Shape box = Shape::box({0.1, 0.1, 0.1});
  EXPECT_LT(PointedSearch(box.level(0).core, {0.0, 0.0, 1.0}, tilt).run().within, 0.0);
  PointedLanes lanes;
  EXPECT_EQ(bits_of(lanes.holds(LaneVec::all({0.0, 0.0, 1.0}))), 0U);
}

// The core of a sphere: no edge is looked for in any tick.
TEST(Pointed, APointIsACornerFromEverywhere) {
  const Pointed pointed = PointedSearch(Convex::box({0.0, 0.0, 0.0}), {0.6, 0.0, 0.8}, tilt).run();
  EXPECT_TRUE(pointed.holds({-1.0, 0.0, 0.0}));
  EXPECT_FALSE(pointed.has_edge({-1.0, 0.0, 0.0}));
}

// Of a cylinder without radius, too, which is a segment that may be in a lane.
TEST(Pointed, NothingIsSaidOfCylinders) {
  const Convex segment = Convex::cylinder(0.0, 0.1);
  EXPECT_LT(PointedSearch(segment, {1.0, 0.0, 0.0}, tilt).run().within, 0.0);
  EXPECT_EQ(seen(segment, {1.0, 0.0, 0.0}).outline.size, 2);
}

}  // namespace pointed_test
}  // namespace repel::detail
