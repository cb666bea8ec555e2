// SPDX-License-Identifier: BSD-3-Clause
// The six-axis mouse with a fake daemon: only complete events cause motion, and every failure
// results in rest.
#include <repel/devices/spacenav.hpp>

#include <gtest/gtest.h>

#include <cstdlib>
#include <random>
#include <string>

#include <devices/fake_clock.hpp>
#include <devices/fake_spacenavd.hpp>

namespace repel::devices {
namespace spacenav_test {

using std::chrono::milliseconds;

/// Linear: a count of 100 is 1 m/s or 1 rad/s, axis by axis.
SpacenavOptions plain(const std::string& path) {
  SpacenavOptions options;
  options.path = path;
  options.shaping.full_travel = 100.0;
  options.shaping.dead_band = 0.0;
  options.shaping.linear_scale = 1.0;
  options.shaping.axes = {{{0, 1.0}, {1, 1.0}, {2, 1.0}, {3, 1.0}, {4, 1.0}, {5, 1.0}}};
  options.now = &FakeClock::now;
  return options;
}

/// A daemon and a device connected to it.
class ConnectedSpacenav : public ::testing::Test {
 protected:
  explicit ConnectedSpacenav(ClutchPolicy clutch = ClutchPolicy::always)
      : device_([&] {
          SpacenavOptions options = plain(folder_.socket());
          options.clutch = clutch;
          options.clutch_button = 1;
          return options;
        }()) {
    daemon_.accept();
  }

  /// Local sockets transfer at once: data that was sent can be read.
  Measured after(const Packet& packet) {
    daemon_.send(packet);
    return read();
  }
  Measured read() { return device_.read(milliseconds(0)); }
  void expect_rest(const Measured& m) {
    EXPECT_TRUE(m.measured_cv.linear.isZero(0.0));
    EXPECT_TRUE(m.measured_cv.angular.isZero(0.0));
    EXPECT_EQ(m.lever_rate, 0.0);
  }
  void expect_fault(const Measured& m) {
    EXPECT_EQ(m.operating_state, OperatingState::fault);
    EXPECT_TRUE(m.silent);
    EXPECT_FALSE(m.clutch);
    EXPECT_STRNE(m.why, "");
    expect_rest(m);
  }

