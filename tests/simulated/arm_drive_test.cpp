// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/arm_drive.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <repel/base/setup_error.hpp>

namespace repel {
namespace arm_drive_test {

constexpr double inf = std::numeric_limits<double>::infinity();

TEST(ArmDrive, BeginsEnabledAndItsBrakesGoOnAndOff) {
  ArmDrive drive;
  EXPECT_EQ(drive.state(), ArmState::enabled);
  EXPECT_FALSE(drive.braked());
  drive.engage_brakes(true);
  EXPECT_EQ(drive.state(), ArmState::enabled);
  EXPECT_TRUE(drive.braked());
  drive.engage_brakes(false);
  EXPECT_FALSE(drive.braked());
}

TEST(ArmDrive, AStopLastsUntilItIsEnabledWhateverElseIsAsked) {
  ArmDrive drive;
  drive.stop();
  drive.heard();
  drive.engage_brakes(false);
  EXPECT_FALSE(drive.advance(1.0));
  EXPECT_EQ(drive.state(), ArmState::stopped);
  EXPECT_TRUE(drive.braked());
  drive.enable();
  EXPECT_EQ(drive.state(), ArmState::enabled);
  EXPECT_FALSE(drive.braked());
}

TEST(ArmDrive, BrakesThatWereOnBeforeAStopAreOffAfterIt) {
  ArmDrive drive;
  drive.engage_brakes(true);
  drive.stop();
  drive.enable();
  EXPECT_FALSE(drive.braked());
}

TEST(ArmDrive, ItsWatchdogCountsTheTimeOfTheArmHoweverItIsCut) {
  for (const int parts : {1, 3, 7, 400}) {
    ArmDrive drive(0.1);
    for (int tick = 0; tick < 100; ++tick) {
      drive.heard();
      for (int i = 0; i < parts; ++i) ASSERT_FALSE(drive.advance(0.1 / parts)) << parts;
    }
    EXPECT_EQ(drive.state(), ArmState::enabled);
    EXPECT_TRUE(drive.advance(1e-6));
    EXPECT_EQ(drive.state(), ArmState::stopped);
    drive.heard();
    EXPECT_FALSE(drive.advance(0.01)) << "what is sent while it stands is new";
    EXPECT_EQ(drive.state(), ArmState::stopped);
    drive.enable();
    EXPECT_FALSE(drive.advance(0.1));
    EXPECT_TRUE(drive.advance(1e-6)) << "it begins anew when the arm is enabled";
  }
}

TEST(ArmDrive, WithoutAWatchdogTorquesLastForEver) {
  for (ArmDrive drive : {ArmDrive(), ArmDrive(0.0), ArmDrive(inf)}) {
    EXPECT_FALSE(drive.advance(1e300));
    EXPECT_EQ(drive.state(), ArmState::enabled);
  }
  EXPECT_THROW(ArmDrive(-1.0), SetupError);
  EXPECT_THROW(ArmDrive(std::nan("")), SetupError);
}

}  // namespace arm_drive_test
}  // namespace repel
