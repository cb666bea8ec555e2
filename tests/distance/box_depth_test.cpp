// SPDX-License-Identifier: BSD-3-Clause
#include <repel/distance/box_depth.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace repel::detail {
namespace box_depth_test {

Pose moved(const Vec3& p) {
  Pose X = Pose::Identity();
  X.translation() = p;
  return X;
}

void expect_point(const Vec<double>& found, const Vec3& expected) {
  EXPECT_LE((to_vec3(found) - expected).norm(), 1e-14);
}

TEST(BoxDepth, AcrossAFaceIsToThatFace) {
  const Convex A = Convex::box({1, 1, 1});
  const Convex B = Convex::box({0.5, 0.5, 0.5});
  const Pose X_WA = moved({2, 3, 4});
  const Depth depth = BoxDepth({A, X_WA, B, moved({3.2, 3.1, 4})}).run();
  EXPECT_NEAR(depth.value, 0.3, 1e-14);
  EXPECT_LE(depth.lower, depth.value);
  EXPECT_GE(depth.upper, depth.value);
  EXPECT_TRUE(depth.closed);
  expect_point(depth.n_W, Vec3::UnitX());
  // On the face of A, below the centre of that of B.
  EXPECT_NEAR(depth.p_AQa_W.x(), 1.0, 1e-14);
  EXPECT_NEAR(depth.p_AQa_W.y(), 0.0, 0.5);
}

TEST(BoxDepth, OfCrossedEdgesIsBetweenThem) {
  const Convex bar = Convex::box({1, 0.1, 0.1});
  Pose X_WA = Pose::Identity();
  X_WA.linear() = Eigen::AngleAxisd(M_PI / 4.0, Vec3::UnitX()).toRotationMatrix();
  Pose X_WB = Pose::Identity();
  X_WB.linear() =
      (Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitZ()) * Eigen::AngleAxisd(M_PI / 4.0, Vec3::UnitX()))
          .toRotationMatrix();
  const double edge = std::sqrt(0.02);  // of a bar above its axis
  X_WB.translation() = Vec3(0.3, 0.2, 2.0 * edge - 0.05);
  const Depth depth = BoxDepth({bar, X_WA, bar, X_WB}).run();
  EXPECT_NEAR(depth.value, 0.05, 1e-14);
  expect_point(depth.n_W, Vec3::UnitZ());
  expect_point(depth.p_AQa_W, Vec3(0.3, 0.0, edge));
}

TEST(BoxDepth, OfABoxThatIsAPointIsItsOwnDepth) {
  const Convex point = Convex::box({0, 0, 0});
  const Convex B = Convex::box({1, 2, 3});
  const Pose X_WB = moved({5, 5, 5});
  const Depth depth = BoxDepth({point, moved({5, 6.5, 4}), B, X_WB}).run();
  EXPECT_NEAR(depth.value, 0.5, 1e-14);
  expect_point(depth.n_W, -Vec3::UnitY());
  expect_point(depth.p_AQa_W, Vec3::Zero());
}

}  // namespace box_depth_test
}  // namespace repel::detail
