// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/face_lanes.hpp>

#include <gtest/gtest.h>

#include <repel/contact/flat.hpp>
#include <repel/reduction/shape.hpp>
#include <support/families.hpp>

namespace repel::detail {
namespace face_lanes_test {

constexpr unsigned seed = 44;
constexpr double tilt = 0.005;

Shape draw(families::Rng& rng, int i) {
  const auto length = [&] { return families::uniform(rng, 0.02, 0.1); };
  if (i % 2 == 0) {
    return Shape::hull(families::cloud(rng, families::count_between(rng, 4, 20), 0.1).vertices);
  }
  return Shape::hull(
      families::prism(families::count_between(rng, 3, 8), length(), length()).vertices);
}

// A face that is known is found without a look at its neighbours, so it must be the one that a
// search finds, with the whole tilt, as a polygon with the same corners and slope.
TEST(FaceLanes, HoldWhereASearchFindsThatFace) {
  families::Rng rng(seed);
  int held = 0, lost = 0;
  for (int i = 0; i < 3000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "set", i));
    const Shape shape = draw(rng, i);
    const Convex& set = shape.level(0).core;
    Pose X = Pose::Identity();
    X.linear() = families::rotation(rng);
    X.translation() = families::direction(rng);
    const Faces& faces = set.faces();
    const auto face = static_cast<std::uint32_t>(
        families::count_between(rng, 0, static_cast<int>(faces.count()) - 1));
    const Facing facing = i % 4 < 2 ? Facing::up : Facing::down;
    FaceLanes lanes;
    EXPECT_EQ(bits_of(lanes.holds(LaneVec::all(faces.normal(face)), all_of(tilt))), 0U);
    for (int k = 0; k < lane_count; ++k) lanes.set(k, set, face, facing);
    const Vec3 n =
        (to_vec3(faces.normal(face)) + families::uniform(rng, 0.0, 0.1) * families::direction(rng))
            .normalized();
    const LaneMask holds = lanes.holds(LaneVec::all(Vec<double>(n)), all_of(tilt));
    if (bits_of(holds) == 0U) {
      ++lost;
      continue;
    }
    ++held;
    const Vec3 n_W = X.linear() * (facing == Facing::up ? n : Vec3(-n));
    const PlanarAxes axes{Vec<double>(n_W)};
    const Vec<double> nearest = rotate(X, set.support(Vec<double>(n)).p);
    const Flat flat = FlatSearch(set, X, axes, facing, nearest, tilt).run();
    ASSERT_EQ(flat.face, face);
    EXPECT_EQ(flat.tilt, tilt);
    PolygonLanes wanted{}, found{};
    for (int k = 0; k < lane_count; ++k) ASSERT_TRUE(wanted.set(k, flat));
    const PlanarLaneAxes lane_axes(LaneVec::all(Vec<double>(n_W)));
    lanes.place(holds, LanePose::all(X), LaneVec::all(nearest), lane_axes, found);
    EXPECT_NE(bits_of(found.valid), 0U);
    EXPECT_EQ(bits_of(found.is_large), bits_of(wanted.is_large));
    EXPECT_NEAR(found.slope.x[0], wanted.slope.x[0], 1e-13);
    EXPECT_NEAR(found.slope.y[0], wanted.slope.y[0], 1e-13);
    const std::size_t size = wanted.is_large[0] != 0 ? PolygonLanes::most : 4;
    for (std::size_t c = 0; c < size; ++c) {
      EXPECT_NEAR(found.corners[c].x[0], wanted.corners[c].x[0], 1e-14);
      EXPECT_NEAR(found.corners[c].y[0], wanted.corners[c].y[0], 1e-14);
    }
  }
  EXPECT_GT(held, 300);
  EXPECT_GT(lost, 300);
}

TEST(FaceLanes, ForgetAFaceThatWasRemoved) {
  const Shape prism = Shape::hull(families::prism(6, 0.1, 0.1).vertices);
  const Convex& set = prism.level(0).core;
  FaceLanes lanes;
  lanes.set(0, set, 0, Facing::up);
  const LaneVec n = LaneVec::all(set.faces().normal(0));
  EXPECT_EQ(bits_of(lanes.holds(n, all_of(tilt))), 1U);
  lanes.remove(0);
  EXPECT_EQ(bits_of(lanes.holds(n, all_of(tilt))), 0U);
}

}  // namespace face_lanes_test
}  // namespace repel::detail
