// SPDX-License-Identifier: BSD-3-Clause
// The limits of input files are consistent with the capacities of what is built from them.
#include <gtest/gtest.h>

#include <repel/base/capacities.hpp>
#include <repel/common/input_limits.hpp>

namespace repel {
namespace input_limits_test {

TEST(InputLimits, AreGenerousForWhatAWorldMayHold) {
  const Capacities world;
  EXPECT_LE(2 * input_limits.entries, static_cast<std::size_t>(world.parts));
  EXPECT_GE(input_limits.hull_points, 40U * 2000U) << "forty hulls of two thousand points";
  EXPECT_GE(input_limits.values, input_limits.hull_points + 14 * input_limits.entries)
      << "all hulls, and as many obstacles as are allowed";
}

}  // namespace input_limits_test
}  // namespace repel
