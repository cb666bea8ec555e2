// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/arm_port.hpp>

#include <gtest/gtest.h>

#include "loop/faulty_slider.hpp"

namespace repel {
namespace arm_port_test {

TEST(ArmPort, ReadsTheArmAndTellsItWhatTheRecordSays) {
  test::BrakedSlider arm;
  arm.q = {1.0, 2.0, 3.0};
  arm.v = {4.0, 5.0, 6.0};
  arm.stop();
  ArmPort port(arm, 3);
  const ArmReadings readings = port.read();
  ASSERT_EQ(readings.q.size(), 3U);
  EXPECT_EQ(readings.q[2], 3.0);
  EXPECT_EQ(readings.v[0], 4.0);
  EXPECT_EQ(readings.state, ArmState::stopped);
  TickRecord record;
  record.torques = {7.0, 8.0, 9.0};
  record.brakes = true;
  port.apply(record);
  EXPECT_EQ(arm.force[1], 8.0);
  EXPECT_TRUE(arm.brakes);
  EXPECT_EQ(port.read().state, ArmState::stopped);
  record.enable = true;
  record.brakes = false;
  port.apply(record);
  EXPECT_EQ(port.read().state, ArmState::enabled);
  EXPECT_FALSE(arm.brakes);
}

}  // namespace arm_port_test
}  // namespace repel
