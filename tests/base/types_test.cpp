#include <repel/base/types.hpp>

#include <gtest/gtest.h>

#include <limits>

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

}  // namespace types_test
}  // namespace repel
