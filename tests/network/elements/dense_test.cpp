#include <repel/network/elements/dense.hpp>

#include <gtest/gtest.h>

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

}  // namespace dense_test
}  // namespace repel::network
