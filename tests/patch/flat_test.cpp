#include <repel/patch/flat.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include <repel/reduction/shape.hpp>
#include <support/families.hpp>

namespace repel {
namespace flat_test {

using detail::Flat;
using detail::FlatSearch;

constexpr double tilt = 0.005;

Flat below(const Shape& shape, double lean_x, double lean_y) {
  Pose X = Pose::Identity();
  X.linear() = (Eigen::AngleAxisd(lean_x, Vec3::UnitX()) * Eigen::AngleAxisd(lean_y, Vec3::UnitY()))
                   .toRotationMatrix();
  return FlatSearch(shape.level(0).core, X, Vec<double>(0.0, 0.0, -1.0), tilt).run();
}

TEST(Flat, BoxShowsAFaceAnEdgeOrACorner) {
  const Shape box = Shape::box({0.3, 0.2, 0.1});
  const Flat face = below(box, 0.01, -0.02);
  ASSERT_EQ(face.size, 4);
  EXPECT_NEAR(face.normal.z(), -1.0, 1e-3);
  EXPECT_EQ(below(box, 0.3, 0.01).size, 2);
  EXPECT_EQ(below(box, 0.3, 0.3).size, 1);
  EXPECT_EQ(below(Shape::box({0.3, 0.2, 0.0}), 0.0, 0.0).size, 4);
  EXPECT_EQ(below(Shape::box({0.3, 0.0, 0.0}), 0.0, 0.0).size, 2);
  EXPECT_EQ(below(Shape::sphere(0.1), 0.0, 0.0).size, 1);
}

TEST(Flat, CylinderShowsItsCapItsSideOrAPointOfItsRim) {
  const Shape cylinder = Shape::cylinder(0.1, 0.3);
  const Flat cap = below(cylinder, 0.02, 0.0);
  ASSERT_GE(cap.size, 8);
  // One corner is the lowest point of the rim.
  double lowest = 0.0;
  for (int i = 0; i < cap.size; ++i) lowest = std::min(lowest, cap.at(i).z());
  EXPECT_NEAR(lowest, -0.3 * std::cos(0.02) - 0.1 * std::sin(0.02), 1e-12);
  const Flat side = below(cylinder, M_PI / 2.0 + 0.01, 0.0);
  ASSERT_EQ(side.size, 2);
  EXPECT_EQ(side.radius, 0.1);
  EXPECT_EQ(below(cylinder, 0.5, 0.0).size, 1);
}

TEST(Flat, ConeShowsItsBaseItsSideOrAPoint) {
  const Shape cone = Shape::cone(0.1, 0.2);
  EXPECT_GE(below(cone, 0.0, 0.0).size, 8);
  const double to_side = M_PI - std::atan2(0.4, 0.1);
  EXPECT_EQ(below(cone, to_side, 0.0).size, 2);
  EXPECT_EQ(below(cone, M_PI, 0.0).size, 1);
}

TEST(Flat, HullShowsWhatItsVerticesShow) {
  const families::Solid prism = families::prism(6, 0.2, 0.1);
  const Shape hull = Shape::hull(prism.vertices);
  const Flat face = below(hull, 0.01, 0.02);
  ASSERT_EQ(face.size, 6);
  EXPECT_NEAR(std::abs(face.normal.z()), 1.0, 1e-3);
  // In order around the face.
  double turned = 0.0;
  for (int i = 0; i < face.size; ++i) {
    const Vec3 a = to_vec3(face.at(i));
    const Vec3 b = to_vec3(face.at(i + 1 < face.size ? i + 1 : 0));
    turned += std::remainder(std::atan2(b.y(), b.x()) - std::atan2(a.y(), a.x()), 2.0 * M_PI);
  }
  EXPECT_NEAR(std::abs(turned), 2.0 * M_PI, 1e-9);
  EXPECT_EQ(below(hull, 0.5, 0.7).size, 1);
}

// A face with very many corners is known by a few of them, among them the lowest.
TEST(Flat, HullWithManyCornersKeepsTheLowest) {
  const families::Solid prism = families::prism(60, 0.2, 0.1);
  const Flat face = below(Shape::hull(prism.vertices), 0.01, 0.02);
  ASSERT_GE(face.size, 8);
  ASSERT_LE(face.size, Flat::most);
  Pose X = Pose::Identity();
  X.linear() = (Eigen::AngleAxisd(0.01, Vec3::UnitX()) * Eigen::AngleAxisd(0.02, Vec3::UnitY()))
                   .toRotationMatrix();
  double truth = 0.0;
  for (const Vec3& v : prism.vertices) truth = std::min(truth, (X.linear() * v).z());
  double lowest = 0.0;
  for (int i = 0; i < face.size; ++i) lowest = std::min(lowest, face.at(i).z());
  EXPECT_NEAR(lowest, truth, 1e-12);
}

}  // namespace flat_test
}  // namespace repel
