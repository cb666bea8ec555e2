// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/polygon_lanes.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <repel/contact/flat.hpp>
#include <repel/reduction/shape.hpp>
#include <support/families.hpp>

namespace repel::detail {
namespace polygon_lanes_test {

constexpr unsigned seed = 44;
constexpr double tilt = 0.005;

TEST(PlanarLaneAxes, AreThoseOfEachLane) {
  families::Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "normal", i));
    const Vec3 n = families::direction(rng);
    const PlanarAxes one{Vec<double>(n)};
    const PlanarLaneAxes lanes(LaneVec::all(Vec<double>(n)));
    EXPECT_LE((lanes.e1.at(0) - to_vec3(one.e1)).norm(), 1e-15);
    EXPECT_LE((lanes.e2.at(0) - to_vec3(one.e2)).norm(), 1e-15);
  }
}

// The faces of boxes are those that FlatSearch finds, and where it finds none there is none.
TEST(PolygonLanes, ShowTheFacesOfBoxes) {
  families::Rng rng(seed);
  int faces = 0;
  for (int i = 0; i < 2000; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "box", i));
    const Vec3 half(families::uniform(rng, 0.1, 1.0), families::uniform(rng, 0.1, 1.0),
                    i % 5 == 0 ? 0.0 : families::uniform(rng, 0.1, 1.0));
    const Shape box = Shape::box(half);
    const Pose X = families::random_pose(rng, -1.0, 1.0);
    const Vec3 lean = families::uniform(rng, 0.0, 0.06) * families::direction(rng);
    const Vec3 own = (unit(families::count_between(rng, 0, 2)) + lean).normalized();
    const Vec3 n = X.linear() * own;
    const PlanarAxes axes{Vec<double>(n)};
    const Vec<double> nearest(n);
    const Flat flat = FlatSearch(box.level(0).core, X, axes, Facing::up, nearest, tilt).run();
    PolygonLanes lanes;
    lanes.set_boxes(LaneVec::all(Vec<double>(half)), LanePose::all(X),
                    LaneVec::all(Vec<double>(own)), LaneVec::all(nearest),
                    PlanarLaneAxes(LaneVec::all(Vec<double>(n))), all_of(flat_within(tilt)));
    EXPECT_EQ(lanes.valid[0] != 0, flat.outline.size == 4);
    if (flat.outline.size != 4) continue;
    ++faces;
    const Planar slope{lanes.slope.x[0], lanes.slope.y[0]};
    EXPECT_LE(norm(slope - flat.slope), 1e-12);
    double off = 1.0;  // from whichever corner they begin, they are in the same order
    for (int first = 0; first < 4; ++first) {
      double most = 0.0;
      for (int k = 0; k < 4; ++k) {
        const PlanarLanes& r = lanes.corners[static_cast<std::size_t>((first + k) % 4)];
        most = std::max(most, norm(Planar{r.x[0], r.y[0]} - flat.outline.at(k).r));
      }
      off = std::min(off, most);
    }
    EXPECT_LE(off, 1e-12);
  }
  EXPECT_GT(faces, 500);
}

TEST(PolygonLanes, DivideTheLastSideIntoWhatIsMissing) {
  Flat triangle;
  for (const Planar& r : {Planar{0.0, 0.0}, Planar{1.0, 0.0}, Planar{0.0, 1.0}}) {
    triangle.outline.add(r, true);
  }
  PolygonLanes lanes;
  for (int k = 0; k < lane_count; ++k) ASSERT_TRUE(lanes.set(k, triangle));
  EXPECT_EQ(bits_of(lanes.is_large), 0U);
  EXPECT_EQ(lanes.corners[3].y[0], 0.5);
  lanes.extend();
  EXPECT_EQ(lanes.size, PolygonLanes::most);
  EXPECT_EQ(lanes.corners[2].y[0], 1.0);
  for (std::size_t i = 3; i < PolygonLanes::most; ++i) {
    EXPECT_LT(lanes.corners[i].y[0], lanes.corners[i - 1].y[0]);
    EXPECT_EQ(lanes.corners[i].x[0], 0.0);
  }
  Flat segment;
  segment.outline.add({0.0, 0.0}, true);
  segment.outline.add({1.0, 0.0}, true);
  EXPECT_FALSE(lanes.set(0, segment));
}

}  // namespace polygon_lanes_test
}  // namespace repel::detail
