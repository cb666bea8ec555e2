// SPDX-License-Identifier: BSD-3-Clause
// A replay is compared with its recording bit for bit.

#include <gtest/gtest.h>

#include <limits>

#include <repel/runs/records/replay.hpp>

namespace repel::runs {
namespace replay_test {

/// Compares one tick of one arm.
ReplayReport compared(const TickRecord& then, const TickRecord& now) {
  Recording recording;
  recording.arms = {{then}};
  recording.times.resize(1);
  const TickRecord* const records[] = {&now};
  ReplayReport report;
  compare(recording, 0, records, report);
  EXPECT_EQ(report.ticks, 1);
  return report;
}

TickRecord tick() {
  TickRecord record;
  record.tick = 7;
  record.virtual_force.force = Vec3(1.0, -2.0, 3.0);
  record.lever_torque = 0.5;
  record.gain = 1.0;
  return record;
}

TEST(Replay, EveryResultCountsToItsLastBit) {
  EXPECT_EQ(compared(tick(), tick()).same, 1);
  EXPECT_EQ(compared(tick(), tick()).first_difference, -1);
  const auto expect_different = [](void (*change)(TickRecord&)) {
    TickRecord other = tick();
    change(other);
    const ReplayReport report = compared(tick(), other);
    EXPECT_EQ(report.same, 0);
    EXPECT_EQ(report.first_difference, 7);
  };
  expect_different([](TickRecord& k) { k.virtual_force.force.x() += 1e-15; });
  expect_different([](TickRecord& k) { k.virtual_force.torque.z() = -0.0; });
  expect_different([](TickRecord& k) { k.coupling.force.y() = -0.0; });
  expect_different([](TickRecord& k) { k.lever_torque += 1e-16; });
  expect_different([](TickRecord& k) { k.gain -= 1e-16; });
  expect_different([](TickRecord& k) { k.torques[0] = -0.0; });
}

TEST(Replay, ZerosOfOtherSignDifferAndTheSameNaNDoesNot) {
  for (double TickRecord::*const value : {&TickRecord::lever_torque, &TickRecord::gain}) {
    TickRecord then = tick();
    TickRecord now = tick();
    then.*value = 0.0;
    now.*value = -0.0;
    EXPECT_EQ(compared(then, now).same, 0);
    then.*value = now.*value = -0.0;
    EXPECT_EQ(compared(then, now).same, 1);
    then.*value = now.*value = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(compared(then, now).same, 1);
  }
}

}  // namespace replay_test
}  // namespace repel::runs
