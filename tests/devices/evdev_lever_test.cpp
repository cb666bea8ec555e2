// SPDX-License-Identifier: BSD-3-Clause
// The lever with a fake evdev device: rates from angles, effect levels from torques, and no force
// when it is not allowed.
#include <repel/devices/evdev_lever.hpp>

#include <gtest/gtest.h>

#include <time.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <devices/fake_evdev.hpp>

namespace repel::devices {
namespace evdev_lever_test {

using std::chrono::milliseconds;

constexpr milliseconds now{0};

/// A wheel of 2 rad over 2000 counts with a motor of 2 N m.
class Lever : public ::testing::Test {
 protected:
  void open(const EvdevLeverOptions& changed = {}) {
    EvdevLeverOptions options = changed;
    options.full_range = 2.0;
    options.now = &FakeClock::now;
    lever_.emplace(std::make_unique<FakePort>(wheel_), "Lever on a test", options);
  }
  void expect_refused(const std::string& says, const EvdevLeverOptions& options = {}) {
    try {
      open(options);
      FAIL() << "accepted: " << says;
    } catch (const SetupError& error) {
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  }
  /// Turns at 2 rad/s for 0.2 s.
  Measured turned() {
    for (int i = 1; i <= 100; ++i) {
      FakeClock::pass(0.002);
      wheel_->turn(4 * i);
    }
    return lever_->read(now);
  }
  [[nodiscard]] int told(std::uint16_t code) const {
    int value = -1;
    for (const input_event& event : wheel_->told) {
      if (event.type == EV_FF && event.code == code) value = event.value;
    }
    return value;
  }

  std::shared_ptr<FakeWheel> wheel_ = std::make_shared<FakeWheel>();
  std::optional<EvdevLever> lever_;
};

TEST_F(Lever, SetsUpOneForceThatPushesNothing) {
  open({.gain = 0.5});
  EXPECT_EQ(wheel_->levels, std::vector<int>{0});
  EXPECT_EQ(told(FF_GAIN), 0x8000);
  EXPECT_EQ(told(FF_AUTOCENTER), 0);
  EXPECT_EQ(told(3), 1);  // the effect plays
  EXPECT_EQ(wheel_->clock, CLOCK_MONOTONIC);
  const Measured m = lever_->read(now);
  EXPECT_EQ(m.operating_state, OperatingState::enabled);
  EXPECT_EQ(m.lever_rate, 0.0);
  EXPECT_FALSE(m.silent);
}

TEST_F(Lever, TheRateIsThatOfTheAngleOverTheStampsOfTheKernel) {
  open({.direction_W = Vec3(0.0, 0.0, -4.0)});
  const Measured m = turned();
  EXPECT_NEAR(m.lever_rate, 2.0, 1e-3);
  EXPECT_NEAR(lever_->angle(), 0.4, 1e-12);
  EXPECT_EQ(m.lever_direction_W, Vec3(0.0, 0.0, -1.0));
  FakeClock::pass(10.0);
  const Measured later = lever_->read(now);
  EXPECT_EQ(later.lever_rate, 0.0);
  EXPECT_FALSE(later.silent);
}

TEST_F(Lever, AnAxisWithoutItsReportDoesNotCount) {
  open();
  wheel_->say(EV_ABS, ABS_X, 500);
  FakeClock::pass(0.01);
  EXPECT_EQ(lever_->read(now).lever_rate, 0.0);
  EXPECT_EQ(lever_->angle(), 0.0);
  wheel_->say(EV_SYN, SYN_REPORT, 0);
  (void)lever_->read(now);
  EXPECT_DOUBLE_EQ(lever_->angle(), 0.5);
}

TEST_F(Lever, AsksAgainWhenTheKernelHasDroppedEvents) {
  open();
  EXPECT_GT(turned().lever_rate, 1.9);
  wheel_->say(EV_SYN, SYN_DROPPED, 0);
  wheel_->say(EV_ABS, ABS_X, -900);  // the tail of a report whose head was lost
  wheel_->say(EV_SYN, SYN_REPORT, 0);
  wheel_->axis.value = 700;
  const Measured m = lever_->read(now);
  EXPECT_EQ(m.lever_rate, 0.0);
  EXPECT_DOUBLE_EQ(lever_->angle(), 0.7);
}

TEST_F(Lever, TheButtonIsAskedForAgainAsWell) {
  open({.clutch = ClutchPolicy::hold});
  wheel_->push(true);
  EXPECT_TRUE(lever_->read(now).clutch);
  wheel_->button_down = false;
  wheel_->say(EV_SYN, SYN_DROPPED, 0);
  wheel_->say(EV_SYN, SYN_REPORT, 0);
  EXPECT_FALSE(lever_->read(now).clutch);
}

TEST_F(Lever, TheLevelFollowsTheTorqueAndIsCut) {
  open();
  lever_->servo_cf(1.0, {});
  EXPECT_EQ(wheel_->level(), 16384);
  lever_->servo_cf(-2.0, {});
  EXPECT_EQ(wheel_->level(), -32767);
  lever_->servo_cf(1e9, {});
  EXPECT_EQ(wheel_->level(), 32767);
  lever_->servo_cf(-std::numeric_limits<double>::infinity(), {});
  EXPECT_EQ(wheel_->level(), 0);
  lever_->servo_cf(1.0, {});
  lever_->servo_cf(std::numeric_limits<double>::quiet_NaN(), {});
  EXPECT_EQ(wheel_->level(), 0);
  const std::size_t calls = wheel_->levels.size();
  for (int i = 0; i < 10; ++i) lever_->servo_cf(0.0, {});
  EXPECT_EQ(wheel_->levels.size(), calls);  // no system call for the same level
}

TEST_F(Lever, AReleasedClutchIsRestAndNoForce) {
  wheel_->button_down = true;  // down from the start: not a press
  open({.clutch = ClutchPolicy::hold});
  Measured m = turned();
  EXPECT_EQ(m.operating_state, OperatingState::paused);
  EXPECT_EQ(m.lever_rate, 0.0);
  lever_->servo_cf(1.0, {});
  EXPECT_EQ(wheel_->level(), 0);
  wheel_->push(false);
  wheel_->push(true);
  m = lever_->read(now);
  EXPECT_TRUE(m.clutch);
  EXPECT_GT(m.lever_rate, 1.0);
  lever_->servo_cf(1.0, {});
  EXPECT_EQ(wheel_->level(), 16384);
  wheel_->push(false);
  (void)lever_->read(now);
  EXPECT_EQ(wheel_->level(), 0);
}

TEST_F(Lever, TheForceEndsAndIsErasedWithTheLever) {
  open();
  lever_->servo_cf(2.0, {});
  lever_.reset();
  EXPECT_EQ(wheel_->level(), 0);
  EXPECT_EQ(told(3), 0);
  EXPECT_EQ(wheel_->erased, 3);
}

TEST_F(Lever, ADeviceThatIsUnpluggedIsAFaultForGood) {
  open();
  turned();
  lever_->servo_cf(2.0, {});
  wheel_->gone = true;
  Measured m = lever_->read(now);
  EXPECT_EQ(m.operating_state, OperatingState::fault);
  EXPECT_TRUE(m.silent);
  EXPECT_EQ(m.lever_rate, 0.0);
  EXPECT_STREQ(m.why, "the device is gone");
  wheel_->gone = false;
  m = lever_->read(now);
  EXPECT_TRUE(m.silent);
  const std::size_t calls = wheel_->levels.size();
  lever_->servo_cf(1.0, {});
  EXPECT_EQ(wheel_->levels.size(), calls);
}

TEST_F(Lever, WhatIsNoEventIsAFaultWithoutForce) {
  open();
  lever_->servo_cf(2.0, {});
  wheel_->waiting.assign(EvdevParser::event_size, std::byte{0xff});
  EXPECT_EQ(lever_->read(now).operating_state, OperatingState::fault);
  EXPECT_EQ(wheel_->level(), 0);
  EXPECT_EQ(wheel_->erased, 3);
}

TEST_F(Lever, RefusesADeviceThatIsNoLever) {
  wheel_->has_axis = false;
  expect_refused("Lever on a test: it has no absolute axis 0");
  wheel_->has_axis = true;
  wheel_->has_force = false;
  expect_refused("it cannot show a constant force");
  wheel_->has_force = true;
  wheel_->has_gain = false;
  expect_refused("it has no gain (FF_GAIN)", {.gain = 0.1});
  wheel_->has_button = false;
  expect_refused("it has no button 288 for the clutch", {.clutch = ClutchPolicy::toggle});
  wheel_->axis.maximum = wheel_->axis.minimum;
  expect_refused("its axis ranges from -1000 to -1000");
  wheel_->gone = true;
  expect_refused("the list of its events is refused: No such device");
}

TEST_F(Lever, RefusesOptionsOutOfRange) {
  expect_refused("torque at full level is 0 N m", {.torque_at_full_level = 0.0});
  expect_refused("gain is 1.5", {.gain = 1.5});
  expect_refused("largest rate is nan rad/s", {.max_rate = std::nan("")});
  expect_refused("length of the direction is 0 m", {.direction_W = Vec3::Zero()});
}

TEST(EvdevLever, SaysWhyADeviceCannotBeOpened) {
  try {
    const EvdevLever lever("/dev/input/event-none");
    FAIL();
  } catch (const SetupError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("/dev/input/event-none cannot be opened"), std::string::npos) << text;
    EXPECT_NE(text.find("group input"), std::string::npos) << text;
  }
}

}  // namespace evdev_lever_test
}  // namespace repel::devices
