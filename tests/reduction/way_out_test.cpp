// SPDX-License-Identifier: BSD-3-Clause
#include <repel/reduction/way_out.hpp>

#include <gtest/gtest.h>

#include <string>

#include "reduction/posed_boxes.hpp"

namespace repel {
namespace way_out_test {

using families::Rng;

constexpr unsigned seed = 118;

TEST(WayOut, AShapeMovedByTheOverlapTouches) {
  Rng rng(seed);
  for (int i = 0; i < 500; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "pair", i));
    test::PosedBoxes boxes = test::overlapping_boxes(rng);
    const Vec3 n = families::direction(rng);
    const double overlap = detail::overlap_along(n, {boxes.A, boxes.X_WA}, {boxes.B, boxes.X_WB});
    EXPECT_GE(overlap, boxes.depth() - 1e-14 * boxes.size());
    boxes.X_WA.translation() += overlap * n;
    // A plane normal to n separates them now.
    EXPECT_NEAR(detail::overlap_along(n, {boxes.A, boxes.X_WA}, {boxes.B, boxes.X_WB}), 0.0,
                1e-14 * boxes.size());
  }
}

TEST(WayOut, TheShortestAxisIsThatOfTheThinnestSide) {
  const Shape plate = Shape::box({0.5, 0.01, 0.5});
  const Shape ball = Shape::sphere(0.3);
  Pose X_WB = Pose::Identity();
  X_WB.translation() = Vec3(0.1, 0.02, 0.0);
  EXPECT_EQ(detail::shortest_axis({plate, Pose::Identity()}, {ball, X_WB}), Vec3(0, -1, 0));
  EXPECT_EQ(detail::shortest_axis({ball, X_WB}, {plate, Pose::Identity()}), Vec3(0, 1, 0));
}

TEST(WayOut, APoseThatIsNotANumberStillNamesAnAxis) {
  const Shape box = Shape::box({0.5, 0.1, 0.5});
  Pose X = Pose::Identity();
  X.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(detail::shortest_axis({box, X}, {box, Pose::Identity()}).norm(), 1.0);
}

}  // namespace way_out_test
}  // namespace repel
