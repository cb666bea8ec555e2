// SPDX-License-Identifier: BSD-3-Clause
#include <repel/distance/depth.hpp>

#include <gtest/gtest.h>

namespace repel::detail {
namespace depth_test {

TEST(Depth, ADefaultOneClaimsNothing) {
  const Depth depth;
  EXPECT_EQ(depth.lower, 0.0);
  EXPECT_EQ(depth.upper, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(depth.closed);
}

}  // namespace depth_test
}  // namespace repel::detail
