// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/least_constraint.hpp>

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include <Eigen/Dense>

namespace repel {
namespace least_constraint_test {

constexpr std::size_t joints = 6;
constexpr double step = 5e-3;  // [s]
using Six = std::array<double, joints>;

/// A random arm, what is asked of it, and bounds on some rates.
struct Problem {
  explicit Problem(unsigned seed, double most) : random(seed) {
    Eigen::MatrixXd root(joints, joints);
    for (Eigen::Index i = 0; i < root.size(); ++i) root.data()[i] = draw();
    mass = root * root.transpose() + 0.2 * Eigen::MatrixXd::Identity(joints, joints);
    for (std::size_t i = 0; i < joints; ++i) {
      asked[i] = 20.0 * draw();
      weight[i] = 5.0 * draw();
      lower[i] = -most;
      upper[i] = most;
    }
    const bool is_regular = solver.begin(
        static_cast<Eigen::Index>(joints), [&](Eigen::Index i) { return mass.data()[i]; }, step);
    EXPECT_TRUE(is_regular);
    for (int k = 0; k < 3; ++k) {
      LeastConstraint::Vector h(joints);
      for (std::size_t i = 0; i < joints; ++i) h.coeffRef(static_cast<Eigen::Index>(i)) = draw();
      solver.add(h, 0.1 * draw())->least_rate = 0.05 * draw();
    }
  }
  double draw() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random); }
  bool solve() { return solver.solve(asked, weight, lower, upper); }
  std::mt19937 random;
  Eigen::MatrixXd mass;
  Six asked{}, weight{}, lower{}, upper{};
  LeastConstraint solver{joints, 8};
};

/// How far the rates are from depending on each other, 0 to 1: a determinant.
double independence(const LeastConstraint& solver) {
  Eigen::Matrix3d cosines;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      const auto& a = solver.rows()[static_cast<std::size_t>(i)];
      const auto& b = solver.rows()[static_cast<std::size_t>(k)];
      cosines(i, k) = a.h.dot(b.moved) / std::sqrt(a.mobility * b.mobility);
    }
  }
  return cosines.determinant();
}

// By the conditions of Karush, Kuhn and Tucker, which are sufficient here.
TEST(LeastConstraint, IsTheSmallestChangeThatKeepsAllBounds) {
  int binding = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Problem problem(seed, 1e9);
    const bool is_changed = problem.solve();
    // Where one rate hardly differs from a sum of others, the sweeps end before.
    if (independence(problem.solver) < 0.1) continue;
    Eigen::VectorXd push = Eigen::VectorXd::Zero(joints);
    for (const LeastConstraint::Row& row : problem.solver.rows()) {
      EXPECT_GE(row.force, 0.0);
      const double over = problem.solver.rate_after(row) - row.least_rate;
      EXPECT_GT(over, -1e-4);
      if (row.force > 1e-3) {
        ++binding;
        EXPECT_LT(over, 1e-4);
      }
      push += row.force * row.h;
    }
    EXPECT_EQ(is_changed, push.norm() > 0.0);
    for (std::size_t i = 0; i < joints; ++i) {
      EXPECT_NEAR(problem.solver.torque(i), problem.asked[i] + push[static_cast<Eigen::Index>(i)],
                  1e-6);
    }
  }
  EXPECT_GT(binding, 100);
}

TEST(LeastConstraint, StaysWithinTheLimitsAndComesAsNearAsTheyAllow) {
  int limited = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Problem problem(seed, 21.0);
    (void)problem.solve();
    for (std::size_t i = 0; i < joints; ++i) {
      EXPECT_LE(std::abs(problem.solver.torque(i)), 21.0);
      if (std::abs(problem.solver.torque(i)) == 21.0) ++limited;
    }
    EXPECT_GE(problem.solver.share(), 0.0);
    EXPECT_LE(problem.solver.share(), 1.0);
    for (const LeastConstraint::Row& row : problem.solver.rows()) {
      double utmost = row.rate;  // [m/s] with all joints at their limits for this row
      for (std::size_t i = 0; i < joints; ++i) {
        const double u = row.moved.coeff(static_cast<Eigen::Index>(i));
        utmost += step * u * ((u > 0.0 ? 21.0 : -21.0) - problem.weight[i]);
      }
      EXPECT_LE(problem.solver.rate_after(row), utmost + 1e-9);
    }
  }
  EXPECT_GT(limited, 50);
}

TEST(LeastConstraint, ChangesNothingWhereAllBoundsHold) {
  LeastConstraint solver(2, 4);
  ASSERT_TRUE(solver.begin(
      2, [](Eigen::Index i) { return i == 0 || i == 3 ? 2.0 : 0.0; }, step));
  LeastConstraint::Vector h(2);
  h << 1.0, 0.0;
  solver.add(h, 0.0)->least_rate = -1.0;
  const std::array<double, 2> asked{-3.0, 4.0};
  const std::array<double, 2> weight{}, lower{-9.0, -9.0}, upper{9.0, 9.0};
  EXPECT_FALSE(solver.solve(asked, weight, lower, upper));
  EXPECT_EQ(solver.torque(0), -3.0);
  EXPECT_EQ(solver.torque(1), 4.0);
}

TEST(LeastConstraint, RefusesAMassThatIsNone) {
  LeastConstraint solver(2, 4);
  EXPECT_FALSE(solver.begin(
      2, [](Eigen::Index) { return 1.0; }, step));
}

}  // namespace least_constraint_test
}  // namespace repel
