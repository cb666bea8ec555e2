// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/tick.hpp>

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <thread>

#include <repel/network/plan.hpp>

#include "loop/slider.hpp"

namespace repel {
namespace tick_test {

using namespace std::chrono_literals;
using test::SliderCell;

bool is_finite_record(const TickRecord& record) {
  return is_finite(record.p_WT) && is_finite(record.v_WT) && is_finite(record.virtual_force) &&
         is_finite(record.coupling) && std::isfinite(record.gain) &&
         std::isfinite(record.lever_torque);
}

/// The fault bits; saturation of the coupling is not a fault while a wall holds the tool.
Status faults(const TickRecord& record) {
  return record.status & ~status::saturated;
}

/// [N] NaN if one of the forces is NaN.
double largest_force(const SliderCell& cell) {
  const auto& f = cell.arm.force;
  const double sum = f[0] + f[1] + f[2];
  return std::max({std::abs(f[0]), std::abs(f[1]), std::abs(f[2])}) + (sum - sum);
}

TEST(Tick, MovesTheToolAsTheOperatorAsks) {
  SliderCell cell(test::push(10.0, 0.05));
  for (int tick = 0; tick < 400; ++tick) (void)cell.tick();
  EXPECT_GT(cell.arm.q[0], 0.02);
  EXPECT_NEAR(cell.arm.q[1], 0.0, 1e-12);
  EXPECT_NEAR(cell.arm.v[0], 0.048, 0.002);  // the rate minus the dead band
}

TEST(Tick, WallHoldsTheToolAndTheForcesBalance) {
  SliderCell cell(test::push(20.0, 0.1));
  TickRecord record;
  for (int tick = 0; tick < 8000; ++tick) {
    record = cell.tick();
    ASSERT_EQ(faults(record), 0U) << to_text(record.status);
    ASSERT_EQ(record.gain, 1.0);
  }
  // The coupling exerts its 60 N and 120 N s/m at 0.098 m/s: less than the wall at its surface.
  EXPECT_LT(cell.arm.q[0], 0.15);
  EXPECT_GT(cell.arm.q[0], 0.13);
  EXPECT_LT(record.virtual_force.force.x(), -30.0);
  EXPECT_NEAR(record.virtual_force.force.x() + record.coupling.force.x(), 0.0, 1.0);
  EXPECT_NEAR(record.v_WT.norm(), 0.0, 1e-3);
}

TEST(Tick, RecordSaysWhichTickItIs) {
  SliderCell cell(test::push(0.5, 0.1));
  for (int tick = 0; tick < 300; ++tick) {
    const auto q = cell.arm.q;
    const TickRecord& record = cell.tick();
    ASSERT_EQ(record.tick, tick);
    ASSERT_TRUE(std::equal(q.begin(), q.end(), record.q.begin()));
    ASSERT_NEAR(record.time, 0.0025 * tick, 1e-12);
    ASSERT_EQ(record.phase, tick < 200 ? 0 : 1);
    ASSERT_EQ(record.pairs.nearest_pair.valid(), record.pairs.evaluated > 0);
    ASSERT_EQ(record.pairs.hardest_pair.valid(), record.pairs.peak_force > 0.0);
  }
}

/// Presses on the wall, corrupts one input for 40 ticks, and follows the operator's force through
/// fall, hold and rise. Meanwhile the tool must not go deeper, for any corrupted input.
void expect_stop(const char* name, Status bit, Stop stop,
                 const std::function<void(SliderCell&, bool)>& spoil,
                 std::chrono::nanoseconds elapsed = SliderCell::period) {
  SCOPED_TRACE(name);
  SliderCell cell(test::push(60.0, 0.1));
  for (int tick = 0; tick < 1600; ++tick) ASSERT_EQ(faults(cell.tick()), 0U);
  ASSERT_GT(cell.tick_alone().virtual_force.force.norm(), 30.0);
  const double deepest = cell.arm.q[0];

  spoil(cell, true);
  TickRecord record;
  record.gain = 1.0;
  for (int tick = 0; tick < 40; ++tick) {
    const double gain = record.gain;
    record = cell.tick(elapsed);
    ASSERT_EQ(record.status & bit, bit) << "tick " << tick << ": " << to_text(record.status);
    ASSERT_EQ(record.stop, stop) << "tick " << tick << ": " << to_text(record.stop);
    ASSERT_TRUE(is_finite_record(record));
    ASSERT_LE(record.gain, gain);
    ASSERT_LE(largest_force(cell), 200.0);  // more than walls and coupling can exert here
    ASSERT_LE(cell.arm.q[0], deepest + 1e-4);
    // If the joints are not known, brakes are requested after 20 ms.
    ASSERT_EQ(record.brakes, stop != Stop::holding && tick >= 8) << "tick " << tick;
  }
  EXPECT_EQ(record.gain, 0.0);

  spoil(cell, false);
  if (elapsed < 0ns) cell.now += 10s;  // beyond the last valid time
  int held = 0;
  for (; held < 400 && cell.tick().gain == 0.0; ++held) ASSERT_LE(cell.arm.q[0], deepest + 1e-4);
  EXPECT_NEAR(held * 0.0025, 0.25, 0.02);
  double last = 0.0;
  for (int tick = 0; tick < 300; ++tick) {
    record = cell.tick();
    ASSERT_EQ(faults(record), 0U) << to_text(record.status);
    ASSERT_EQ(record.stop, Stop::running);
    ASSERT_FALSE(record.brakes);
    ASSERT_GE(record.gain, last);
    last = record.gain;
  }
  EXPECT_EQ(last, 1.0);
  for (int tick = 0; tick < 2000; ++tick) (void)cell.tick();
  EXPECT_GT(cell.tick().virtual_force.force.norm(), 30.0);  // the operator presses again
}

TEST(Tick, JointsThatAreNotNumbersBrakeTheArmAndItComesBack) {
  expect_stop("joints", status::bad_joints, Stop::braking,
              [](SliderCell& cell, bool spoilt) { cell.arm.spoilt = spoilt; });
}

TEST(Tick, PoseThatIsNotANumberBrakesTheArmAndItComesBack) {
  expect_stop("pose", status::bad_pose, Stop::braking,
              [](SliderCell& cell, bool spoilt) { cell.kinematics->spoilt = spoilt; });
}

TEST(Tick, ClockThatStandsStillLetsTheOperatorGoAndHeComesBack) {
  expect_stop(
      "clock", status::clock_fault, Stop::holding, [](SliderCell&, bool) {}, 0ns);
}

TEST(Tick, ClockThatRunsBackLetsTheOperatorGoAndHeComesBack) {
  expect_stop(
      "clock", status::clock_fault, Stop::holding, [](SliderCell&, bool) {}, -1ms);
}

// Compared with the patience alone, an age that is not a number was never too old.
TEST(Tick, SampleOfAnAgeThatIsNoneLetsTheOperatorGo) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  for (const double age : {std::nan(""), -inf, -1.0, -1e-300, 0.021, inf, 0.0, 0.02}) {
    SliderCell cell({});
    network::Command command;
    command.hand.ball.linear.x() = 0.1;
    command.silent_for = age;
    const bool is_fresh = age >= 0.0 && age <= 0.02;
    TickRecord record;
    for (int tick = 0; tick < 100; ++tick) {
      cell.now += SliderCell::period;
      record = cell.cell.step(cell.port.read(), command, cell.now);
      cell.port.apply(record);
      cell.arm.step(0.0025);
      ASSERT_EQ((record.status & status::silent_device) == 0U, is_fresh) << "age " << age;
    }
    EXPECT_EQ(record.gain, is_fresh ? 1.0 : 0.0) << "age " << age;
    EXPECT_EQ(cell.arm.q[0] > 0.01, is_fresh) << "age " << age;
  }
}

TEST(Tick, CommandThatIsNotANumberLetsTheOperatorGoAndTheWallStays) {
  network::Script script = test::push(4.0, 0.1);
  network::Phase fault = script.front();
  fault.duration = 0.1;
  fault.rates.linear.y() = std::nan("");
  script.push_back(fault);
  script.push_back(test::push(10.0, 0.1).front());
  SliderCell cell(script);
  for (int tick = 0; tick < 1600; ++tick) ASSERT_EQ(faults(cell.tick()), 0U);
  const double deepest = cell.arm.q[0];
  double gain = 1.0;
  for (int tick = 0; tick < 40; ++tick) {
    const TickRecord& record = cell.tick();
    ASSERT_EQ(faults(record), status::bad_command) << "tick " << tick;
    ASSERT_EQ(record.stop, Stop::holding);
    ASSERT_TRUE(is_finite_record(record));
    ASSERT_LE(record.gain, gain);
    gain = record.gain;
    ASSERT_LE(cell.arm.q[0], deepest);
  }
  EXPECT_EQ(gain, 0.0);
  EXPECT_LT(cell.arm.q[0], deepest - 1e-3);  // meanwhile the wall pushes the tool out
  for (int tick = 0; tick < 2000; ++tick) {
    const TickRecord& record = cell.tick();
    ASSERT_EQ(faults(record), 0U);
    gain = record.gain;
  }
  EXPECT_EQ(gain, 1.0);
  EXPECT_GT(cell.tick().virtual_force.force.norm(), 30.0);
}

TEST(Tick, CouplingWindsNothingUpDuringAFault) {
  SliderCell cell(test::push(60.0, 0.2));
  for (int tick = 0; tick < 10; ++tick) (void)cell.tick();
  cell.arm.spoilt = true;
  for (int tick = 0; tick < 4000; ++tick) (void)cell.tick();
  cell.arm.spoilt = false;
  double largest = 0.0;
  for (int tick = 0; tick < 101; ++tick)
    largest = std::max(largest, cell.tick().coupling.force.norm());
  // One period of motion and the damper: far below the limit of the spring.
  EXPECT_LT(largest, 30.0);
}

TEST(Tick, JointsGetNoMoreThanTheyCanGive) {
  SliderCell cell(test::push(20.0, 0.2), {.effort_limit = 8.0});
  int limited = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    const TickRecord& record = cell.tick();
    ASSERT_LE(largest_force(cell), 8.0);
    const bool cut = (record.status & status::torque_limit) != 0U;
    ASSERT_EQ(record.gain, 1.0);
    if (cut) {
      EXPECT_EQ(largest_force(cell), 8.0);
    }
    limited += cut ? 1 : 0;
  }
  EXPECT_GT(limited, 10);
  EXPECT_LT(limited, 2000);
}

