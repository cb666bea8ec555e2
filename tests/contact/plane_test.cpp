// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/plane.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include <support/families.hpp>

namespace repel {
namespace plane_test {

using detail::Planar;
using detail::PlanarAxes;

TEST(PlanarAxes, AreRightHandedAndPerpendicularForEveryNormal) {
  families::Rng rng(11);
  for (int i = 0; i < 1000; ++i) {
    SCOPED_TRACE(families::of_seed(11, "normal", i));
    const Vec3 n = families::direction(rng);
    const PlanarAxes axes{Vec<double>(n)};
    const Vec3 e1 = to_vec3(axes.e1);
    const Vec3 e2 = to_vec3(axes.e2);
    EXPECT_NEAR(e1.norm(), 1.0, 1e-14);
    EXPECT_NEAR(e2.norm(), 1.0, 1e-14);
    EXPECT_LE((e1.cross(e2) - n).norm(), 1e-14);
    const Vec3 v = families::direction(rng);
    const Vec3 back = to_vec3(axes.in_world(axes.in_plane(Vec<double>(v)))) + v.dot(n) * n;
    EXPECT_LE((back - v).norm(), 1e-14);
  }
}

TEST(Planar, CrossIsPositiveCounterClockwise) {
  EXPECT_EQ(cross(Planar{1.0, 0.0}, Planar{0.0, 2.0}), 2.0);
  EXPECT_EQ(norm(Planar{3.0, 4.0}), 5.0);
}

TEST(Outline, TakesNoMoreCornersThanItHasRoomFor) {
  detail::Outline outline;
  for (int i = 0; i < 2 * detail::Outline::most; ++i) outline.add({1.0 * i, 0.0}, true);
  EXPECT_EQ(outline.size, detail::Outline::most);
  EXPECT_EQ(outline.after(outline.size - 1).r.x, 0.0);
}

// What stood behind the last side used to be whatever was there before: with traps on, a run could
// stop at it.
TEST(Sides, FillTheRegistersThatAreRead) {
  detail::Outline outline;
  for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(2.0, 0.0), std::pair(0.0, 1.0)}) {
    outline.add({x, y}, true);
  }
  detail::Sides sides;
  sides.normal_x.fill(std::numeric_limits<double>::signaling_NaN());
  sides.normal_y.fill(std::numeric_limits<double>::signaling_NaN());
  sides.find(outline);
  EXPECT_EQ(sides.length[0], 2.0);
  EXPECT_EQ(sides.normal(0).y, -1.0);
  EXPECT_EQ(sides.least_length(outline.size), 1.0);
  for (int i = 0; i < outline.size; i += detail::lane_count) {
    const detail::Lanes x = detail::Sides::some(sides.normal_x, i);
    const detail::Lanes y = detail::Sides::some(sides.normal_y, i);
    for (int k = 0; k < detail::lane_count; ++k) EXPECT_NEAR(x[k] * x[k] + y[k] * y[k], 1.0, 1e-15);
  }
}

}  // namespace plane_test
}  // namespace repel
