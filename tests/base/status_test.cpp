// SPDX-License-Identifier: BSD-3-Clause
#include <repel/base/status.hpp>

#include <gtest/gtest.h>

#include <bit>
#include <set>
#include <string>

namespace repel {
namespace status_test {

constexpr Status every_bit[] = {
    status::bad_pose,      status::bad_command,   status::bad_joints,         status::clock_fault,
    status::stale_pairs,   status::late_result,   status::torque_limit,       status::crowded_pairs,
    status::expired_pairs, status::silent_device, status::saturated,          status::joint_limit,
    status::network_fault, status::speed_limit,   status::implausible_joints, status::frozen_joints,
    status::clock_gap,     status::bad_torque,    status::torque_rate,        status::tool_speed,
    status::arm_stopped,   status::pushed_out,    status::energy_gain,        status::bad_wrench,
    status::hold_lost,     status::silent_site};

TEST(Status, ACleanTickReadsOk) {
  EXPECT_EQ(to_text(Status{0}), "ok");
}

TEST(Status, EveryBitIsOneBitWithANameOfItsOwn) {
  std::set<std::string> names;
  Status all = 0;
  for (const Status bit : every_bit) {
    EXPECT_EQ(std::popcount(bit), 1);
    EXPECT_EQ(all & bit, 0U);
    all |= bit;
    EXPECT_NE(to_text(bit), "ok");
    names.insert(to_text(bit));
  }
  EXPECT_EQ(names.size(), std::size(every_bit));
}

TEST(Status, TheNamesAreThoseOfTheBits) {
  EXPECT_EQ(to_text(status::bad_pose), "bad_pose");
  EXPECT_EQ(to_text(status::clock_fault), "clock_fault");
  EXPECT_EQ(to_text(status::torque_limit), "torque_limit");
  EXPECT_EQ(to_text(status::network_fault), "network_fault");
}

TEST(Status, SeveralBitsAreListedCommaByComma) {
  EXPECT_EQ(to_text(status::bad_pose | status::stale_pairs | status::late_result),
            "bad_pose, stale_pairs, late_result");
}

TEST(Status, FailsafeIsEveryFaultThatLeavesSomethingUnknownAndNothingElse) {
  EXPECT_EQ(status::failsafe, status::bad_pose | status::bad_command | status::bad_joints |
                                  status::clock_fault | status::expired_pairs |
                                  status::silent_device | status::network_fault |
                                  status::implausible_joints | status::frozen_joints |
                                  status::clock_gap | status::bad_torque | status::arm_stopped |
                                  status::pushed_out | status::energy_gain);
}

TEST(Status, BlindIsWhatJointsCanHideAndAlwaysAFault) {
  EXPECT_EQ(status::blind, status::bad_joints | status::implausible_joints | status::frozen_joints);
  EXPECT_EQ(status::blind & status::failsafe, status::blind);
}

TEST(Status, EachStopHasAName) {
  EXPECT_EQ(to_text(Stop::running), "running");
  EXPECT_EQ(to_text(Stop::holding), "holding");
  EXPECT_EQ(to_text(Stop::braking), "braking");
  EXPECT_EQ(to_text(Stop::released), "released");
}

}  // namespace status_test
}  // namespace repel
