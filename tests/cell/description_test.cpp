// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/description.hpp>

#include <gtest/gtest.h>

namespace repel {
namespace description_test {

TEST(CellDescription, ChecksEverythingUnlessItSaysOtherwise) {
  const CellDescription cell;
  EXPECT_EQ(cell.rate_hz, 400.0);
  EXPECT_EQ(cell.gain_check, network::GainCheck::error);
  EXPECT_EQ(cell.start_inside, StartInside::refuse);
  EXPECT_EQ(cell.measure, Measure::deepest_point);
  EXPECT_FALSE(cell.levels) << "shapes stay as they were built";
  const ArmDescription arm;
  EXPECT_FALSE(arm.options.has_brakes) << "the motors must hold the weight unless brakes can";
  EXPECT_FALSE(arm.self_law);
}

}  // namespace description_test
}  // namespace repel
