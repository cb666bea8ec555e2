// SPDX-License-Identifier: BSD-3-Clause
#include <repel/contact/flat.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <repel/reduction/shape.hpp>
#include <support/families.hpp>

namespace repel {
namespace flat_test {

using namespace detail;

constexpr double tilt = 0.005;

/// @param depth [m] of the middle of the feature below the origin of the shape
Flat below(const Shape& shape, double lean_x, double lean_y, double depth = 0.0) {
  Pose X = Pose::Identity();
  X.linear() = (Eigen::AngleAxisd(lean_x, Vec3::UnitX()) * Eigen::AngleAxisd(lean_y, Vec3::UnitY()))
                   .toRotationMatrix();
  const PlanarAxes axes({0.0, 0.0, 1.0});
  const Vec<double> middle(Vec3(-depth * X.linear().col(2)));
  return FlatSearch(shape.level(0).core, X, axes, Facing::down, middle, tilt).run();
}

/// [m] The corner that the slope of a polygon takes farthest down, from the middle.
double lowest(const Flat& flat) {
  double least = 0.0;
  for (int i = 0; i < flat.outline.size; ++i) {
    least = std::min(least, dot(flat.slope, flat.outline.at(i).r));
  }
  return least;
}

bool is_counter_clockwise(const Outline& outline) {
  double turned = 0.0;
  for (int i = 0; i < outline.size; ++i) {
    const Planar a = outline.at(i).r;
    const Planar b = outline.after(i).r;
    turned += std::remainder(std::atan2(b.y, b.x) - std::atan2(a.y, a.x), 2.0 * M_PI);
  }
  return std::abs(turned - 2.0 * M_PI) < 1e-9;
}

TEST(Flat, BoxShowsAFaceAnEdgeOrACorner) {
  const Shape box = Shape::box({0.3, 0.2, 0.1});
  const Flat face = below(box, 0.01, -0.02);
  ASSERT_EQ(face.outline.size, 4);
  EXPECT_TRUE(is_counter_clockwise(face.outline));
  EXPECT_NEAR(norm(face.slope), std::hypot(0.01, 0.02), 1e-4);
  EXPECT_EQ(below(box, 0.3, 0.01).outline.size, 2);
  EXPECT_EQ(below(box, 0.3, 0.3).outline.size, 1);
  EXPECT_EQ(below(Shape::box({0.3, 0.2, 0.0}), 0.0, 0.0).outline.size, 4);
  EXPECT_EQ(below(Shape::box({0.3, 0.0, 0.0}), 0.0, 0.0).outline.size, 2);
  EXPECT_EQ(below(Shape::sphere(0.1), 0.0, 0.0).outline.size, 1);
}

TEST(Flat, CylinderShowsItsCapItsSideOrAPointOfItsRim) {
  const Shape cylinder = Shape::cylinder(0.1, 0.3);
  const Flat cap = below(cylinder, 0.02, 0.0, 0.3);
  ASSERT_GE(cap.outline.size, 8);
  EXPECT_TRUE(is_counter_clockwise(cap.outline));
  // One corner is the lowest point of the rim.
  EXPECT_NEAR(lowest(cap), -0.1 * std::sin(0.02), 1e-12);
  const Flat side = below(cylinder, M_PI / 2.0 + 0.01, 0.0);
  ASSERT_EQ(side.outline.size, 2);
  EXPECT_EQ(side.radius, 0.1);
  EXPECT_EQ(below(cylinder, 0.5, 0.0).outline.size, 1);
}

TEST(Flat, AnEllipsoidShowsAPoint) {
  EXPECT_EQ(below(Shape::ellipsoid({0.3, 0.2, 0.001}), 0.0, 0.0).outline.size, 1);
}

TEST(Flat, ConeShowsItsBaseItsSideOrAPoint) {
  const Shape cone = Shape::cone(0.1, 0.2);
  EXPECT_GE(below(cone, 0.0, 0.0).outline.size, 8);
  const double to_side = M_PI - std::atan2(0.4, 0.1);
  EXPECT_EQ(below(cone, to_side, 0.0).outline.size, 2);
  EXPECT_EQ(below(cone, M_PI, 0.0).outline.size, 1);
}

TEST(Flat, HullShowsWhatItsVerticesShow) {
  const families::Solid prism = families::prism(6, 0.2, 0.1);
  const Shape hull = Shape::hull(prism.vertices);
  const Flat face = below(hull, 0.01, 0.02);
  ASSERT_EQ(face.outline.size, 6);
  EXPECT_TRUE(is_counter_clockwise(face.outline));
  EXPECT_EQ(below(hull, 0.5, 0.7).outline.size, 1);
}

// A face with very many corners is known by a few of them, among them the lowest.
TEST(Flat, HullWithManyCornersKeepsTheLowest) {
  const families::Solid prism = families::prism(60, 0.2, 0.1);
  const Flat face = below(Shape::hull(prism.vertices), 0.01, 0.02, 0.1);
  ASSERT_GE(face.outline.size, 8);
  ASSERT_LE(face.outline.size, Flat::most);
  EXPECT_TRUE(is_counter_clockwise(face.outline));
  double truth = 0.0;
  const Vec3 down =
      (Eigen::AngleAxisd(0.01, Vec3::UnitX()) * Eigen::AngleAxisd(0.02, Vec3::UnitY()))
          .toRotationMatrix()
          .row(2);
  for (const Vec3& v : prism.vertices) truth = std::min(truth, down.x() * v.x() + down.y() * v.y());
  EXPECT_NEAR(lowest(face), truth, 1e-12);
}

}  // namespace flat_test
}  // namespace repel
