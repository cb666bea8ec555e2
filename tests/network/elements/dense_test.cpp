// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/dense.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "network/drawn.hpp"

namespace repel::network {
namespace dense_test {

constexpr unsigned seed = 29;

TEST(Dense, ProductsAreThoseOfEigen) {
  test::Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "draw", i));
    const int n = families::count_between(rng, 1, most_joints);
    const test::Matrix S = test::drawn_gain(rng, n, 0.1, 1.0);
    Eigen::Matrix<double, any_size, 6, Eigen::ColMajor, most_joints, 6> A(n, 6);
    for (double& x : A.reshaped()) x = families::uniform(rng, -1.0, 1.0);
    const Eigen::Matrix<double, any_size, 6> B = A.reverse();
    const test::Vector x = test::drawn_vector(rng, n, 1.0);

    test::Vector y = x;
    dense::add_product(S, x, y, -2.0);
    EXPECT_LE((y - (x - 2.0 * S * x)).norm(), 1e-13);
    test::Vector down;
    dense::transposed_product(A, x, down);
    EXPECT_LE((down - A.transpose() * x).norm(), 1e-13);
    test::Matrix product;
    dense::sandwich(A, S, B, product);
    EXPECT_LE((product - A.transpose() * S * B).norm(), 1e-12);
  }
}

TEST(Dense, SixRowsAreAddedAndTransposedLikeAnyOther) {
  test::Rng rng(seed);
  for (int n = 1; n <= most_joints; ++n) {
    SCOPED_TRACE(families::of_seed(seed, "columns", n));
    Eigen::Matrix<double, 6, any_size, Eigen::ColMajor, 6, most_joints> J(6, n);
    for (double& x : J.reshaped()) x = families::uniform(rng, -1.0, 1.0);
    const test::Vector rates = test::drawn_vector(rng, n, 1.0);
    const test::Vector effort = test::drawn_vector(rng, 6, 1.0);
    EXPECT_LE((dense::product<test::Vector>(J, rates) - J * rates).norm(), 1e-14);
    test::Vector torques;
    dense::transposed_product(J, effort, torques);
    EXPECT_LE((torques - J.transpose() * effort).norm(), 1e-14);
  }
}

TEST(Dense, FactorsSolveAndRefuseWhatIsSingular) {
  test::Rng rng(seed);
  for (int n = 1; n <= most_joints; ++n) {
    SCOPED_TRACE(families::of_seed(seed, "size", n));
    const test::Matrix S = test::drawn_gain(rng, n, 0.1, 1.0);
    const test::Vector x = test::drawn_vector(rng, n, 1.0);
    test::Vector y = S * x;
    dense::Factored factored;
    ASSERT_TRUE(factored.factor(n, [&](Eigen::Index i) { return S.data()[i]; }));
    factored.solve(y);
    EXPECT_LE((y - x).norm(), 1e-12);
    EXPECT_FALSE(factored.factor(n, [&](Eigen::Index) { return n > 1 ? 1.0 : 0.0; }));
    EXPECT_FALSE(factored.factor(n, [](Eigen::Index) { return NAN; }));
  }
}

TEST(Dense, EigenvectorsAndEigenvaluesMakeUpTheMatrix) {
  test::Rng rng(seed);
  for (int i = 0; i < 300; ++i) {
    SCOPED_TRACE(families::of_seed(seed, "draw", i));
    const int n = families::count_between(rng, 1, most_joints);
    const int zeros = families::count_between(rng, 0, n);
    const test::Matrix S =
        i % 2 == 0 ? test::drawn_gain(rng, n, 1e-3, 1.0, zeros) : test::drawn_singular(rng, n);
    test::Matrix diagonal = S, vectors = S;
    dense::diagonalize(diagonal.data(), vectors.data(), n);
    const test::Matrix values = diagonal.diagonal().asDiagonal();
    EXPECT_LE((diagonal - values).norm(), 1e-14 * S.norm());
    EXPECT_LE((vectors.transpose() * vectors - test::Matrix::Identity(n, n)).norm(), 1e-13);
    EXPECT_LE((vectors * values * vectors.transpose() - S).norm(), 1e-13 * S.norm());
  }
}

}  // namespace dense_test
}  // namespace repel::network
