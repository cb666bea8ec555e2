// SPDX-License-Identifier: BSD-3-Clause
#include <repel/reduction/basis_roles.hpp>

#include <gtest/gtest.h>

namespace repel::detail {
namespace basis_roles_test {

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

}  // namespace basis_roles_test
}  // namespace repel::detail
