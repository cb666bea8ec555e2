// SPDX-License-Identifier: BSD-3-Clause
#include <repel/base/rotation.hpp>

#include <gtest/gtest.h>

#include <numbers>
#include <random>

/// The same with Eigen's own types.
namespace by_eigen {
Eigen::Isometry3d inverted(const Eigen::Isometry3d& X) {
  return X.inverse();
}
Eigen::AngleAxisd turn(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to) {
  return Eigen::AngleAxisd(Eigen::Matrix3d(to.linear() * from.linear().transpose()));
}
Eigen::Matrix3d between(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to, double share) {
  const Eigen::Quaterniond first(from.linear());
  const Eigen::Quaterniond last(to.linear());
  return first.slerp(share, last).toRotationMatrix();
}
}  // namespace by_eigen

namespace repel {
namespace rotation_test {

using Random = std::mt19937;

/// Angles of all sizes, those near 0 and pi among them.
double random_angle(Random& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const int kind = std::uniform_int_distribution(0, 5)(random);
  if (kind == 0) return 0.0;
  if (kind == 1) return std::pow(10.0, 60.0 * (unit(random) - 1.0));
  if (kind == 2) return std::numbers::pi * (1.0 - std::pow(10.0, 8.0 * (unit(random) - 1.0)));
  return std::numbers::pi * unit(random);
}

Pose random_turn(Random& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const Vec3 axis = normalized(Vec3(unit(random), unit(random), unit(random)));
  return Pose(Eigen::AngleAxisd(random_angle(random), axis));
}

Pose random_pose(Random& random) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Pose X = random_turn(random);
  X.translation() = Vec3(unit(random), unit(random), unit(random));
  return X;
}

TEST(Rotation, AnInversePoseIsThatOfEigen) {
  const unsigned seed = std::random_device{}();
  Random random(seed);
  for (int i = 0; i < 2000; ++i) {
    const Pose X = random_pose(random);
    EXPECT_EQ(inverted(X).matrix(), by_eigen::inverted(X).matrix()) << "seed " << seed;
  }
}

TEST(Rotation, AngleAndAxisAreThoseOfEigen) {
  const unsigned seed = std::random_device{}();
  Random random(seed);
  int tiny = 0, turned_back = 0;
  for (int i = 0; i < 4000; ++i) {
    const Pose from = random_pose(random);
    const Pose to = i % 2 == 0 ? random_pose(random) : from * random_turn(random);
    const Turn turn = turn_of(rotation(to) * transposed(rotation(from)));
    const Eigen::AngleAxisd same = by_eigen::turn(from, to);
    EXPECT_EQ(turn.angle, same.angle()) << "seed " << seed;
    EXPECT_EQ(turn.axis, same.axis()) << "seed " << seed;
    tiny += turn.angle < 1e-15 ? 1 : 0;
    turned_back += turn.angle > 3.0 ? 1 : 0;
  }
  EXPECT_GT(tiny, 10) << "seed " << seed;
  EXPECT_GT(turned_back, 10) << "seed " << seed;
}

TEST(Rotation, TinyAnglesKeepTheirAxis) {
  Mat3 R = Mat3::Identity();
  R(1, 0) = 1e-200;
  R(0, 1) = -1e-200;
  const Turn turn = turn_of(R);
  EXPECT_DOUBLE_EQ(turn.angle, 1e-200);
  EXPECT_EQ(turn.axis, Vec3(0, 0, 1));
  EXPECT_EQ(turn_of(Mat3::Identity()).angle, 0.0);
  EXPECT_EQ(turn_of(Mat3::Identity()).axis, Vec3(1, 0, 0));
}

TEST(Rotation, TheWayBetweenTwoIsThatOfEigen) {
  const unsigned seed = std::random_device{}();
  Random random(seed);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int i = 0; i < 4000; ++i) {
    const Pose from = random_pose(random);
    const Pose to = i % 2 == 0 ? random_pose(random) : from * random_turn(random);
    const double s = share(random);
    EXPECT_EQ(between(rotation(from), rotation(to), s), by_eigen::between(from, to, s))
        << "seed " << seed;
  }
}

}  // namespace rotation_test
}  // namespace repel