TEST(Tick, SmallestBudgetIsReportedAndStaysOnTheSafeSide) {
  CoprocessorOptions options;
  options.budget.work_units = 1;
  SliderCell cell(test::push(20.0, 0.05), {.coprocessor = options, .walls = 40});
  bool stale = false;
  int near_for = 0;  // ticks in which every wall has been near
  for (int tick = 0; tick < 3000; ++tick) {
    const TickRecord& record = cell.tick();
    ASSERT_TRUE(is_finite_record(record));
    ASSERT_EQ((record.status & status::stale_pairs) != 0U, record.pairs.stale > 0);
    near_for = record.pairs.near == 40 ? near_for + 1 : 0;
    if (near_for > 40) {
      ASSERT_LE(record.pairs.oldest_age, 40);
    }
    stale = stale || record.pairs.stale > 0;
    ASSERT_LT(cell.arm.q[0], 0.15);
  }
  EXPECT_TRUE(stale);
}

TEST(Tick, SameBitsWithAnyNumberOfThreads) {
  const auto run = [](int threads) {
    CoprocessorOptions options;
    options.threads = threads;
    options.lock_step = true;
    SliderCell cell(test::push(20.0, 0.1), {.coprocessor = options, .walls = 200});
    std::vector<double> trace;
    for (int tick = 0; tick < 700; ++tick) {
      const TickRecord& record = cell.tick();
      for (int axis = 0; axis < 3; ++axis) {
        trace.push_back(record.p_WT[axis]);
        trace.push_back(record.virtual_force.force[axis]);
        trace.push_back(record.virtual_force.torque[axis]);
      }
    }
    return trace;
  };
  const auto alone = run(0);
  EXPECT_EQ(run(1), alone);
  EXPECT_EQ(run(2), alone);
}

