// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Tests of the drive of every simulated arm: brakes, stop, watchdog.
///
/// `make(watchdog)` returns the arm at its start; `push` are torques that set it in motion.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulated/arms.hpp"

namespace repel::simulated {

constexpr double tick_period = 1.0 / 400;  // [s]
constexpr double watchdog = 0.05;          // [s] 20 ticks

/// Simulates `arm` for that many ticks, sending `torques` in each.
template <class Arm>
void drive(Arm& arm, const std::vector<double>& torques, int ticks) {
  for (int tick = 0; tick < ticks; ++tick) {
    arm.set_torques(torques);
    arm.step(tick_period);
  }
}

/// Simulates `arm` for that many ticks without sending anything.
template <class Arm>
void leave(Arm& arm, int ticks) {
  for (int tick = 0; tick < ticks; ++tick) arm.step(tick_period);
}

/// The largest joint speed [rad/s] or [m/s].
template <class Arm>
double speed(const Arm& arm) {
  double most = 0.0;
  for (const double v : velocities(arm)) most = std::max(most, std::abs(v));
  return most;
}

/// The largest deviation of a joint from `q` [rad] or [m].
template <class Arm>
double moved(const Arm& arm, const std::vector<double>& q) {
  double most = 0.0;
  const std::vector<double> now = positions(arm);
  for (std::size_t i = 0; i < q.size(); ++i) most = std::max(most, std::abs(now[i] - q[i]));
  return most;
}

/// With engaged brakes, `arm` comes to rest within a second and stays for ten more.
template <class Arm>
void expect_to_stand(Arm& arm, const std::vector<double>& torques) {
  const std::vector<double> begin = positions(arm);
  drive(arm, torques, 400);
  EXPECT_LT(speed(arm), 1e-9);
  EXPECT_LT(moved(arm, begin), 1.0);
  const std::vector<double> stands = positions(arm);
  drive(arm, torques, 4000);
  EXPECT_LT(moved(arm, stands), 1e-9);
  EXPECT_LT(speed(arm), 1e-9);
}

/// Brakes stop a moving arm and hold it, whatever torques are commanded.
template <class Make>
void expect_brakes_to_hold(const Make& make, const std::vector<double>& push) {
  auto arm = make(0.0);
  drive(arm, push, 100);
  EXPECT_GT(speed(arm), 0.1) << "it must move";
  std::vector<double> harder = push;
  for (double& torque : harder) torque *= -100.0;
  arm.engage_brakes(true);
  EXPECT_EQ(arm.state(), ArmState::enabled);
  expect_to_stand(arm, harder);
  arm.engage_brakes(false);
  drive(arm, push, 100);
  EXPECT_GT(speed(arm), 0.1) << "they let go";
}

/// `stop` holds the arm until `enable`, from where it continues.
template <class Make>
void expect_to_stop_until_enabled(const Make& make, const std::vector<double>& push) {
  auto arm = make(0.0);
  drive(arm, push, 100);
  arm.stop();
  EXPECT_EQ(arm.state(), ArmState::stopped);
  expect_to_stand(arm, push);
  arm.engage_brakes(false);
  const std::vector<double> stands = positions(arm);
  drive(arm, push, 40);
  EXPECT_LT(moved(arm, stands), 1e-9) << "only `enable` takes the brakes off";
  arm.enable();
  EXPECT_EQ(arm.state(), ArmState::enabled);
  drive(arm, push, 1);
  EXPECT_LT(moved(arm, stands), 0.01) << "it does not jump";
  drive(arm, push, 99);
  EXPECT_GT(speed(arm), 0.1);
  arm.stop();
  arm.reset(positions(arm));
  EXPECT_EQ(arm.state(), ArmState::enabled) << "a reset forgets";
}

/// The watchdog stops an arm that receives nothing; torques alone do not restart it.
template <class Make>
void expect_the_watchdog_to_stop(const Make& make, const std::vector<double>& push) {
  auto arm = make(watchdog);
  drive(arm, push, 100);
  leave(arm, 19);  // plus one since the last torques
  EXPECT_EQ(arm.state(), ArmState::enabled);
  leave(arm, 1);
  EXPECT_EQ(arm.state(), ArmState::stopped);
  leave(arm, 400);
  EXPECT_LT(speed(arm), 1e-9);
  const std::vector<double> stands = positions(arm);
  drive(arm, push, 100);
  EXPECT_EQ(arm.state(), ArmState::stopped);
  EXPECT_LT(moved(arm, stands), 1e-9);
  arm.enable();
  EXPECT_EQ(arm.state(), ArmState::enabled);
  drive(arm, push, 1);
  EXPECT_LT(moved(arm, stands), 0.01) << "it does not jump";
  drive(arm, push, 99);
  EXPECT_GT(speed(arm), 0.1);
}

/// A watchdog that is fed in time gives bitwise the same motion as no watchdog.
template <class Make>
void expect_a_fed_watchdog_to_change_nothing(const Make& make, const std::vector<double>& push) {
  auto plain = make(0.0);
  auto watched = make(watchdog);
  for (int tick = 0; tick < 400; ++tick) {
    std::vector<double> torques = push;
    for (double& torque : torques) torque *= std::sin(0.05 * tick);
    drive(plain, torques, 1);
    drive(watched, torques, 1);
  }
  EXPECT_EQ(positions(plain), positions(watched));
  EXPECT_EQ(velocities(plain), velocities(watched));
  leave(plain, 400);
  EXPECT_EQ(plain.state(), ArmState::enabled) << "without a watchdog torques last";
}

/// On a joint without weight and friction: torques sent before a stop are discarded, torques sent
/// during it act after it.
template <class Make>
void expect_a_stop_to_forget_what_was_sent(const Make& make) {
  auto arm = make(watchdog);
  drive(arm, {1.0}, 40);
  leave(arm, 440);
  arm.enable();
  const std::vector<double> stands = positions(arm);
  leave(arm, 10);
  EXPECT_EQ(positions(arm), stands);
  arm.stop();
  arm.set_torques(std::vector{1.0});
  arm.enable();
  leave(arm, 10);
  EXPECT_GT(positions(arm)[0], stands[0]);
}

/// All of the above, except the last.
template <class Make>
void expect_a_sound_drive(const Make& make, const std::vector<double>& push) {
  expect_brakes_to_hold(make, push);
  expect_to_stop_until_enabled(make, push);
  expect_the_watchdog_to_stop(make, push);
  expect_a_fed_watchdog_to_change_nothing(make, push);
}

/// Start positions, far from the stops, and the torques that set the arms in motion.
inline std::vector<double> puma_start() {
  return {0.3, 0.8, -0.5, 0.4, 0.9, -0.2};
}
inline std::vector<double> puma_push() {
  return {20.0, 30.0, 5.0, 1.0, 1.0, 0.5};
}
inline std::vector<double> light_push() {
  return {2.0, 1.0, 1.0, 0.05, 0.05, 0.001};
}

}  // namespace repel::simulated
