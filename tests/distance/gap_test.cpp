// SPDX-License-Identifier: BSD-3-Clause
#include <repel/distance/gap.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace gap_test {

TEST(Gap, ADefaultOneClaimsNothing) {
  const Gap gap;
  EXPECT_EQ(gap.end, QueryEnd::bad_input);
  EXPECT_FALSE(gap.meets);
  EXPECT_EQ(gap.lower, 0.0);
  EXPECT_EQ(gap.upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(to_vec3(gap.n_BA_W), Vec3::Zero());
}

}  // namespace gap_test
}  // namespace repel
