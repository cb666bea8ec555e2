// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/junction.hpp>

#include <gtest/gtest.h>

#include "network/drawn.hpp"

namespace repel::network {
namespace junction_test {

constexpr unsigned seed = 83;

Equivalent<any_size> drawn(Rng& rng, int n, bool by_flow, bool insisting) {
  Equivalent<any_size> branch;
  const bool convertible = families::count_between(rng, 0, 1) == 0;
  const Form own = by_flow ? Form::impedance : Form::admittance;
  const Form other = by_flow ? Form::admittance : Form::impedance;
  branch.form = insisting || convertible ? other : own;
  // A free direction is no problem in the requested form.
  const int zeros = convertible ? 0 : families::count_between(rng, 0, n - 1);
  branch.matrix = test::drawn_gain(rng, n, 1e-2, 1e2, zeros);
  if (insisting) branch.matrix = test::drawn_singular(rng, n);
  branch.offset = test::drawn_vector(rng, n, 10.0);
  return branch;
}

/// The offset and matrix of all branches together, by brute force: unknowns are effort and flow of
/// each branch and of the root; the flow (effort) at the root is set to each unit vector in turn.
Vector answer(const std::vector<Equivalent<any_size>>& branches, bool by_flow, Form shown,
              const Vector& given) {
  const Eigen::Index n = given.size();
  const auto count = static_cast<Eigen::Index>(branches.size());
  const Eigen::Index all = 2 * n * (count + 1);
  const Eigen::MatrixXd I = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(all, all);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(all);
  const Eigen::Index same = by_flow ? n : 0;
  const Eigen::Index added = by_flow ? 0 : n;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& branch = branches[static_cast<std::size_t>(i)];
    const bool impedance = branch.form == Form::impedance;
    const Eigen::Index column = 2 * n * (i + 1);
    A.block(2 * n * i, column, n, n) = impedance ? I : Eigen::MatrixXd(-branch.matrix);
    A.block(2 * n * i, column + n, n, n) = impedance ? Eigen::MatrixXd(-branch.matrix) : I;
    b.segment(2 * n * i, n) = branch.offset;
    A.block(2 * n * i + n, column + same, n, n) = I;
    A.block(2 * n * i + n, same, n, n) = -I;
    A.block(2 * n * count, column + added, n, n) = -I;
  }
  A.block(2 * n * count, added, n, n) = I;
  A.block(2 * n * count + n, shown == Form::impedance ? n : 0, n, n) = I;
  b.tail(n) = given;
  const Eigen::VectorXd x = A.fullPivLu().solve(b);
  return x.segment(shown == Form::impedance ? 0 : n, n);
}

TEST(Junction, ShowsTheRootWhatAllBranchesMakeTogether) {
  Rng rng(seed);
  int with_insisting = 0;
  for (int i = 0; i < families::draws(4000); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "draw", i));
    const bool by_flow = i % 2 == 0;
    const int n = families::count_between(rng, 1, 6);
    const int count = families::count_between(rng, 2, 4);
    const int insisting =
        families::count_between(rng, 0, 2 * count);  // at most one fixed form, at any place
    const Junction junction(by_flow ? Common::flow : Common::effort);
    EXPECT_EQ(junction.common(), by_flow ? Common::flow : Common::effort);
    std::vector<Equivalent<any_size>> branches;
    Equivalent<any_size> sum;
    for (int k = 0; k < count; ++k) {
      branches.push_back(drawn(rng, n, by_flow, k == insisting));
      auto branch = branches.back();
      if (k == 0) {
        junction.begin(branch, sum);
      } else {
        ASSERT_TRUE(junction.add(branch, sum));
      }
      // Those that can are left in the form in which the junction solves them.
      const Form settled = by_flow ? Form::impedance : Form::admittance;
      EXPECT_EQ(branch.form == settled, k != insisting);
    }
    with_insisting += insisting < count ? 1 : 0;
    const Vector given = test::drawn_vector(rng, n, 1.0);
    const Vector expected = answer(branches, by_flow, sum.form, given);
    const Vector is = sum.matrix * given + sum.offset;
    EXPECT_LE((is - expected).norm(), 1e-6 * (1.0 + expected.norm() + sum.offset.norm()));
    EXPECT_LE((sum.matrix - sum.matrix.transpose()).norm(), 1e-12 * sum.matrix.norm());
  }
  EXPECT_GT(with_insisting, families::draws(1000));
}

TEST(Junction, RefusesTwoThatInsist) {
  Rng rng(seed);
  for (int i = 0; i < 200; ++i) {
    const bool by_flow = i % 2 == 0;
    const int n = families::count_between(rng, 1, 6);
    const Junction junction(by_flow ? Common::flow : Common::effort);
    auto first = drawn(rng, n, by_flow, true);
    auto between = drawn(rng, n, by_flow, false);
    auto second = drawn(rng, n, by_flow, true);
    first.matrix.setZero();
    second.matrix.setZero();
    Equivalent<any_size> sum;
    junction.begin(first, sum);
    if (i % 4 < 2) {
      ASSERT_TRUE(junction.add(between, sum));
    }
    EXPECT_FALSE(junction.add(second, sum)) << families::of_seed(seed, "draw", i);
  }
}

}  // namespace junction_test
}  // namespace repel::network
