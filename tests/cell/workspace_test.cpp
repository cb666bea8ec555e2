// SPDX-License-Identifier: BSD-3-Clause
// Poses all over the workspace.
#include <repel/cell/workspace.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace repel {
namespace workspace_test {

// Eight by eight squares over two joints: 256 random poses would leave one of them empty.
TEST(Workspace, PosesAreSpreadEvenlyOverTheRangesOfTheJoints) {
  ArmDescription arm;
  arm.model.links = {{.lower = -1.0, .upper = 3.0}, {.lower = 0.0, .upper = 0.5}};
  arm.start = {0.0, 0.0};
  std::vector<double> q(2);
  int hits[8][8] = {};
  for (int pose = 0; pose < 256; ++pose) {
    detail::draw_pose(arm, pose, q);
    ASSERT_TRUE(q[0] >= -1.0 && q[0] <= 3.0 && q[1] >= 0.0 && q[1] <= 0.5);
    ++hits[static_cast<int>(2.0 * (q[0] + 1.0))][static_cast<int>(16.0 * q[1])];
  }
  for (const auto& row : hits) {
    EXPECT_GE(*std::min_element(row, row + 8), 2);
    EXPECT_LE(*std::max_element(row, row + 8), 6);
  }
}

TEST(Workspace, JointsWithoutEndTurnOnceOrStayAtTheStart) {
  constexpr double endless = std::numeric_limits<double>::infinity();
  ArmDescription arm;
  arm.model.links = {{.lower = -endless, .upper = endless},
                     {.type = JointType::prismatic, .lower = 0.0, .upper = endless}};
  arm.start = {0.0, 0.7};
  std::vector<double> q(2);
  double least = 0.0, most = 0.0;
  for (int pose = 0; pose < 64; ++pose) {
    detail::draw_pose(arm, pose, q);
    least = std::min(least, q[0]);
    most = std::max(most, q[0]);
    EXPECT_EQ(q[1], 0.7);
  }
  EXPECT_LT(least, -3.0);
  EXPECT_GT(most, 3.0);
  EXPECT_LE(most, 3.1416);
}

}  // namespace workspace_test
}  // namespace repel
