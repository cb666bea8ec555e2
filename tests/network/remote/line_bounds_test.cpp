// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/line_bounds.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <repel/network/plan.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace line_bounds_test {

using test::period;

constexpr unsigned seed = 250;
constexpr double Z = 60.0, angular_Z = 0.5;
constexpr LineBounds tool{.speed = 0.25, .turning = 1.0, .force = 40.0, .torque = 2.0};

/// The end of a line of six entries, at a damper of so many times the impedance, or held.
struct End {
  LineImpedance impedance{Space::tool, 6, Z, angular_Z};
  WaveLimiter limiter{tool, impedance, Space::tool};
  Signals signals = detail::neutral_signals(6, period);
  State state;
  bool is_cut = false;

  End() {
    limiter.prepare(period);
    state.flow = state.effort = Vector::Zero(6);
  }
  /// One tick with a wave that arrives. @param damping times Z; below 0: held
  void step(Vector wave, double damping) {
    limiter.read(signals);
    const double came = wave.norm();
    is_cut = limiter.cut(wave);
    EXPECT_LE(wave.norm(), came * (1.0 + 1e-12));
    const Vector offset = impedance.offset_of(wave);
    for (Eigen::Index i = 0; i < 6; ++i) {
      const double R = impedance.diagonal()(i);
      state.flow(i) = damping < 0.0 ? 0.0 : -offset(i) / ((1.0 + damping) * R);
      state.effort(i) = offset(i) + R * state.flow(i);
    }
    limiter.note(state);
  }
};

TEST(WaveLimiter, AnEndThatOnlyDampersHoldIsDrivenNoFasterThanItsSpeed) {
  for (const double damping : {0.0, 1.0, 10.0}) {
    for (const double wave : {0.5, 2.0, 50.0, 1e3, 1e150}) {
      SCOPED_TRACE(std::to_string(damping) + " Z, wave " + std::to_string(wave));
      End end;
      double fastest = 0.0, turning = 0.0;
      for (int i = 0; i < 4000; ++i) {
        end.step(Vector::Constant(6, i % 1600 < 800 ? wave : -wave), damping);
        fastest = std::max(fastest, end.state.flow.head<3>().norm());
        turning = std::max(turning, end.state.flow.tail<3>().norm());
      }
      EXPECT_LE(fastest, tool.speed * 1.001);
      EXPECT_LE(turning, tool.turning * 1.001);
      if (damping <= 1.0 && wave >= 2.0) {
        EXPECT_GT(fastest, 0.99 * tool.speed);
      }
    }
  }
}

TEST(WaveLimiter, AHeldToolIsPushedNoHarderThanItsForce) {
  End end;
  for (int i = 0; i < 400; ++i) end.step(Vector::Constant(6, 1e3), -1.0);
  EXPECT_TRUE(end.is_cut);
  for (Eigen::Index i = 0; i < 6; ++i) {
    EXPECT_NEAR(-end.state.effort(i), i < 3 ? tool.force : tool.torque, 1e-9);
  }
}

// The waves of a hand that pushes with up to the force of its motors, or moves at up to the speed.
TEST(WaveLimiter, WhatASoundHandSendsIsLeftAsItIs) {
  End end;
  const double root = std::sqrt(Z), angular_root = std::sqrt(angular_Z);
  for (int i = 0; i < 4000; ++i) {
    const double swing = std::sin(0.01 * i);
    // A hand at 0.2 m/s, whose tool is free behind the shunt.
    Vector wave(6);
    wave.head<3>().setConstant(0.115 * swing * root);
    wave.tail<3>().setConstant(0.5 * swing * angular_root);
    end.step(wave, 1.0);
    EXPECT_FALSE(end.is_cut) << i;
  }
  // A hand that leans with 20 N along each axis.
  End held;
  for (int i = 0; i < 4000; ++i) {
    Vector wave = Vector::Zero(6);
    wave.head<3>().setConstant(20.0 * std::sin(0.01 * i) / (2.0 * root));
    held.step(wave, -1.0);
    EXPECT_FALSE(held.is_cut) << i;
  }
}

TEST(WaveLimiter, OfALeverTheBoundsFollowTheScaleOfTheHand) {
  const LineImpedance impedance(Space::lever, 1, 2.0, 0.5);
  // Of 10 N m, which drives a tool at 0.1 m/rad: 0.25 m/s are 2.5 rad/s.
  WaveLimiter limiter(
      {.speed = 0.25, .force = 120.0, .hand_force = 10.0, .motion_scale = 0.1, .force_scale = 0.1},
      impedance, Space::lever);
  limiter.prepare(period);
  Signals signals = detail::neutral_signals(6, period);
  limiter.read(signals);
  EXPECT_NEAR(limiter.most_power(), std::pow((10.0 + 2.0 * 2.5) / (2.0 * std::sqrt(2.0)), 2), 1e-9);
  signals.hand.scale = 0.1;
  for (int i = 0; i < 4000; ++i) limiter.read(signals);
  EXPECT_NEAR(limiter.most_power(), std::pow((1.2 + 2.0 * 25.0) / (2.0 * std::sqrt(2.0)), 2), 1e-3);
}

TEST(WaveLimiter, WithoutBoundsNothingIsCut) {
  const LineImpedance impedance(Space::tool, 6, Z, angular_Z);
  WaveLimiter limiter({}, impedance, Space::tool);
  limiter.prepare(period);
  families::Rng rng(seed);
  for (int i = 0; i < 100; ++i) {
    const Vector wave = test::drawn_vector(rng, 6, 1e5);
    Vector left = wave;
    EXPECT_FALSE(limiter.cut(left));
    EXPECT_EQ(left, wave);
  }
}

TEST(WaveLimiter, AnEndThatWasNotFiniteBeginsAnew) {
  End end;
  end.state.flow.setConstant(std::nan(""));
  end.limiter.note(end.state);
  Vector wave = Vector::Constant(6, 1e3);
  EXPECT_TRUE(end.limiter.cut(wave));
  EXPECT_TRUE(wave.allFinite());
}

}  // namespace line_bounds_test
}  // namespace repel::network
