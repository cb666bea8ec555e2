// SPDX-License-Identifier: BSD-3-Clause
/// Penetration of the tool into a wall when a fault occurs while it moves towards it: not more than
/// without the fault, at several speeds and frictions, with and without brakes.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "loop/faulty_slider.hpp"

namespace repel {
namespace arm_command_test {

using test::Fault;
using test::FaultRun;

constexpr Fault every_fault[] = {
    Fault::silent_operator, Fault::bad_command,     Fault::not_a_number,   Fault::frame_of_zeros,
    Fault::frozen_frame,    Fault::frozen_position, Fault::frozen_encoder, Fault::jump,
    Fault::huge_position,   Fault::huge_rate,       Fault::bad_pose,       Fault::bad_gravity};

constexpr double speeds[] = {0.05, 0.1, 0.25};         // [m/s]
constexpr double frictions[] = {20.0, 5.0, 1.0, 0.1};  // [N s/m]

/// Faults during which the position of the arm is unknown.
bool lasts_and_blinds(Fault fault) {
  return fault == Fault::not_a_number || fault == Fault::frozen_frame ||
         fault == Fault::frozen_position || fault == Fault::frozen_encoder;
}

template <class Arm>
void expect_no_deeper(const char* arm) {
  int pressed = 0;
  for (const double speed : speeds) {
    for (const double friction : frictions) {
      const FaultRun without = test::run_into_wall<Arm>(Fault::none, speed, friction);
      ASSERT_EQ(without.stop, Stop::running);
      pressed += without.deepest > -0.02 ? 1 : 0;
      for (const Fault fault : every_fault) {
        SCOPED_TRACE(std::string(arm) + ", " + test::name_of(fault) + ", " + std::to_string(speed) +
                     " m/s, " + std::to_string(friction) + " N s/m");
        const FaultRun run = test::run_into_wall<Arm>(fault, speed, friction);
        EXPECT_LE(run.deepest, std::max(without.deepest, 0.0) + 1e-9);
        EXPECT_GE(run.noticed, 0);
        EXPECT_LE(run.noticed, fault == Fault::silent_operator ? 8 : 2);
        EXPECT_LE(run.speed_at_end, 0.1 * speed);
        EXPECT_LE(run.largest_force, 1000.0);
        EXPECT_EQ(run.brakes, lasts_and_blinds(fault) || fault == Fault::bad_pose);
      }
    }
  }
  EXPECT_EQ(pressed, std::size(speeds) * std::size(frictions));  // each run reaches the wall
}

TEST(Fault, NothingGoesDeeperIntoAWallThanItWouldWithoutTheFault) {
  expect_no_deeper<test::FaultySlider>("without brakes");
}

TEST(Fault, NorDoesAnArmWithBrakes) {
  expect_no_deeper<test::BrakedSlider>("with brakes");
}

TEST(Fault, WhatIsLostForATickComesBackByItself) {
  for (const Fault fault : {Fault::frame_of_zeros, Fault::jump, Fault::huge_position,
                            Fault::huge_rate, Fault::bad_gravity}) {
    SCOPED_TRACE(test::name_of(fault));
    const FaultRun run = test::run_into_wall<test::FaultySlider>(fault, 0.1, 5.0);
    EXPECT_EQ(run.last.stop, Stop::running);
    EXPECT_EQ(run.last.gain, 1.0);
    EXPECT_TRUE(std::isfinite(run.last.coupling.force.norm()));
    for (const float energy : run.last.energy) EXPECT_TRUE(std::isfinite(energy));
  }
}

TEST(Fault, AFrozenEncoderAtRestIsNoticedAsSoonAsTheJointMustMove) {
  const FaultRun run = test::run_from_rest(Fault::frozen_encoder, 0.1, 1.0);
  EXPECT_NE(run.stop, Stop::running);
  EXPECT_LT(run.deepest, 0.0);
  EXPECT_LT(run.way, 0.02);  // [m] moved while the position was unknown
}

TEST(Fault, AReleasedArmWithoutBrakesStillCarriesItsWeightAndOneWithBrakesNeedNot) {
  const FaultRun bare =
      test::run_into_wall<test::FaultySlider>(Fault::not_a_number, 0.1, 20.0, 30.0);
  EXPECT_EQ(bare.last.stop, Stop::released);
  EXPECT_NEAR(bare.last.torques[2], 30.0, 1e-9);
  const FaultRun braked =
      test::run_into_wall<test::BrakedSlider>(Fault::not_a_number, 0.1, 20.0, 30.0);
  EXPECT_EQ(braked.last.stop, Stop::released);
  EXPECT_EQ(braked.last.torques[2], 0.0);
}

TEST(Fault, AnArmThatNeverReportedANumberGetsNoTorque) {
  const FaultRun run = test::run_from_rest(Fault::never_a_number, 0.1, 20.0);
  EXPECT_EQ(run.stop, Stop::released);
  EXPECT_TRUE(run.brakes);
  EXPECT_EQ(run.largest_force, 0.0);
}

TEST(Fault, AnArmThatStoppedByItselfIsSaidAndEnabledAgain) {
  const FaultRun run = test::run_into_wall<test::BrakedSlider>(Fault::arm_stops, 0.1, 20.0);
  EXPECT_NE(run.status & status::arm_stopped, 0U);
  EXPECT_EQ(run.stop, Stop::holding);
  EXPECT_EQ(run.last.stop, Stop::running);
  EXPECT_EQ(run.last.gain, 1.0);
}

TEST(Fault, ALoopThatStoodStillLetsTheOperatorGoAndHeComesBack) {
  const FaultRun run = test::run_into_wall<test::FaultySlider>(Fault::late_loop, 0.1, 20.0);
  EXPECT_NE(run.status & status::clock_gap, 0U);
  EXPECT_EQ(run.stop, Stop::holding);
  EXPECT_EQ(run.missing, 599);
  EXPECT_EQ(run.last.stop, Stop::running);
  EXPECT_EQ(run.last.gain, 1.0);
}

TEST(Fault, AFastLeverDoesNotDriveTheToolFasterThanItMayBe) {
  for (const double rate : {5.0, 20.0, 100.0, 1e308}) {
    SCOPED_TRACE(rate);
    const FaultRun run = test::run_with_lever(rate, 1.0);
    EXPECT_LE(run.top_speed, 1.3 * 0.25);
    EXPECT_LE(run.deepest, 0.0);
    EXPECT_EQ(run.stop, Stop::running);
  }
}

TEST(Fault, TorquesOfJointsWithoutAKnownLimitAreBounded) {
  const FaultRun run =
      test::run_into_wall<test::FaultySlider>(Fault::frame_of_zeros, 0.1, 20.0, 0.0, 0.0);
  EXPECT_LE(run.largest_force, 1000.0);
  const FaultRun infinite = test::run_into_wall<test::FaultySlider>(
      Fault::none, 0.1, 20.0, 0.0, std::numeric_limits<double>::infinity());
  EXPECT_GT(infinite.deepest, -0.02);  // it moves
  EXPECT_LE(infinite.largest_force, 1000.0);
}

TEST(Fault, TorquesChangeNoFasterThanStated) {
  for (const Fault fault :
       {Fault::none, Fault::bad_command, Fault::not_a_number, Fault::frame_of_zeros}) {
    SCOPED_TRACE(test::name_of(fault));
    const FaultRun run = test::run_into_wall<test::FaultySlider>(fault, 0.25, 1.0, 0.0, 60.0);
    EXPECT_LE(run.largest_change, 0.5 * 60.0 + 1e-9);  // per tick, half the slew time
  }
}

}  // namespace arm_command_test
}  // namespace repel
