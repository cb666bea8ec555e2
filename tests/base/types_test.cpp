// SPDX-License-Identifier: BSD-3-Clause
#include <repel/base/types.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <random>

/// The same with Eigen's own expressions, which is what code outside namespace repel gets.
namespace by_eigen {
Eigen::Vector3d sum(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double s) {
  return -(s * a + b) - a * s + b / s;
}
Eigen::Vector3d turned(const Eigen::Matrix3d& R, const Eigen::Vector3d& v) {
  return R * v;
}
Eigen::Matrix3d product(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B) {
  return A * B;
}
Eigen::Vector3d placed(const Eigen::Isometry3d& X, const Eigen::Vector3d& p) {
  return X * p;
}
}  // namespace by_eigen

namespace repel {
namespace types_test {

constexpr double not_finite[] = {std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::infinity(),
                                 -std::numeric_limits<double>::infinity()};

TEST(Types, AVectorIsFiniteUnlessOneEntryIsNot) {
  EXPECT_TRUE(is_finite(Vec3(1.0, -1e308, 5e-324)));
  for (const double bad : not_finite) {
    for (int i = 0; i < 3; ++i) {
      Vec3 v(1.0, 2.0, 3.0);
      v[i] = bad;
      EXPECT_FALSE(is_finite(v)) << "entry " << i << " is " << bad;
    }
  }
}

TEST(Types, InfinitiesOfBothSignsDoNotCancel) {
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_finite(Vec3(inf, -inf, 0.0)));
  Pose X = Pose::Identity();
  X.translation() << inf, -inf, 0.0;
  EXPECT_FALSE(is_finite(X));
}

TEST(Types, APoseIsFiniteUnlessOneOfItsTwelveEntriesIsNot) {
  EXPECT_TRUE(is_finite(Pose::Identity()));
  for (const double bad : not_finite) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) {
        Pose X = Pose::Identity();
        X.matrix()(row, column) = bad;
        EXPECT_FALSE(is_finite(X)) << row << ", " << column << " is " << bad;
      }
    }
  }
}

TEST(Types, APoseWithAnEntryThatIsNoNumberIsNotRigid) {
  for (const double bad : not_finite) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        Pose X = Pose::Identity();
        X.matrix()(row, column) = bad;
        EXPECT_FALSE(is_rigid(X)) << row << ", " << column << " is " << bad;
      }
    }
  }
}

TEST(Types, ARotationIsRigidUpToTheTolerance) {
  Pose X = Pose::Identity();
  X.linear() = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  X.translation() << 1e6, 0.0, 0.0;
  EXPECT_TRUE(is_rigid(X));
  X.linear()(0, 1) += 1e-7;
  EXPECT_FALSE(is_rigid(X));
  EXPECT_TRUE(is_rigid(X, 1e-6));
}

TEST(Types, ScaledShearedAndMirroredPosesAreNotRigid) {
  Pose scaled = Pose::Identity();
  scaled.linear() *= 1.001;
  EXPECT_FALSE(is_rigid(scaled));
  Pose sheared = Pose::Identity();
  sheared.linear()(0, 2) = 0.01;
  EXPECT_FALSE(is_rigid(sheared));
  Pose mirrored = Pose::Identity();
  mirrored.linear()(2, 2) = -1.0;
  EXPECT_FALSE(is_rigid(mirrored));
}

TEST(Types, APoseThatIsNotFiniteIsNotRigid) {
  for (const double bad : not_finite) {
    Pose X = Pose::Identity();
    X.linear()(1, 1) = bad;
    EXPECT_FALSE(is_rigid(X)) << bad;
  }
}

Pose drawn_pose(std::mt19937& random) {
  std::normal_distribution<double> number;
  Pose X = Pose::Identity();
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 3; ++row) X(row, column) = number(random);
  }
  return X;
}

// Rounding may differ because the compiler may use fused multiply-add.
#if !defined(__FMA__) && !defined(__ARM_FEATURE_FMA)
TEST(Types, SumsAndProductsHaveTheBitsOfEigens) {
  std::mt19937 random(17);
  for (int i = 0; i < 2000; ++i) {
    const Pose X = drawn_pose(random);
    const Pose Y = drawn_pose(random);
    const Mat3 R = rotation(X);
    const Vec3 a = origin(X);
    const Vec3 b = origin(Y);
    const double s = Y(0, 0);
    EXPECT_EQ(Vec3(-(s * a + b) - a * s + b / s), by_eigen::sum(a, b, s));
    EXPECT_EQ(Vec3(R * b), by_eigen::turned(R, b));
    EXPECT_EQ(Mat3(R * rotation(Y)), by_eigen::product(R, rotation(Y)));
    EXPECT_EQ(Vec3(X * b), by_eigen::placed(X, b));
    EXPECT_EQ(composed(X, Y).matrix(), (X * Y).matrix());
    EXPECT_EQ(direction_of(a), a.stableNormalized());
  }
}
#endif

TEST(Types, PartsOfPosesAndVectors) {
  std::mt19937 random(18);
  const Pose X = drawn_pose(random);
  EXPECT_EQ(origin(X), Vec3(X.translation()));
  EXPECT_EQ(rotation(X), Mat3(X.linear()));
  EXPECT_EQ(transposed(rotation(X)), Mat3(X.linear().transpose()));
  for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(unit(axis), Vec3(Vec3::Unit(axis)));
  EXPECT_EQ(largest_entry({1.0, -3.0, 2.0}), 3.0);
  EXPECT_TRUE(is_same({1.0, -3.0, 0.0}, {1.0, -3.0, -0.0}));
  for (int k = 0; k < 3; ++k) EXPECT_FALSE(is_same(unit(k), {0.0, 0.0, 0.0}));
  EXPECT_EQ(direction_of({0, 0, 0}), Vec3(0, 0, 0));
  EXPECT_NEAR(direction_of({3e-200, 0.0, 4e-200}).norm(), 1.0, 1e-15);
}

}  // namespace types_test
}  // namespace repel
