// SPDX-License-Identifier: BSD-3-Clause
#include <repel/base/vec.hpp>

#include <gtest/gtest.h>

#include <support/families.hpp>

namespace repel {
namespace vec_test {

constexpr unsigned seed = 5;

template <class T>
class VecOf : public ::testing::Test {};
using Precisions = ::testing::Types<double, DoubleDouble>;
TYPED_TEST_SUITE(VecOf, Precisions);

TYPED_TEST(VecOf, AgreesWithEigen) {
  families::Rng rng(seed);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "sample", i));
    const Vec3 a = families::direction(rng);
    const Vec3 b = families::direction(rng);
    Pose X = Pose::Identity();
    X.linear() = families::rotation(rng);
    X.translation() = 100.0 * families::direction(rng);
    const Vec<TypeParam> u(a);
    const Vec<TypeParam> v(b);
    EXPECT_LE((to_vec3(u + v) - (a + b)).norm(), 1e-15);
    EXPECT_LE((to_vec3(u - v) - (a - b)).norm(), 1e-15);
    EXPECT_EQ(to_vec3(-u), -a);
    EXPECT_LE((to_vec3(TypeParam(3.0) * u) - 3.0 * a).norm(), 1e-15);
    EXPECT_NEAR(static_cast<double>(dot(u, v)), a.dot(b), 1e-15);
    EXPECT_LE((to_vec3(cross(u, v)) - a.cross(b)).norm(), 1e-15);
    // Directions: the translation has no effect.
    EXPECT_LE((to_vec3(rotate(X, u)) - X.linear() * a).norm(), 1e-15);
    EXPECT_LE((to_vec3(rotate_transposed(X, u)) - X.linear().transpose() * a).norm(), 1e-15);
  }
}

TEST(Vec, ColumnsOfAPoseAreSetAndItStaysOne) {
  Pose X = Pose::Identity();
  for (int k = 0; k < 4; ++k) set_column(X, k, Vec<double>(k, 10.0, 0.1 * k));
  for (int k = 0; k < 4; ++k) {
    EXPECT_EQ(to_vec3(column<double>(X, k)), Vec3(k, 10.0, 0.1 * k));
    EXPECT_EQ(X.matrix()(3, k), k == 3 ? 1.0 : 0.0);
  }
}

TYPED_TEST(VecOf, StartsAsZero) {
  EXPECT_EQ(to_vec3(Vec<TypeParam>{}), Vec3(0, 0, 0));
}

TEST(Vec, ExtendedPrecisionSeesACancellationThatDoubleDoesNot) {
  const Vec<DoubleDouble> u(DoubleDouble(1.0), DoubleDouble(1e-20), DoubleDouble(-1.0));
  const Vec<DoubleDouble> ones(DoubleDouble(1.0), DoubleDouble(1.0), DoubleDouble(1.0));
  EXPECT_EQ(static_cast<double>(dot(u, ones)), 1e-20);
}

}  // namespace vec_test
}  // namespace repel