  ScratchFolder folder_;
  FakeSpacenavd daemon_{folder_.socket()};
  Spacenav device_;
};

class HeldSpacenav : public ConnectedSpacenav {
 protected:
  HeldSpacenav() : ConnectedSpacenav(ClutchPolicy::hold) {}
};

TEST_F(ConnectedSpacenav, NothingMovesBeforeTheFirstEvent) {
  const Measured m = read();
  EXPECT_EQ(m.operating_state, OperatingState::enabled);
  EXPECT_FALSE(m.silent);
  expect_rest(m);
  EXPECT_EQ(device_.name(), "Spacenav on " + folder_.socket());
}

TEST_F(ConnectedSpacenav, MotionIsHeldUntilTheNextEvent) {
  EXPECT_EQ(after(motion(50, -20, 0, 0, 0, 10)).measured_cv.linear, Vec3(0.5, -0.2, 0.0));
  EXPECT_EQ(read().measured_cv.angular, Vec3(0.0, 0.0, 0.1));
  EXPECT_EQ(after(motion(0, 0, 100)).measured_cv.linear, Vec3(0.0, 0.0, 1.0));
  expect_rest(after(rest()));
}

TEST_F(ConnectedSpacenav, TheNewestOfManyEventsCounts) {
  for (std::int32_t i = 1; i <= 100; ++i) daemon_.send(motion(i, 0, 0));
  EXPECT_EQ(read().measured_cv.linear.x(), 1.0);
}

TEST_F(ConnectedSpacenav, SaysNothingToTheDaemon) {
  read();
  EXPECT_TRUE(daemon_.heard().empty());
}

TEST_F(ConnectedSpacenav, HalfAnEventMovesNothing) {
  const Packet packet = motion(10, 20, 30);
  const auto bytes = std::as_bytes(std::span(packet));
  for (std::size_t cut = 1; cut < bytes.size(); ++cut) {
    daemon_.send(bytes.first(cut));
    expect_rest(read());
    expect_rest(read());
    daemon_.send(bytes.subspan(cut));
    EXPECT_EQ(read().measured_cv.linear, Vec3(0.1, 0.2, 0.3));
    expect_rest(after(rest()));
  }
}

TEST_F(ConnectedSpacenav, HalfAnEventAndThenTheEndIsAFaultAndNoMotion) {
  const Packet packet = motion(10, 20, 30);
  daemon_.send(std::as_bytes(std::span(packet)).first(12));
  expect_rest(read());
  daemon_.die();
  expect_fault(read());
}

TEST_F(ConnectedSpacenav, WhatIsNoEventIsAFault) {
  EXPECT_EQ(after(motion(50, 0, 0)).measured_cv.linear.x(), 0.5);
  expect_fault(after({42}));
}

TEST_F(ConnectedSpacenav, RandomBytesEndInAFaultAndNeverInMotionThatIsNotSane) {
  const std::uint64_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 rng(seed);
  Measured m = read();
  for (int i = 0; i < 100 && m.operating_state != OperatingState::fault; ++i) {
    std::vector<std::byte> bytes(1 + rng() % 60);
    for (std::byte& b : bytes) b = static_cast<std::byte>(rng());
    daemon_.send(bytes);
    m = read();
    EXPECT_TRUE(is_finite(m.measured_cv));
    EXPECT_LE(m.measured_cv.linear.cwiseAbs().maxCoeff(), 1.0);
  }
  expect_fault(m);
}

TEST_F(ConnectedSpacenav, MotionThatIsNotRenewedIsSilenceAndRest) {
  after(motion(50, 0, 0));
  FakeClock::pass(0.49);
  EXPECT_FALSE(read().silent);
  EXPECT_EQ(read().measured_cv.linear.x(), 0.5);
  FakeClock::pass(0.02);
  const Measured m = read();
  EXPECT_TRUE(m.silent);
  EXPECT_STRNE(m.why, "");
  expect_rest(m);
  const Measured again = after(motion(20, 0, 0));
  EXPECT_FALSE(again.silent);
  EXPECT_EQ(again.measured_cv.linear.x(), 0.2);
}

TEST_F(ConnectedSpacenav, RestIsNotSilenceHoweverLong) {
  after(motion(50, 0, 0));
  after(rest());
  FakeClock::pass(3600.0);
  const Measured m = read();
  EXPECT_FALSE(m.silent);
  EXPECT_EQ(m.operating_state, OperatingState::enabled);
}

TEST_F(ConnectedSpacenav, OtherNewsDoesNotRenewAMotion) {
  after(motion(50, 0, 0));
  FakeClock::pass(0.6);
  EXPECT_TRUE(after({3, 1, 2, 0, 0, 0, 0, 0}).silent);
  EXPECT_TRUE(after(press(5)).silent);
}

TEST_F(ConnectedSpacenav, ADaemonThatDiesIsAFaultAtOnceAndIsFoundAgainAtRest) {
  EXPECT_EQ(after(motion(50, 0, 0)).measured_cv.linear.x(), 0.5);
  daemon_.die();
  expect_fault(read());
  FakeClock::pass(1.1);
  expect_fault(read());
  FakeSpacenavd next(folder_.socket());
  expect_fault(read());  // it reconnects only once a second
  FakeClock::pass(1.1);
  const Measured back = read();
  EXPECT_EQ(back.operating_state, OperatingState::enabled);
  EXPECT_FALSE(back.silent);
  expect_rest(back);
  next.accept();
  next.send(motion(0, 30, 0));
  EXPECT_EQ(read().measured_cv.linear, Vec3(0.0, 0.3, 0.0));
}

TEST_F(HeldSpacenav, WithoutTheClutchThereIsRest) {
  Measured m = after(motion(50, 0, 0));
  EXPECT_EQ(m.operating_state, OperatingState::paused);
  EXPECT_FALSE(m.clutch);
  expect_rest(m);
  EXPECT_EQ(after(press(0)).operating_state, OperatingState::paused);  // another button
  m = after(press(1));
  EXPECT_TRUE(m.clutch);
  EXPECT_EQ(m.operating_state, OperatingState::enabled);
  EXPECT_EQ(m.measured_cv.linear.x(), 0.5);
  expect_rest(after(release(1)));
}

TEST_F(HeldSpacenav, AClutchThatWasHeldIsReleasedAfterAFault) {
  EXPECT_TRUE(after(press(1)).clutch);
  daemon_.die();
  expect_fault(read());
  FakeSpacenavd next(folder_.socket());
  FakeClock::pass(1.1);
  EXPECT_EQ(read().operating_state, OperatingState::paused);
  next.accept();
  next.send(motion(50, 0, 0));
  expect_rest(read());
}

TEST_F(HeldSpacenav, AnOldMotionDoesNotComeBackWithTheClutch) {
  after(motion(50, 0, 0));
  FakeClock::pass(0.6);
  EXPECT_FALSE(read().silent);
  const Measured m = after(press(1));
  EXPECT_TRUE(m.silent);
  expect_rest(m);
}

void expect_refused(const SpacenavOptions& options, const std::string& says) {
  try {
    const Spacenav device(options);
    FAIL() << "connected: " << says;
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
  }
}

TEST(Spacenav, SaysHowToGetADaemonWhenThereIsNone) {
  const ScratchFolder folder;
  expect_refused(plain(folder.socket()), folder.socket() + ": No such file or directory");
  expect_refused(plain(folder.socket()), "systemctl start spacenavd");
  expect_refused(plain(folder.socket()), "SPNAV_SOCKET");
}

TEST(Spacenav, RefusesWhatIsOutOfRange) {
  expect_refused(plain("/tmp/" + std::string(200, 'x')), "has 205 characters");
  SpacenavOptions options = plain("/nowhere");
  options.stale_after = 0.0;
  expect_refused(options, "stale after is 0 s; allowed: 0.01 to 60 s");
  options = plain("/nowhere");
  options.clutch_button = 256;
  expect_refused(options, "number of the clutch button is 256");
  options = plain("/nowhere");
  options.shaping.dead_band = 2.0;
  expect_refused(options, "dead band is 2");
}

TEST(Spacenav, FindsTheSocketThatTheEnvironmentNames) {
  const ScratchFolder folder;
  FakeSpacenavd daemon(folder.socket());
  ::setenv("SPNAV_SOCKET", folder.socket().c_str(), 1);
  const Spacenav device;
  ::unsetenv("SPNAV_SOCKET");
  EXPECT_EQ(device.name(), "Spacenav on " + folder.socket());
}

}  // namespace spacenav_test
}  // namespace repel::devices
