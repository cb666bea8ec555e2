// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/record.hpp>

#include <gtest/gtest.h>

#include <repel/network/elements/one_ports.hpp>
#include <repel/network/modules/torque_arm.hpp>
#include <repel/network/plan.hpp>

namespace repel {
namespace record_test {

TickRecord record_with(std::int64_t tick, Status status, double force, double nearest) {
  TickRecord record;
  record.tick = tick;
  record.status = status;
  record.virtual_force.force = Vec3(0.0, force, 0.0);
  record.pairs.nearest = nearest;
  record.pairs.nearest_pair = {static_cast<std::int32_t>(tick)};
  record.pairs.near = 3;
  record.pairs.evaluated = 2;
  record.pairs.stale = static_cast<int>(tick);
  record.pairs.oldest_age = 2 * tick;
  record.pairs.iterations = 10;
  record.workers = {.stood_in = 1, .silence = tick, .ticks = tick, .longest_silence = tick};
  return record;
}

TEST(Recorder, KeepsWhatItHasRoomForAndCountsTheRest) {
  Recorder recorder(10);
  const std::size_t room = recorder.records().capacity();
  const TickRecord* const memory = recorder.records().data();
  for (int tick = 0; tick < 25; ++tick) recorder.add(record_with(tick, 0, 0.0, 1.0));
  EXPECT_EQ(recorder.records().size(), room);
  EXPECT_EQ(recorder.dropped(), 25 - static_cast<std::int64_t>(room));
  EXPECT_EQ(recorder.records().data(), memory);   // it has not grown
  EXPECT_EQ(recorder.records().front().tick, 0);  // the first records are kept
}

TEST(Recorder, WithoutRoomItOnlyCounts) {
  Recorder recorder(0);
  recorder.add({});
  EXPECT_TRUE(recorder.records().empty());
  EXPECT_EQ(recorder.dropped(), 1);
}

TEST(TickRecord, NotesWhatTheMasterDoesToTheHand) {
  constexpr double period = 0.0025;
  network::Network with_handle =
      network::Plan()
          .add("six_axes", network::SixAxes())
          .add("friction", network::Damper<network::any_size>(
                               5.0 * network::Mat<network::any_size>::Identity(6, 6)))
          .build(period);
  network::Signals signals = network::detail::neutral_signals(0, period);
  signals.hand.ball.linear.y() = 0.1;
  ASSERT_TRUE(with_handle.run(signals));
  TickRecord record;
  record.lever_torque = 1.0;
  note_masters(with_handle, record);
  EXPECT_EQ(record.grip.force.y(), with_handle.find<network::SixAxes>()->grip()(1));
  EXPECT_LT(record.grip.force.y(), -0.1) << "it resists";
  EXPECT_EQ(record.grip.force.x(), 0.0);
  EXPECT_EQ(record.lever_torque, 0.0) << "there is no lever";
}

TEST(TickRecord, TheLeverIsThatOfTheFirstHand) {
  constexpr double period = 0.0025;
  const auto damper = [] {
    return network::Damper<network::any_size>(5.0 *
                                              network::Mat<network::any_size>::Identity(1, 1));
  };
  network::Network levers = network::Plan()
                                .add("second", network::TorqueArm({.hand = network::Hand::second}))
                                .add("slow", damper())
                                .build(period);
  network::Signals signals = network::detail::neutral_signals(0, period);
  signals.second.lever_rate = 1.0;
  ASSERT_TRUE(levers.run(signals));
  TickRecord record;
  record.lever_torque = 1.0;
  note_masters(levers, record);
  EXPECT_EQ(record.lever_torque, 0.0);
  EXPECT_NE(levers.find<network::TorqueArm>()->felt(), 0.0);
}

TEST(RunTotals, AddUpAndKeepTheExtremes) {
  RunTotals totals;
  totals.add(record_with(1, status::stale_pairs, 5.0, 0.3));
  totals.add(record_with(2, status::stale_pairs | status::bad_pose, 9.0, -0.1));
  TickRecord held = record_with(3, 0, 2.0, 0.2);
  held.hold.margin = -1e-3;
  held.hold.left_out = 2;
  totals.add(held);
  EXPECT_EQ(totals.ticks, 3);
  EXPECT_EQ(totals.hold_margin, -1e-3);
  EXPECT_EQ(totals.gaps_left_out, 2);
  EXPECT_EQ(totals.near, 9);
  EXPECT_EQ(totals.evaluated, 6);
  EXPECT_EQ(totals.iterations, 30);
  EXPECT_EQ(totals.stale, 6);
  EXPECT_EQ(totals.most_stale, 3);
  EXPECT_EQ(totals.oldest_age, 6);
  EXPECT_EQ(totals.nearest, -0.1);
  EXPECT_EQ(totals.nearest_pair, PairId{2});
  EXPECT_EQ(totals.peak_force, 9.0);
  EXPECT_EQ(totals.status_ticks[0], 1);  // bad_pose
  EXPECT_EQ(totals.status_ticks[4], 2);  // stale_pairs
  EXPECT_EQ(totals.status_ticks[1], 0);
  EXPECT_EQ(totals.unsound, 1);
  EXPECT_EQ(totals.workers.ticks, 3);  // already counted since set-up
}

TEST(RunTotals, NeitherASilentOperatorNorOneWhoStartsInAWallIsUnsound) {
  RunTotals totals;
  totals.add(record_with(1, status::silent_device, 0.0, 1.0));
  totals.add(record_with(2, status::pushed_out | status::torque_limit, 0.0, 1.0));
  EXPECT_EQ(totals.unsound, 0);
  totals.add(record_with(3, status::silent_device | status::network_fault, 0.0, 1.0));
  EXPECT_EQ(totals.unsound, 1);
}

}  // namespace record_test
}  // namespace repel
