// SPDX-License-Identifier: BSD-3-Clause
// The driver of the Haply Inverse Service against a stand-in. Times in real seconds are only
// timeouts against hangs.
#include <repel/devices/haply_inverse.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include <devices/fake_clock.hpp>
#include <devices/fake_haply.hpp>
#include <repel/base/setup_error.hpp>
#include <repel/devices/device_thread.hpp>
#include <support/families.hpp>

namespace repel::devices {
namespace haply_inverse_test {

using std::chrono::milliseconds;

HaplyInverseOptions options_for(const FakeHaply& service) {
  HaplyInverseOptions options;
  options.url = service.url();
  options.period = 1e-4;
  options.now = &FakeClock::now;
  return options;
}

/// Passes a millisecond and reads; an answer is waited for.
Measured next(HaplyInverse& device, milliseconds wait = milliseconds(1000)) {
  FakeClock::pass(0.001);
  return device.read(wait);
}

/// Reads until it is in this state.
Measured await(HaplyInverse& device, OperatingState state) {
  Measured m;
  for (int i = 0; i < 2000 && m.operating_state != state; ++i) m = next(device, milliseconds(5));
  return m;
}

Wrench push(double x, double y, double z) {
  return {Vec3(x, y, z), Vec3(1, 2, 3)};
}

void expect_fault(const Measured& m, const std::string& why) {
  EXPECT_EQ(m.operating_state, OperatingState::fault);
  EXPECT_TRUE(m.silent);
  EXPECT_FALSE(m.has_position);
  EXPECT_TRUE(m.measured_cv.linear.isZero(0.0));
  EXPECT_NE(std::string(m.why).find(why), std::string::npos) << m.why;
}

/// Waits until the service has felt the force, in the axes of the device.
bool feels(const FakeHaply& service, const Vec3& force) {
  for (int i = 0; i < 2000; ++i) {
    if ((service.force() - force).norm() < 1e-4) return true;
    std::this_thread::sleep_for(milliseconds(1));
  }
  return false;
}

TEST(HaplyInverse, TheHandleComesInAxesOfTheWorldAndInMetres) {
  FakeHaply service;
  const Eigen::Quaterniond about_right(Eigen::AngleAxisd(0.4, Vec3::UnitX()));
  service.set([&](FakeHandle& h) {
    h.position = Vec3(0.1, 0.2, 0.3);  // right, away, up
    h.velocity = Vec3(-0.4, 0.5, 0.6);
    h.R_DG = about_right;
  });
  HaplyInverse device(options_for(service));
  EXPECT_EQ(device.name(), "Inverse3 049D on " + service.url());
  const Measured m = next(device);
  EXPECT_EQ(m.operating_state, OperatingState::enabled);
  EXPECT_STREQ(m.why, "");
  EXPECT_FALSE(m.silent);
  ASSERT_TRUE(m.has_position && m.has_orientation);
  EXPECT_TRUE(m.position_W.isApprox(Vec3(0.2, -0.1, 0.3)));  // forward, left, up
  EXPECT_TRUE(m.measured_cv.linear.isApprox(Vec3(0.5, 0.4, 0.6)));
  // A turn about the axis to the right is one about minus the axis to the left.
  service.set([&](FakeHandle& h) { h.R_DG = about_right * about_right; });
  const Eigen::AngleAxisd turn(next(device).R_WH * m.R_WH.conjugate());
  EXPECT_TRUE((turn.angle() * turn.axis()).isApprox(Vec3(0, -0.4, 0), 1e-9));
}

TEST(HaplyInverse, TheServiceIsToldTheNameAndTheAxesOnce) {
  FakeHaply service;
  HaplyInverse device(options_for(service));
  for (int i = 0; i < 3; ++i) (void)next(device);
  ASSERT_GE(service.messages(), 3U);
  EXPECT_TRUE(service.heard(0)["session"].contains("configure"));
  EXPECT_FALSE(service.heard(1).contains("session"));
  EXPECT_FALSE(service.heard(2).contains("session"));
}

TEST(HaplyInverse, AForceArrivesWithTheNextReadingInAxesOfTheDevice) {
  FakeHaply service;
  HaplyInverseOptions options = options_for(service);
  options.force_slew = 1e5;
  HaplyInverse device(options);
  (void)next(device);
  device.servo_cf(0.0, push(1.0, 0.5, -0.25));
  (void)next(device);  // its answer is the reading for which the force is made
  (void)next(device);
  EXPECT_TRUE(service.force().isApprox(Vec3(-0.5, 1.0, -0.25), 1e-4)) << service.force();
  EXPECT_TRUE(device.force().isApprox(Vec3(1.0, 0.5, -0.25), 1e-4));
}

TEST(HaplyInverse, TheForceIsLimitedAndFollowsAtALimitedRate) {
  FakeHaply service;
  HaplyInverse device(options_for(service));
  (void)next(device);
  Vec3 last = Vec3::Zero();
  double most = 0.0;
  for (int i = 0; i < 40; ++i) {
    device.servo_cf(0.0, push(i < 20 ? 300.0 : -300.0, 0.0, 400.0));
    (void)next(device);
    EXPECT_LE((device.force() - last).norm(), 0.6 + 1e-6) << "600 N/s in 1 ms";
    last = device.force();
    most = std::max(most, last.norm());
    ASSERT_LE(last.norm(), 3.0 + 1e-9);
    ASSERT_LE(service.force().norm(), 3.0 + 1e-4);
  }
  EXPECT_NEAR(most, 3.0, 1e-6);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  device.servo_cf(0.0, push(nan, 0.0, 0.0));
  for (int i = 0; i < 20; ++i) (void)next(device);
  EXPECT_TRUE(device.force().isZero(1e-9));
}

TEST(HaplyInverse, WithoutTheClutchThereIsNoMotionAndNoForce) {
  FakeHaply service;
  service.set([](FakeHandle& h) {
    h.velocity = Vec3(0.1, 0, 0);
    h.buttons[1] = true;  // down already: no press
  });
  HaplyInverseOptions options = options_for(service);
  options.clutch = ClutchPolicy::hold;
  options.clutch_button = 1;
  HaplyInverse device(options);
  const auto pushed = [&] {
    for (int i = 0; i < 20; ++i) {
      device.servo_cf(0.0, push(1, 0, 0));
      (void)next(device);
    }
    device.servo_cf(0.0, push(1, 0, 0));
    return next(device);
  };
  Measured m = pushed();
  EXPECT_EQ(m.operating_state, OperatingState::paused);
  EXPECT_TRUE(m.measured_cv.linear.isZero(0.0));
  EXPECT_TRUE(m.has_position);
  EXPECT_TRUE(device.force().isZero(0.0));
  service.set([](FakeHandle& h) { h.buttons[1] = false; });
  EXPECT_EQ(pushed().operating_state, OperatingState::paused);
  service.set([](FakeHandle& h) { h.buttons[1] = true; });
  m = pushed();
  EXPECT_EQ(m.operating_state, OperatingState::enabled);
  EXPECT_FALSE(m.measured_cv.linear.isZero(0.0));
  EXPECT_GT(device.force().x(), 0.5);
  service.set([](FakeHandle& h) { h.buttons[1] = false; });
  (void)next(device);  // the reading that says so
  EXPECT_EQ(next(device).operating_state, OperatingState::paused);
  EXPECT_TRUE(device.force().isZero(0.0));
  EXPECT_TRUE(service.force().isZero(0.0));
  // Without a grip there is no button.
  service.set([](FakeHandle& h) { h.buttons[1] = true; });
  EXPECT_EQ(pushed().operating_state, OperatingState::enabled);
  service.set([](FakeHandle& h) { h.has_grip = false; });
  EXPECT_EQ(pushed().operating_state, OperatingState::paused);
}

TEST(HaplyInverse, AHandleWithoutAGripHasAPositionOnly) {
  FakeHaply service;
  service.set([](FakeHandle& h) { h.has_grip = false; });
  HaplyInverse device(options_for(service));
  const Measured m = next(device);
  EXPECT_EQ(m.operating_state, OperatingState::enabled);
  EXPECT_TRUE(m.has_position);
  EXPECT_FALSE(m.has_orientation);
}

TEST(HaplyInverse, AServiceThatDiesIsAFaultAndIsFoundAgainWithTheClutchReleased) {
  auto service = std::make_unique<FakeHaply>();
  const unsigned short port = service->port();
  HaplyInverseOptions options = options_for(*service);
  options.clutch = ClutchPolicy::toggle;
  HaplyInverse device(options);
  EXPECT_EQ(next(device).operating_state, OperatingState::paused);
  service->set([](FakeHandle& h) { h.buttons[0] = true; });
  EXPECT_EQ(await(device, OperatingState::enabled).operating_state, OperatingState::enabled);
  device.servo_cf(0.0, push(1, 0, 0));
  (void)next(device);
  (void)next(device);
  EXPECT_FALSE(device.force().isZero(0.0));
  service.reset();
  expect_fault(await(device, OperatingState::fault), "closed the connection");
  EXPECT_TRUE(device.force().isZero(0.0));
  for (int i = 0; i < 40; ++i) {  // refused; each time it waits longer
    FakeClock::pass(0.25);
    expect_fault(device.read(milliseconds(5)), "closed the connection");
  }
  FakeHaply again(port);
  EXPECT_EQ(again.clients(), 0);
  FakeClock::pass(8.1);
  again.set([](FakeHandle& h) { h.buttons[0] = true; });
  const Measured back = await(device, OperatingState::paused);
  EXPECT_EQ(back.operating_state, OperatingState::paused);
  EXPECT_FALSE(back.silent);
  again.set([](FakeHandle& h) { h.buttons[0] = false; });
  (void)next(device);
  (void)next(device);
  again.set([](FakeHandle& h) { h.buttons[0] = true; });
  EXPECT_EQ(await(device, OperatingState::enabled).operating_state, OperatingState::enabled);
  (void)next(device);
  EXPECT_TRUE(device.force().isZero(0.0)) << "the old force does not come back";
}

TEST(HaplyInverse, AServiceThatDoesNotAnswerIsSilentAfterATenthOfASecond) {
  FakeHaply service;
  HaplyInverse device(options_for(service));
  (void)next(device);
  service.answer_by([](const FakeHandle&) { return std::string(); });
  EXPECT_EQ(next(device, milliseconds(20)).operating_state, OperatingState::enabled);
  FakeClock::pass(0.09);
  EXPECT_EQ(device.read(milliseconds(5)).operating_state, OperatingState::enabled);
  FakeClock::pass(0.02);
  expect_fault(device.read(milliseconds(5)), "does not answer");
  service.answer_by(nullptr);
  FakeClock::pass(0.4);
  expect_fault(device.read(milliseconds(5)), "does not answer");  // not before 0.5 s
  FakeClock::pass(0.2);
  EXPECT_EQ(await(device, OperatingState::enabled).operating_state, OperatingState::enabled);
}

/// A device that was pushed, and a message in place of the next answer.
void expect_fault_after(const std::string& answer, const std::string& why) {
  SCOPED_TRACE(answer.substr(0, 60));
  FakeHaply service;
  HaplyInverse device(options_for(service));
  device.servo_cf(0.0, push(1, 0, 0));
  for (int i = 0; i < 5; ++i) (void)next(device);
  EXPECT_TRUE(feels(service, Vec3(0, 1, 0)));
  service.answer_by([&](const FakeHandle&) { return answer; });
  expect_fault(next(device), why);
  EXPECT_TRUE(device.force().isZero(0.0));
  EXPECT_TRUE(feels(service, Vec3::Zero())) << "it is told to let go";
  service.answer_by(nullptr);
  FakeClock::pass(0.6);
  EXPECT_EQ(await(device, OperatingState::enabled).operating_state, OperatingState::enabled);
}

TEST(HaplyInverse, AMessageThatIsWrongIsAFaultAndTheForceIsTakenBack) {
  FakeHandle handle;
  expect_fault_after("garbage", "not JSON");
  expect_fault_after(state_update(handle).dump().substr(0, 80), "not JSON");
  nlohmann::json text = state_update(handle);
  text["inverse3"][0]["state"].erase("cursor_velocity");
  expect_fault_after(text.dump(), "velocity of the handle");
  handle.position = Vec3(0.3, -0.12, 0.15);
  expect_fault_after(state_update(handle).dump(), "jumps");
  handle = {};
  handle.id = "OTHER";
  expect_fault_after(state_update(handle).dump(), "changed for another");
}

// The tool once followed it at 10 m/s.
TEST(HaplyInverse, AVelocityThatContradictsThePositionIsNotFollowed) {
  for (const double told : {10.0, 2.0, 1.0, -1.0}) {
    SCOPED_TRACE(told);
    FakeHaply service;
    HaplyInverse device(options_for(service));
    (void)next(device);
    service.set([&](FakeHandle& h) { h.velocity = Vec3(told, 0, 0); });
    double followed = 0.0;  // [m]
    Measured m;
    for (int i = 0; i < 100 && m.operating_state != OperatingState::fault; ++i) {
      m = next(device);
      followed += 0.001 * m.measured_cv.linear.norm();
    }
    expect_fault(m, told > 3.0 ? "faster than a hand" : "contradicts its position");
    EXPECT_LT(followed, 0.03);
  }
}

TEST(HaplyInverse, AVelocityThatLagsBehindAQuickHandIsFollowed) {
  FakeHaply service;
  HaplyInverse device(options_for(service));
  (void)next(device);
  const Vec3 place = FakeHandle{}.position;
  for (int i = 0; i < 2000; ++i) {
    // To and fro by 0.1 m twice a second, at up to 1.3 m/s, told 10 ms late.
    const double t = 0.001 * i, turn = 2.0 * std::numbers::pi * 2.0;
    service.set([&](FakeHandle& h) {
      h.position = place + Vec3(0, 0, 0.1 * (1.0 - std::cos(turn * t)));
      h.velocity = Vec3(0, 0, t < 0.01 ? 0.0 : 0.1 * turn * std::sin(turn * (t - 0.01)));
    });
    ASSERT_EQ(next(device).operating_state, OperatingState::enabled) << t << " s";
  }
}

TEST(HaplyInverse, AMessageThatIsHugeEndsTheConnection) {
  FakeHaply service;
  HaplyInverse device(options_for(service));
  (void)next(device);
  service.answer_by([](const FakeHandle&) { return std::string(HaplyBounds::text + 100, ' '); });
  expect_fault(next(device), "closed the connection");
}

TEST(HaplyInverse, BytesWithoutAFrameEndTheConnection) {
  for (const char* bytes : {"\xff\xff\xff\xff\xff", "HTTP/1.1 200 OK\r\n\r\n"}) {
    FakeHaply service;
    HaplyInverse device(options_for(service));
    (void)next(device);
    service.send_bytes(bytes);
    expect_fault(await(device, OperatingState::fault), "");
    FakeClock::pass(0.6);
    EXPECT_EQ(await(device, OperatingState::enabled).operating_state, OperatingState::enabled);
  }
}

TEST(HaplyInverse, HalfAMessageIsWaitedForAndThenIsSilence) {
  FakeHaply service;
  HaplyInverse device(options_for(service));
  (void)next(device);
  service.send_bytes(std::string("\x81\x7e\x01\x00{\"inverse3\"", 15));  // of 256 bytes
  EXPECT_EQ(next(device, milliseconds(50)).operating_state, OperatingState::enabled);
  FakeClock::pass(0.11);
  expect_fault(device.read(milliseconds(5)), "does not answer");
}

TEST(HaplyInverse, AServiceThatFloodsIsAFault) {
  FakeHaply service;
  HaplyInverse device(options_for(service));
  (void)next(device);
  service.repeat(2);  // more than one answer does no harm
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(next(device).operating_state, OperatingState::enabled);
  }
  const std::string text = state_update({}).dump();
  std::string frame("\x81\x7e", 2);
  frame += static_cast<char>(text.size() / 256);
  frame += static_cast<char>(text.size() % 256);
  frame += text;
  std::string flood;
  for (int i = 0; i < 100; ++i) flood += frame;
  service.send_bytes(flood);
  expect_fault(await(device, OperatingState::fault), "floods");
}

TEST(HaplyInverse, ADeviceThatIsUnpluggedOrNotCalibratedIsAFaultUntilItIsBack) {
  FakeHaply service;
  HaplyInverse device(options_for(service));
  device.servo_cf(0.0, push(1, 0, 0));
  for (int i = 0; i < 5; ++i) (void)next(device);
  service.set([](FakeHandle& h) { h.is_there = false; });
  expect_fault(next(device), "no device");
  EXPECT_EQ(service.clients(), 1) << "the connection stays";
  service.set([](FakeHandle& h) {
    h.is_there = true;
    h.calibrated = false;
  });
  for (int i = 0; i < 50; ++i) expect_fault(next(device, milliseconds(5)), "");
  expect_fault(next(device, milliseconds(5)), "not calibrated");
  EXPECT_TRUE(feels(service, Vec3::Zero()));
  service.set([](FakeHandle& h) { h.calibrated = true; });
  EXPECT_EQ(await(device, OperatingState::enabled).operating_state, OperatingState::enabled);
  EXPECT_EQ(service.clients(), 1);
}

TEST(HaplyInverse, ADeviceThatLosesItsCalibrationIsLetGo) {
  FakeHaply service;
  HaplyInverse device(options_for(service));
  device.servo_cf(0.0, push(1, 0, 0));
  for (int i = 0; i < 5; ++i) (void)next(device);
  ASSERT_TRUE(feels(service, Vec3(0, 1, 0)));
  service.set([](FakeHandle& h) { h.calibrated = false; });
  (void)next(device);
  expect_fault(next(device), "not calibrated");
  EXPECT_TRUE(feels(service, Vec3::Zero()));
}

TEST(HaplyInverse, NoForceAtAllIsSentWithoutAReading) {
  FakeHaply service;
  HaplyInverse device(options_for(service));
  device.servo_cf(0.0, push(1, 0, 0));
  for (int i = 0; i < 5; ++i) (void)next(device);
  ASSERT_TRUE(feels(service, Vec3(0, 1, 0)));
  device.servo_cf(0.0, {});
  EXPECT_TRUE(feels(service, Vec3::Zero()));
  EXPECT_EQ(next(device).operating_state, OperatingState::enabled);
}

TEST(HaplyInverse, WhateverIsAnsweredItsReadingsAreSafe) {
  constexpr unsigned seed = 77;
  families::Rng rng(seed);
  SCOPED_TRACE(families::of_seed(seed, "answer", 0));
  FakeHaply service;
  HaplyInverse device(options_for(service));
  service.answer_by([&](const FakeHandle& handle) {
    std::string text = state_update(handle).dump();
    if (rng() % 4 == 0) text[rng() % text.size()] = static_cast<char>(32 + rng() % 95);
    return text;
  });
  int faults = 0, sound = 0;
  for (int i = 0; i < 1000; ++i) {
    device.servo_cf(0.0, push(5, 0, 0));
    FakeClock::pass(0.3);
    const Measured m = device.read(milliseconds(5));
    ASSERT_TRUE(is_finite(m.measured_cv) && m.position_W.allFinite());
    ASSERT_LE(device.force().norm(), 3.0 + 1e-9);
    if (m.operating_state == OperatingState::fault) {
      ++faults;
    } else {
      ++sound;
    }
  }
  EXPECT_GT(faults, 100);
  EXPECT_GT(sound, 100);
}

/// [m] the largest excursion in the last of two seconds of a device of 0.1 kg that is drawn to its
/// place by a spring, through the driver.
double excursion(double stiffness, double most_damping) {
  FakeHaply service;
  const Vec3 place = FakeHandle{}.position;
  Vec3 held = Vec3::Zero();
  service.set([&](FakeHandle& h) { h.velocity = Vec3(0.1, 0, 0); });
  service.feel_by([&](const Vec3& force, FakeHandle& h) {
    // A force acts from its command to the next.
    for (int i = 0; i < 10; ++i) {
      h.velocity += 1e-4 / 0.1 * (held - 0.1 * h.velocity);
      h.position += 1e-4 * h.velocity;
    }
    held = force;
  });
  HaplyInverseOptions options = options_for(service);
  options.guard.most_damping = most_damping;
  options.guard.most_energy = 0.01;
  HaplyInverse device(options);
  double most = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const Measured m = next(device);
    if (m.operating_state != OperatingState::enabled) return 1.0;
    const Vec3 from = m.position_W - options.R_WD * place;
    device.servo_cf(0.0, {-stiffness * from, Vec3::Zero()});
    if (i >= 1000) most = std::max(most, from.norm());
  }
  return most;
}