std::atomic<bool> held{false};

// A thread that never answers is stood in for as soon as its last answer is too old.
TEST(Tick, LateCoprocessorIsSaid) {
  held = true;
  CoprocessorOptions options;
  options.threads = 1;
  options.mode = CoprocessorMode::beside;
  options.on_thread_start = [](int) noexcept {
    while (held) std::this_thread::sleep_for(1ms);
  };
  {
    SliderCell cell(test::push(60.0, 0.2), {.coprocessor = options, .walls = 400});
    for (int tick = 0; tick < 100; ++tick) {
      const TickRecord& record = cell.tick();
      const bool late = tick >= Coprocessor::greatest_age;
      ASSERT_EQ((record.status & status::late_result) != 0U, late) << "tick " << tick;
      ASSERT_TRUE(is_finite_record(record));
      ASSERT_EQ(record.gain, 1.0);
    }
    held = false;
  }
}

TEST(Readings, MissingEntriesAreNotNumbers) {
  std::vector<double> to(3, 7.0);
  detail::copy_readings(std::array{1.0, 2.0}, to);
  EXPECT_EQ(to[0], 1.0);
  EXPECT_EQ(to[1], 2.0);
  EXPECT_TRUE(std::isnan(to[2]));
}

TEST(Readings, AWrenchThatIsMissingOrNotFiniteIsNoMeasurement) {
  const network::ForceSensor sensor;
  network::Signals signals;
  signals.inertia.setIdentity(2, 2);
  detail::pass_wrench(Wrench{{1, 2, 3}, {4, 5, 6}}, sensor, signals);
  EXPECT_TRUE(signals.is_measured);
  EXPECT_EQ(signals.measured.torque, Vec3(4, 5, 6));
  detail::pass_wrench({}, sensor, signals);
  EXPECT_FALSE(signals.is_measured);
  EXPECT_EQ(signals.measured.torque, Vec3::Zero());
  detail::pass_wrench(Wrench{{1, std::nan(""), 3}, {4, 5, 6}}, sensor, signals);
  EXPECT_FALSE(signals.is_measured);
  EXPECT_TRUE(is_finite(signals.measured));
  EXPECT_EQ(signals.inertia(0, 0), 1.0) << "the sensor does not act yet";
}

TEST(Readings, TheNetworkMovesALighterArm) {
  network::ForceSensor sensor({.gain = 0.6});
  sensor.fit(network::Space::joints, 1);
  sensor.prepare(0.01);
  network::Signals signals = network::detail::neutral_signals(1, 0.01);
  signals.is_measured = true;
  for (int tick = 0; tick < 100; ++tick) sensor.read(signals);
  signals.inertia.setConstant(1, 1, 8.0);
  detail::pass_wrench(Wrench{}, sensor, signals);
  EXPECT_NEAR(signals.inertia(0, 0), 5.0, 1e-12);
}

}  // namespace tick_test
}  // namespace repel
