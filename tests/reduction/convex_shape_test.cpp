// SPDX-License-Identifier: BSD-3-Clause
// The only include of the library: all shapes but hulls are built without reduction/shape.hpp.
#include <repel/reduction/convex_shape.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace convex_shape_test {

TEST(ConvexShape, AllButHullsAreBuiltWithoutWhatBuildsHulls) {
  EXPECT_EQ(Shape::box({1, 2, 3}).inscribed_radius(), 1.0);
  EXPECT_EQ(Shape::sphere(0.5).reach(), 0.5);
  EXPECT_EQ(Shape::capsule(0.5, 1.0).reach(), 1.5);
  EXPECT_EQ(Shape::cylinder(3.0, 4.0).reach(), 5.0);
  EXPECT_EQ(Shape::cone(3.0, 4.0).reach(), 5.0);
  EXPECT_EQ(Shape::ellipsoid({3.0, 4.0, 5.0}).reach(), 5.0);
  EXPECT_THROW((void)Shape::sphere(-1.0), SetupError);
}

TEST(ConvexShape, TheBoundOfTheMemoryOfAHullIsKnownWithoutThem) {
  EXPECT_GT(Shape::most_bytes_of_hull(100), Shape::most_bytes_of_hull(10));
  EXPECT_GT(Shape::most_bytes_of_hull(4), Shape::most_bytes());
}

}  // namespace convex_shape_test
}  // namespace repel