TEST(HaplyInverse, TheGuardKeepsASpringPassiveThatIsTooStiffForTheDevice) {
  // 0.1 N s/m of the device, and 600 N/m that act a reading late.
  EXPECT_GT(excursion(600.0, 0.0), 0.005) << "the spring must be too stiff";
  EXPECT_LT(excursion(600.0, 10.0), 0.001);
  // What is soft enough comes to rest without it.
  EXPECT_LT(excursion(20.0, 0.0), 0.01);
}

TEST(HaplyInverse, LetsGoAtTheEnd) {
  FakeHaply service;
  {
    HaplyInverse device(options_for(service));
    device.servo_cf(0.0, push(1, 0, 0));
    for (int i = 0; i < 5; ++i) (void)next(device);
    ASSERT_TRUE(feels(service, Vec3(0, 1, 0)));
  }
  EXPECT_TRUE(feels(service, Vec3::Zero()));
}

TEST(HaplyInverse, ItsThreadReadsAThousandTimesASecondAtMost) {
  FakeHaply service;
  HaplyInverseOptions options;
  options.url = service.url();
  DeviceThread<HaplyInverse> thread(std::make_unique<HaplyInverse>(options));
  const auto begin = std::chrono::steady_clock::now();
  const std::size_t before = service.messages();
  while (std::chrono::steady_clock::now() - begin < milliseconds(200)) {
    thread.servo_cf(0.0, push(0, 0, 1));
    std::this_thread::sleep_for(milliseconds(2));
  }
  const double passed =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  EXPECT_LE(static_cast<double>(service.messages() - before), 1000.0 * passed + 10.0);
  bool is_felt = false;
  for (int i = 0; i < 5000 && !is_felt; ++i) {
    thread.servo_cf(0.0, push(0, 0, 1));
    std::this_thread::sleep_for(milliseconds(2));
    is_felt = std::abs(service.force().z() - 1.0) < 1e-4;
  }
  EXPECT_TRUE(is_felt);
  EXPECT_GT(thread.measured(0.0).count, 0U);
  thread.stop();
  EXPECT_TRUE(feels(service, Vec3::Zero()));
}

