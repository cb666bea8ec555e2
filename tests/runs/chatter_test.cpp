// SPDX-License-Identifier: BSD-3-Clause
// Chatter that is measured tick by tick, against the same from all samples at once.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <thread>

#include <repel/host/heap_guard.hpp>
#include <repel/runs/engine/run.hpp>
#include <repel/runs/report/chatter_report.hpp>
#include <repel/runs/watch/chatter.hpp>

#include "telepresence/spectrum.hpp"

namespace repel::runs {
namespace chatter_test {

constexpr unsigned seed = 61;

double streamed(const std::vector<double>& signal, double rate_hz) {
  ChatterMeter meter(1, rate_hz);
  for (const double sample : signal) meter.add({&sample, 1});
  return meter.of(0).rms;
}

double offline(const std::vector<double>& signal, double rate_hz) {
  return telepresence::rms_above(signal, rate_hz, chatter_above_hz);
}

/// A sine over slower and larger motion, for `seconds`.
std::vector<double> sine(double hz, double rate_hz, double seconds) {
  std::vector<double> signal;
  for (double k = 0.0; k < seconds * rate_hz; ++k) {
    const double turn = 2.0 * std::numbers::pi * k / rate_hz;
    signal.push_back(20.0 + 5.0 * std::sin(1.3 * turn) + 0.3 * std::sin(hz * turn));
  }
  return signal;
}

TEST(Chatter, OfASineIsThatOfTheOfflineForm) {
  for (const double rate_hz : {100.0, 400.0, 1000.0, 4000.0, 20000.0}) {
    for (const double hz : {45.0, 47.7, 100.3, 180.0, 450.0}) {
      if (hz >= 0.49 * rate_hz) continue;
      const std::vector<double> signal = sine(hz, rate_hz, 10.0);
      const double expected = offline(signal, rate_hz);
      EXPECT_NEAR(expected, 0.3 * M_SQRT1_2, 0.003) << rate_hz << " Hz";
      EXPECT_NEAR(streamed(signal, rate_hz), expected, 0.03 * expected)
          << hz << " Hz at " << rate_hz << " Hz";
    }
  }
}

// As the documentation of ChatterMeter has it.
TEST(Chatter, OfASlowSineIsWhatTheFilterPasses) {
  constexpr double amplitude = 0.3;
  for (const auto& [hz, passed] :
       {std::pair(30.0, 0.71), std::pair(20.0, 0.19), std::pair(10.0, 0.01)}) {
    const double expected = passed * amplitude * M_SQRT1_2;
    EXPECT_NEAR(streamed(sine(hz, 1000.0, 20.0), 1000.0), expected, 0.006 * amplitude) << hz;
  }
}

TEST(Chatter, OfNoiseIsThatOfTheOfflineForm) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  for (const double rate_hz : {100.0, 400.0, 1000.0, 4000.0}) {
    for (const double memory : {0.0, 0.5, 0.9}) {  // of a first-order filter: white to slow
      std::vector<double> signal{0.0};
      for (double k = 1.0; k < 20.0 * rate_hz; ++k) {
        signal.push_back(memory * signal.back() + normal(random));
      }
      const double expected = offline(signal, rate_hz);
      EXPECT_NEAR(streamed(signal, rate_hz), expected, 0.03 * expected)
          << "seed " << seed << ", " << rate_hz << " Hz, memory " << memory;
    }
  }
}

// What is above 30 Hz shows at rates above 60 Hz only.
TEST(Chatter, AtALowRateTheRootMeanSquareIsNotKnown) {
  for (const double rate_hz : {10.0, 50.0, 60.0}) {
    ChatterMeter meter(1, rate_hz);
    for (const double sample : {0.0, 1.0, -2.0}) meter.add({&sample, 1});
    EXPECT_TRUE(std::isnan(meter.of(0).rms)) << rate_hz;
    EXPECT_EQ(meter.of(0).jump, 3.0) << rate_hz;
  }
  EXPECT_NEAR(streamed(sine(30.25, 61.0, 200.0), 61.0), 0.3 * M_SQRT1_2, 0.3 * 0.3);
  EXPECT_TRUE(std::isnan(streamed({}, 400.0))) << "without a sample";
}

TEST(Chatter, AGapIsNoJumpAndTheFilterBeginsAnew) {
  ChatterMeter meter(2, 400.0);
  const auto add = [&meter](double a, double b) { meter.add(std::array{a, b}); };
  add(100.0, -3.0);
  for (int k = 0; k < 100; ++k) add(100.0, -3.0);
  meter.gap();
  for (int k = 0; k < 100; ++k) add(-50.0, 7.0);
  EXPECT_EQ(meter.of(0).jump, 0.0);
  EXPECT_EQ(meter.of(0).rms, 0.0);
  add(-50.0, 7.5);
  add(-50.0, 7.0);
  EXPECT_EQ(meter.of(0).rms, 0.0);
  EXPECT_EQ(meter.of(1).jump, 0.5);
  EXPECT_GT(meter.of(1).rms, 0.01);
}

TEST(Chatter, WhatIsNoNumberIsLeftOut) {
  ChatterMeter meter(2, 400.0);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    meter.add(std::array{1.0, 2.0});
    meter.add(std::array{bad, 50.0});
    meter.add(std::array{3.0, 60.0});
    meter.add(std::array{3.0, 61.0});
    meter.gap();
  }
  EXPECT_EQ(meter.of(0).jump, 0.0);
  EXPECT_EQ(meter.of(0).rms, 0.0);
  EXPECT_EQ(meter.of(1).jump, 1.0);
  EXPECT_TRUE(std::isfinite(meter.of(1).rms));
}

