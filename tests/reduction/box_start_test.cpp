// SPDX-License-Identifier: BSD-3-Clause
#include <repel/reduction/box_start.hpp>

#include <gtest/gtest.h>

#include <repel/reduction/way_out.hpp>

#include "reduction/posed_boxes.hpp"

namespace repel::detail {
namespace box_start_test {

using families::Rng;

constexpr unsigned seed = 4711;

PosedPlanes planes_of(const Shape& box, const Pose& X_W) {
  return {box.planes(), X_W, box.reach()};
}

TEST(BoxStart, IsTheTopOfATableAndTheLowestCornerOfABoxOnIt) {
  const Shape table = Shape::box({1.0, 1.0, 0.1});
  const Shape box = Shape::box({0.1, 0.2, 0.3});
  Pose X_WB = Pose::Identity();
  // The corner against all three of its axes is the lowest.
  X_WB.linear() = Eigen::AngleAxisd(std::acos(1.0 / std::sqrt(3.0)), Vec3(1, -1, 0).normalized())
                      .toRotationMatrix();
  ASSERT_GT(X_WB.linear().row(2).minCoeff(), 0.5);
  X_WB.translation() = Vec3(0.1, 0.2, 0.4);
  const Pose X_WA = Pose::Identity();
  const auto above = box_start(planes_of(table, X_WA), planes_of(box, X_WB), Vec<double>(0, 0, 0));
  EXPECT_EQ(above.side, 0U);
  EXPECT_EQ(above.face, 4U);
  EXPECT_EQ(above.corner, (std::array<std::uint32_t, 3>{1, 3, 5}));
  const auto swapped =
      box_start(planes_of(box, X_WB), planes_of(table, X_WA), Vec<double>(0, 0, 0));
  EXPECT_EQ(swapped.side, 1U);
  EXPECT_EQ(swapped.face, above.face);
  EXPECT_EQ(swapped.corner, above.corner);
}

TEST(BoxStart, TheCornerIsBelowTheFaceByTheLeastOverlapOfAllFaces) {
  Rng rng(seed);
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "pair", i));
    const test::PosedBoxes boxes = test::overlapping_boxes(rng);
    const PosedPlanes A = planes_of(boxes.A, boxes.X_WA);
    const PosedPlanes B = planes_of(boxes.B, boxes.X_WB);
    const BoxStart start = box_start(A, B, Vec<double>(0, 0, 0));
    const PosedPlanes& one = start.side == 0 ? A : B;
    const PosedPlanes& other = start.side == 0 ? B : A;
    Vec3 corner(0, 0, 0);
    for (const std::uint32_t face : start.corner) {
      corner += other.planes.offset(face) * to_vec3(other.planes.normal(face));
    }
    const Vec3 n = one.X_W.linear() * to_vec3(one.planes.normal(start.face));
    const double depth =
        one.planes.offset(start.face) - n.dot(other.X_W * corner - one.X_W.translation());
    // The shortest axis is that with the least overlap.
    const PosedShape a{boxes.A, boxes.X_WA};
    const PosedShape b{boxes.B, boxes.X_WB};
    EXPECT_NEAR(depth, overlap_along(shortest_axis(a, b), a, b), 1e-14 * boxes.size());
  }
}

}  // namespace box_start_test
}  // namespace repel::detail
