// SPDX-License-Identifier: BSD-3-Clause
// The hardest pairs found by a search: the iteration limit holds, and a query stopped at any
// iteration returns valid bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include <accuracy/known_worst.hpp>

namespace repel {
namespace worst_case_test {

using accuracy::Duel;
using accuracy::known_worst;
using accuracy::made;
using oracle::Real;

class WorstCase : public ::testing::TestWithParam<Duel> {
 protected:
  const Duel duel = GetParam();
  const accuracy::Specimen A = made(duel.a);
  const accuracy::Specimen B = made(duel.b);
  const Pose X_WA = Pose::Identity();
  const Pose X_WB = duel.X_AB();
  const double size = std::max(A.size, B.size);
};

std::string test_name(const ::testing::TestParamInfo<Duel>& duel) {
  const auto name = [](const accuracy::Recipe& r) {
    return (accuracy::is_hull(r) ? "hull_" : "") + std::string(r.kind);
  };
  return name(duel.param.a) + "_" + name(duel.param.b) + "_" + std::to_string(duel.index);
}
INSTANTIATE_TEST_SUITE_P(Known, WorstCase, ::testing::ValuesIn(known_worst), test_name);

TEST_P(WorstCase, StaysUnderTheCapColdAndWarm) {
  for (const bool warm : {false, true}) {
    const Separation s = accuracy::solve(duel, A, B, warm);
    EXPECT_LE(s.iterations, 2 * QueryOptions{}.iterations + 13);
    EXPECT_NE(s.end, QueryEnd::bad_input);
    EXPECT_LE(s.lower, s.distance);
    EXPECT_LE(s.distance, s.upper);
    if (s.end == QueryEnd::converged && s.lower > 0.0) {
      EXPECT_LE(s.upper - s.lower, std::max(1e-7 * size, 1e-7 * s.distance));
    }
  }
}

TEST_P(WorstCase, AStopAfterAnyIterationLeavesATrueBracket) {
  const oracle::Bracket truth = accuracy::PosedPair(A, X_WA, B, X_WB).distance();
  const Separation whole = separation(A.shape, X_WA, B.shape, X_WB);
  int stopped = 0;
  for (int k = 1; k <= std::min(whole.iterations, 80); ++k) {
    const Separation s = separation(A.shape, X_WA, B.shape, X_WB, {.iterations = k});
    if (truth.lower > 0) {
      EXPECT_LE(Real(s.lower), truth.upper) << k;
      EXPECT_GE(Real(s.upper), truth.lower) << k;
    }
    EXPECT_LE(s.lower, whole.upper) << k;
    EXPECT_GE(s.upper, whole.lower) << k;
    EXPECT_LE(s.iterations, 2 * k + 13);
    stopped += s.end == QueryEnd::budget_spent ? 1 : 0;
  }
  EXPECT_GT(stopped, 0);
}

TEST(WorstCases, AreStillHard) {
  int most = 0;
  for (const Duel& duel : known_worst) {
    most = std::max(most, accuracy::solve(duel, made(duel.a), made(duel.b), true).iterations);
  }
  EXPECT_GT(most, 10);
}

}  // namespace worst_case_test
}  // namespace repel