TEST(Chatter, OfAnArmIsThatOfTheWorstAxisAndOfEveryJoint) {
  ArmChatterMeter meter(2, true, 400.0);
  TickRecord record;
  meter.add(record);
  record.virtual_force.force = {1.0, -4.0, 2.0};
  record.virtual_force.torque = {0.5, 0.0, -0.25};
  record.lever_torque = -0.75;
  record.torques[0] = 6.0;
  record.torques[1] = -7.0;
  record.torques[2] = 100.0;  // of no joint
  meter.add(record);
  const ArmChatter chatter = meter.result();
  EXPECT_EQ(chatter.wall_force.jump, 4.0);
  EXPECT_EQ(chatter.wall_torque.jump, 0.5);
  EXPECT_NEAR(chatter.wall_force.rms / chatter.wall_torque.rms, 8.0, 1e-12);
  ASSERT_EQ(chatter.joints.size(), 2U);
  EXPECT_EQ(chatter.joints[0].jump, 6.0);
  EXPECT_EQ(chatter.joints[1].jump, 7.0);
  ASSERT_TRUE(chatter.lever.has_value());
  EXPECT_EQ(chatter.lever->jump, 0.75);
  EXPECT_FALSE(ArmChatterMeter(2, false, 400.0).result().lever.has_value());
}

TEST(Chatter, ATickAfterMissedOnesIsNoJump) {
  ArmChatterMeter meter(1, false, 400.0);
  TickRecord record;
  meter.add(record);
  record.torques[0] = 5.0;
  record.elapsed = 4;
  meter.add(record);
  record.torques[0] = 5.5;
  record.elapsed = 1;
  meter.add(record);
  EXPECT_EQ(meter.result().joints[0].jump, 0.5);
}

TEST(Chatter, IsMeasuredWithoutTheHeap) {
  ArmChatterMeter meter(6, true, 400.0);
  const TickRecord record;
  const auto before = host::HeapGuard::allocations();
  {
    const host::HeapGuard heap;
    for (int k = 0; k < 100; ++k) meter.add(record);
    meter.gap();
  }
  EXPECT_EQ(host::HeapGuard::allocations(), before);
}

RunResult run_of(const std::string& name, double seconds, Controls* controls = nullptr) {
  RunOptions options;
  options.fast = true;
  options.keep_records = true;
  options.seconds = seconds;
  options.backend = "ideal";
  const scene::Scene scene = scene::load(REPEL_SOURCE "/scenes/" + name + ".yaml");
  const std::unique_ptr<PreparedRun> prepared = prepare(scene, options);
  const std::atomic<bool> stop{false};
  return run(*prepared, {.controls = controls}, stop, [](const Progress&) {});
}

TEST(Chatter, OfARunIsThatOfItsRecords) {
  for (const char* name : {"plates", "two_arms"}) {
    const RunResult result = run_of(name, 4.0);
    for (const ArmResult& arm : result.arms) {
      ArmChatterMeter meter(arm.joints.size(), arm.chatter.lever.has_value(), 400.0);
      for (const TickRecord& record : arm.records) meter.add(record);
      EXPECT_EQ(arm.chatter.wall_torque.rms, meter.result().wall_torque.rms);
      EXPECT_EQ(arm.chatter.wall_torque.jump, meter.result().wall_torque.jump);
      EXPECT_EQ(chatter_list(arm).size(), 3U + arm.joints.size()) << "with a lever";
    }
    EXPECT_GT(result.arms.front().chatter.wall_torque.jump, 0.0) << name;
  }
}

// Paused after every tick, no tick follows another one.
TEST(Chatter, ATickAfterAPauseIsNoJump) {
  Controls controls;
  controls.paused = true;
  const std::jthread someone([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (controls.steps == 0) controls.steps = 1;
    }
  });
  const RunResult paused = run_of("plates", 0.1, &controls);
  EXPECT_EQ(paused.totals().ticks, 40);
  EXPECT_EQ(paused.arms.front().chatter.joints.front().jump, 0.0);
  EXPECT_GT(run_of("plates", 0.1).arms.front().chatter.joints.front().jump, 0.0);
}

}  // namespace chatter_test
}  // namespace repel::runs
