// SPDX-License-Identifier: BSD-3-Clause
#include <repel/reduction/plane_basis.hpp>

#include <gtest/gtest.h>

namespace repel::detail {
namespace plane_basis_test {

/// A cube of half a metre and a smaller one that protrudes from its upper face.
template <class T>
struct Cubes {
  Planes planes_a = Planes::box({0.5, 0.5, 0.5});
  Planes planes_b = Planes::box({0.1, 0.1, 0.1});
  Pose X_WA = Pose::Identity();
  Pose X_WB = Pose::Identity();
  PosedPlanes A{planes_a, X_WA, 1.0};
  PosedPlanes B{planes_b, X_WB, 0.2};
  PlaneBasis<T> basis;

  Cubes() : basis((X_WB.translation().z() = 0.55, A), B) {}
};

TEST(PlaneBasis, SolvesItsEquations) {
  Cubes<double> cubes;
  PlaneBasis<double>& basis = cubes.basis;
  basis.add(0, 4);  // z + a <= 0.5
  basis.add(1, 5);  // -z + b <= -0.45
  basis.add(1, 0);
  basis.add(1, 1);
  basis.add(1, 2);
  ASSERT_TRUE(basis.weigh());
  // Four planes of the small cube intersect where its lower face is 0.1 deep.
  EXPECT_NEAR(basis.point().x(), 0.0, 1e-15);
  EXPECT_NEAR(basis.point().y(), 0.0, 1e-15);
  EXPECT_NEAR(basis.point().z(), 0.55, 1e-15);
  EXPECT_NEAR(basis.bound(), 0.05, 1e-15);
  EXPECT_NEAR(basis.least_multiplier(), 0.0, 1e-15);
}

TEST(PlaneBasis, ExchangesUntilNothingIsViolated) {
  Cubes<double> cubes;
  PlaneBasis<double>& basis = cubes.basis;
  for (std::uint32_t k = 0; k < 4; ++k) basis.add(0, PlaneBasis<double>::first_bound + k);
  basis.add(1, PlaneBasis<double>::depth_bound);
  ASSERT_TRUE(basis.weigh());
  double bound = basis.bound();
  int exchanges = 0;
  for (; exchanges < 30; ++exchanges) {
    const auto entry = basis.most_violated(1e-15);
    if (!(entry.violation > 1e-15)) break;
    ASSERT_TRUE(basis.exchange(entry, 1e-9, 1e-14));
    ASSERT_TRUE(basis.weigh());
    EXPECT_GE(basis.least_multiplier(), -1e-12);
    const double now = basis.bound();
    EXPECT_LE(now, bound + 1e-15) << "the bound only falls";
    bound = now;
  }
  EXPECT_GT(exchanges, 2);
  EXPECT_LT(exchanges, 30);
  // The small cube is 0.05 deep in the large one; no point has a larger depth in both.
  EXPECT_NEAR(bound, 0.05, 1e-14);
}

TEST(PlaneBasis, EquationsWithoutASolutionAreRefused) {
  Cubes<double> cubes;
  PlaneBasis<double>& basis = cubes.basis;
  for (const std::uint32_t plane : {0U, 0U, 0U}) basis.add(0, plane);
  basis.add(1, 1);
  basis.add(1, 2);
  EXPECT_FALSE(basis.weigh());
}

// For any assignment of the rows to A and B, each row eliminates a depth of its own side or is an
// equation of it.
TEST(BasisRoles, EveryRowHasOneRoleOnItsOwnSide) {
  constexpr auto all = all_basis_roles();
  for (unsigned of_b = 1; of_b < 31; ++of_b) {
    SCOPED_TRACE(of_b);
    const BasisRoles& roles = all[of_b];
    unsigned seen = 0;
    for (unsigned s = 0; s < 2; ++s) {
      EXPECT_EQ(of_b >> roles.base[s] & 1U, s);
      seen |= 1U << roles.base[s];
    }
    for (std::size_t e = 0; e < 3; ++e) {
      const unsigned side = of_b >> roles.equation[e] & 1U;
      EXPECT_EQ(roles.side[e], side);
      EXPECT_EQ(roles.has[side][e], 1.0);
      EXPECT_EQ(roles.has[1 - side][e], 0.0);
      EXPECT_GT(roles.equation[e], roles.base[side]) << "the first row of a side is its base";
      seen |= 1U << roles.equation[e];
    }
    EXPECT_EQ(seen, 31U);
  }
}

// If all five are of one side, they do not determine the other.
TEST(BasisRoles, RowsOfOneSideOnlyHaveNone) {
  constexpr auto all = all_basis_roles();
  EXPECT_EQ(all[0].base[0], all[0].base[1]);
  EXPECT_EQ(all[31].base[0], all[31].base[1]);
}

}  // namespace plane_basis_test
}  // namespace repel::detail
