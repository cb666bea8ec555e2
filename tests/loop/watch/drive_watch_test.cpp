// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/drive_watch.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "loop/slider.hpp"

namespace repel {
namespace drive_watch_test {

constexpr double T = 0.0025;
constexpr int begun = 1000;  // tick of the fault

struct Case {
  double mass = 5.0;          // [kg] of the true slider; the model has 5
  double viscous = 20.0;      // [N s/m]; the model has 20
  double dry = 0.0;           // [N]; the model has none
  double payload = 0.0;       // [N]
  double noise = 0.0;         // [m/s] of the rates
  double push = 0.0;          // [N] of somebody, from the fault on
  double gain = 1.0;          // of the drive, from the fault on
  int told = 0;               // [ticks] of the drive
  int late = 0;               // [ticks] more, from the fault on
  double stiffness = 5000.0;  // [N/m] of the loop
};

/// Ticks from the fault on until it is found in a slider that a spring and a damper move to and
/// fro; -1: never.
int found_after(const Case& now) {
  const ArmModel model = test::slider_model(1000.0);
  const JointWatchOptions options;
  DriveWatch watch(model, now.told);
  const ArmInertia::Matrix M = 5.0 * ArmInertia::Matrix::Identity(3, 3);
  const std::vector<double> weight(3, 0.0);
  std::deque<double> sent(20, 0.0);
  std::vector<double> last(3, 0.0), v(3, 0.0);
  double q = 0.0, rate = 0.0, wave = now.noise;
  for (int tick = 0; tick < 4000; ++tick) {
    v[0] = rate + (wave = -wave);
    watch.step(last, v, M, T, options);
    last = v;
    if (watch.strays()) return tick - begun;
    const double goal = 0.05 * std::sin(3.0 * tick * T);
    DriveWatch::Vector net = DriveWatch::Vector::Zero(3);
    net(0) = std::clamp(now.stiffness * (goal - q) - 150.0 * v[0], -400.0, 400.0);
    watch.note_sent(net, weight);
    sent.push_front(net(0));
    sent.pop_back();
    const bool is_faulty = tick >= begun;
    const auto late = static_cast<std::size_t>(now.told + (is_faulty ? now.late : 0));
    const double force = (is_faulty ? now.gain : 1.0) * sent[late] + (is_faulty ? now.push : 0.0);
    const double driven = rate + T * (force - now.payload) / now.mass;
    const double left = std::max(0.0, std::abs(driven) - T * now.dry / now.mass);
    rate = std::copysign(left, driven) / (1.0 + T * now.viscous / now.mass);
    q += T * rate;
  }
  return -1;
}

TEST(DriveWatch, FindsNothingInAnArmThatFollowsItsTorques) {
  EXPECT_EQ(found_after({}), -1);
  EXPECT_EQ(found_after({.mass = 3.0}), -1);
  EXPECT_EQ(found_after({.mass = 8.5}), -1);
  EXPECT_EQ(found_after({.viscous = 10.0}), -1);
  EXPECT_EQ(found_after({.viscous = 40.0}), -1);
  EXPECT_EQ(found_after({.dry = 5.0}), -1);
  EXPECT_EQ(found_after({.payload = 40.0}), -1);
  EXPECT_EQ(found_after({.noise = 0.02}), -1);
  EXPECT_EQ(found_after({.told = 3}), -1);
  EXPECT_EQ(found_after({.mass = 8.5, .viscous = 40.0, .stiffness = 20000.0}), -1);
  EXPECT_EQ(found_after({.late = 1}), -1) << "as good as told";
  EXPECT_EQ(found_after({.gain = 0.6}), -1) << "within the uncertainty of masses";
}

TEST(DriveWatch, ADriveThatIsTurnedRoundIsFound) {
  const int ticks = found_after({.gain = -1.0});
  EXPECT_GE(ticks, 0);
  EXPECT_LE(ticks, 40);
  EXPECT_GE(found_after({.gain = -1.0, .told = 2}), 0);
}

// A dead shoulder drive let the tool fall 100 mm through a hard wall.
TEST(DriveWatch, ADeadDriveIsFound) {
  const int ticks = found_after({.gain = 0.0});
  EXPECT_GE(ticks, 0);
  EXPECT_LE(ticks, 100);
}

// One that is late by two ticks more than told went 1.5 mm into a hard wall, by five 8 mm.
TEST(DriveWatch, ADriveThatIsLaterThanToldIsFound) {
  for (const int told : {0, 2}) {
    for (const int late : {4, 8}) {
      const int ticks = found_after({.told = told, .late = late, .stiffness = 20000.0});
      EXPECT_GE(ticks, 0) << told << ", " << late;
    }
  }
}

// A wrist of 1e-4 kg m^2 on a forearm that turned: what the turning added to it was taken for the
// work of a drive that runs the wrong way, and sound readings were not believed.
TEST(DriveWatch, WhatTurningAddsToALightJointIsNoFault) {
  constexpr double inertia = 1e-4;
  ArmModel model = test::slider_model(1000.0);
  for (ArmLink& link : model.links) link.viscous_friction = 0.0;
  DriveWatch watch(model, 0.0);
  ArmInertia::Matrix M = 5.0 * ArmInertia::Matrix::Identity(3, 3);
  M(2, 2) = M(1, 2) = M(2, 1) = inertia;
  const std::vector<double> weight(3, 0.0);
  std::vector<double> last(3, 0.0);
  for (int tick = 0; tick < 4000; ++tick) {
    const double t = tick * T;
    const std::vector<double> v{0.0, 4.0, 4.0 + 0.2 * std::sin(40.0 * t)};
    watch.step(last, v, M, T, {});
    ASSERT_FALSE(watch.strays()) << "tick " << tick;
    last = v;
    DriveWatch::Vector net = DriveWatch::Vector::Zero(3);
    net(2) = -inertia * 8.0 * std::cos(40.0 * t);  // against the acceleration
    watch.note_sent(net, weight);
  }
}

TEST(DriveWatch, APersonWhoPushesIsNoFault) {
  for (const double push : {-200.0, 30.0, 200.0}) {
    EXPECT_EQ(found_after({.push = push}), -1) << push;
  }
}

}  // namespace drive_watch_test
}  // namespace repel