void expect_refused(const HaplyInverseOptions& options, const std::string& says) {
  try {
    const HaplyInverse device(options);
    FAIL() << "connected: " << says;
  } catch (const SetupError& error) {
    EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
  }
}

TEST(HaplyInverse, SaysHowToGetAServiceOrADeviceWhenThereIsNone) {
  HaplyInverseOptions options;
  {
    const FakeHaply gone;
    options.url = gone.url();
  }
  expect_refused(options, options.url + ": Connection refused");
  expect_refused(options, "systemctl start haply-inverse-service");
  FakeHaply service;
  service.set([](FakeHandle& h) { h.is_there = false; });
  expect_refused(options_for(service), "the service has no device");
}

TEST(HaplyInverse, RefusesWhatIsOutOfRange) {
  HaplyInverseOptions options;
  options.url = "http://localhost";
  expect_refused(options, "'http://localhost'; allowed: ws://HOST or ws://HOST:PORT");
  options = {};
  options.force_limit = 50.0;
  expect_refused(options, "force limit is 50 N; allowed: 0 to 10 N");
  options = {};
  options.R_WD(0, 0) = 1.0;
  expect_refused(options, "no rotation");
  options = {};
  options.clutch_button = 3;
  expect_refused(options, "number of the clutch button");
  options = {};
  options.retry_at_most = 0.1;
  expect_refused(options, "retry at most");
}

}  // namespace haply_inverse_test
}  // namespace repel::devices
