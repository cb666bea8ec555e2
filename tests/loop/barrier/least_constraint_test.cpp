// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/least_constraint.hpp>

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <span>
#include <vector>

#include <Eigen/Dense>

namespace repel {
namespace least_constraint_test {

constexpr std::size_t joints = 6;
constexpr double step = 5e-3;  // [s]
using Six = std::array<double, joints>;

bool solved(LeastConstraint& solver, std::span<const double> asked, std::span<const double> weight,
            std::span<const double> lower, std::span<const double> upper) {
  solver.ask(asked, weight);
  return solver.solve(lower, upper);
}

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
  bool solve() { return solved(solver, asked, weight, lower, upper); }
  std::mt19937 random;
  Eigen::MatrixXd mass;
  Six asked{}, weight{}, lower{}, upper{};
  LeastConstraint solver{joints, 64};
};

// By the conditions of Karush, Kuhn and Tucker, which are sufficient here.
TEST(LeastConstraint, IsTheSmallestChangeThatKeepsAllBounds) {
  int binding = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Problem problem(seed, 1e9);
    const bool is_changed = problem.solve();
    Eigen::VectorXd push = Eigen::VectorXd::Zero(joints);
    for (const LeastConstraint::Row& row : problem.solver.rows()) {
      EXPECT_GE(row.force, 0.0);
      const double over = problem.solver.rate_after(row) - row.least_rate;
      EXPECT_GT(over, -1e-5);
      if (row.force > 1e-3) {
        ++binding;
        EXPECT_LT(over, 1e-5);
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

// Sixty sweeps of projected Gauss-Seidel left half of the intrusion of a peg between two plates.
TEST(LeastConstraint, HoldsWhatIsBetweenOpposingWallsAtOnce) {
  Problem problem(1, 1e9);
  LeastConstraint& solver = problem.solver;
  ASSERT_TRUE(solver.begin(
      static_cast<Eigen::Index>(joints), [&](Eigen::Index i) { return problem.mass.data()[i]; },
      step));
  LeastConstraint::Vector h = LeastConstraint::Vector::Zero(joints);
  for (int k = 0; k < 20; ++k) {
    for (std::size_t i = 0; i < joints; ++i) {
      h.coeffRef(static_cast<Eigen::Index>(i)) = (i < 2 ? 1.0 : 1e-3) * problem.draw();
    }
    const double rate = 0.1 * problem.draw();
    solver.add(h, rate)->least_rate = -1e-3;
    solver.add(-h, -rate)->least_rate = -1e-3;
  }
  EXPECT_TRUE(problem.solve());
  double largest = 0.0;
  for (const LeastConstraint::Row& row : solver.rows()) largest = std::max(largest, row.force);
  EXPECT_GT(largest, 1.0);
  // By the least squares of what is missed, no step along a row makes it less.
  double before = 0.0;
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(joints);
  for (const LeastConstraint::Row& row : solver.rows()) {
    const double missed = std::max(0.0, row.least_rate - solver.rate_after(row));
    before += missed * missed;
    gradient += missed / row.mobility * row.h;
  }
  EXPECT_NEAR(solver.missed(), std::sqrt(before), std::sqrt(before));
  EXPECT_LT(gradient.norm(), 0.05 * std::sqrt(before) + 1e-6);
}

// By brute force: no other torques within the limits keep the bounds and change less.
TEST(LeastConstraint, NothingWithinTheLimitsThatKeepsTheBoundsIsNearer) {
  int compared = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Problem problem(seed, 21.0);
    (void)problem.solve();
    if (problem.solver.missed() > 1e-5) continue;  // the limits leave no solution
    const Eigen::MatrixXd inverse = problem.mass.inverse();
    Eigen::VectorXd found(joints), asked(joints);
    for (std::size_t i = 0; i < joints; ++i) {
      found[static_cast<Eigen::Index>(i)] = problem.solver.torque(i);
      asked[static_cast<Eigen::Index>(i)] = problem.asked[i];
    }
    const double least = (found - asked).dot(inverse * (found - asked));
    for (int trial = 0; trial < 50; ++trial) {
      Eigen::VectorXd other = found;
      for (Eigen::Index i = 0; i < other.size(); ++i) {
        other[i] = std::clamp(other[i] + 2.0 * problem.draw(), -21.0, 21.0);
      }
      bool is_allowed = true;
      for (const LeastConstraint::Row& row : problem.solver.rows()) {
        double after = row.rate;
        for (std::size_t i = 0; i < joints; ++i) {
          const auto k = static_cast<Eigen::Index>(i);
          after += step * row.moved.coeff(k) * (other[k] - problem.weight[i]);
        }
        is_allowed = is_allowed && after >= row.least_rate;
      }
      if (!is_allowed) continue;
      ++compared;
      EXPECT_GE((other - asked).dot(inverse * (other - asked)), least - 1e-4 * (1.0 + least));
    }
  }
  EXPECT_GT(compared, 500);
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
  EXPECT_FALSE(solved(solver, asked, weight, lower, upper));
  EXPECT_EQ(solver.torque(0), -3.0);
  EXPECT_EQ(solver.torque(1), 4.0);
}

TEST(LeastConstraint, RefusesAMassThatIsNone) {
  LeastConstraint solver(2, 4);
  EXPECT_FALSE(solver.begin(
      2, [](Eigen::Index) { return 1.0; }, step));
}

// The order in which bounds hold that contradict each other.
TEST(LeastConstraint, WhatIsSoftGivesWayToWhatIsFirm) {
  Problem problem(5, 1e3);
  LeastConstraint::Row firm = problem.solver.rows()[0];
  LeastConstraint::Row* away = problem.solver.add(-firm.h, -firm.rate);
  away->give = LeastConstraint::soft;
  away->least_rate = 1.0 - firm.least_rate;  // 1 m/s faster the other way
  EXPECT_TRUE(problem.solve());
  EXPECT_LT(problem.solver.missed(), 2e-2);
  EXPECT_GT(away->least_rate - problem.solver.rate_after(*away), 0.98);
}

}  // namespace least_constraint_test
}  // namespace repel
