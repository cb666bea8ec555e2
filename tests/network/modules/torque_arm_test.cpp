// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/torque_arm.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <repel/network/machinery/ledger.hpp>
#include "network/drawn.hpp"

namespace repel::network {
namespace torque_arm_test {

using test::period;

constexpr unsigned seed = 5;

/// A lever with a load at its motor.
struct Bench {
  explicit Bench(const TorqueArmOptions& options, double at = period) : lever(options), T(at) {
    lever.prepare(T);
  }
  /// One tick: the hand moves at `hand`, the load at the motor is f = `b` + `R` v.
  void tick(double hand, double R, double b) {
    Signals signals;
    signals.hand.lever_rate = hand;
    lever.read(signals);
    const double own = lever.resistance()(0);
    const double reflected = lever.reflected()(0);
    const double flow = -(b + reflected) / (R + own);
    port = {Vec<1>(reflected + own * flow), Vec<1>(flow)};
    lever.incident(port.incident(lever.resistance()));
    const double in = port.power();
    ledger.add(T * in, T * std::abs(in), T * lever.supplied());
  }
  /// The motor exerts `torque`.
  void push(double hand, double torque) { tick(hand, 0.0, -torque); }

  TorqueArm lever;
  double T;
  PortState<1> port;
  Ledger ledger;
};

TEST(TorqueArm, GivesNoMoreThanItTookAndTheHandSupplied) {
  for (const double limit : {0.0, 0.5, 10.0}) {
    for (const TorqueArmOptions& options :
         {TorqueArmOptions{.torque_limit = limit},
          {.inertia = 1e-6, .friction = 0.0, .hand_damping = 0.0, .torque_limit = limit},
          {.inertia = 1.0, .hand_stiffness = 1e5, .torque_limit = limit}}) {
      Rng rng(seed);
      Bench bench(options);
      const int ticks = families::draws(1000000) / 9;
      int saturated = 0;
      for (int tick = 0; tick < ticks; ++tick) {
        const double R = tick % 5 == 0 ? 0.0 : families::log_uniform(rng, 1e-3, 1e3);
        bench.tick(families::uniform(rng, -2.0, 2.0), R, families::uniform(rng, -3.0, 3.0));
        saturated += bench.lever.saturated() ? 1 : 0;
        if (!bench.lever.saturated()) {
          ASSERT_NEAR(bench.lever.felt(), bench.port.effort(0),
                      1e-9 * (1.0 + std::abs(bench.port.effort(0))));
        }
        ASSERT_LE(std::abs(bench.lever.felt()),
                  limit + 1e-9 * (1.0 + std::abs(bench.port.effort(0))));
      }
      EXPECT_GT(bench.ledger.passed, 1e-3);
      EXPECT_LE(bench.ledger.deficit(), 1e-9)
          << "limit " << limit << ", inertia " << options.inertia << ", seed " << seed;
      if (limit < 1.0) {
        EXPECT_GT(saturated, ticks / 100);
      }
    }
  }
}

// It once gave more than its limit where the hand overpowered it, so that saturation dissipated.
TEST(TorqueArm, MotorStaysWithinItsLimitAlsoWhereTheHandOverpowersIt) {
  Rng rng(seed);
  TorqueArm lever({.torque_limit = 1.0});
  lever.prepare(period);
  Signals signals;
  int saturated = 0;
  int overpowered = 0;
  for (int tick = 0; tick < families::draws(100000); ++tick) {
    signals.hand.lever_rate = families::uniform(rng, -2.0, 2.0);
    lever.read(signals);
    const double a = families::uniform(rng, -6.0, 6.0);
    const double b = lever.reflected()(0);
    lever.incident(Vec<1>(a));
    const double taken = 2.0 * lever.felt() - b;
    ASSERT_EQ(lever.saturated(), std::abs(a + b) > 2.0);
    if (!lever.saturated()) {
      ASSERT_NEAR(taken, a, 1e-12 * (1.0 + std::abs(b)));
      continue;
    }
    ++saturated;
    overpowered += std::abs(taken) > std::abs(a) ? 1 : 0;
    ASSERT_NEAR(std::abs(lever.felt()), 1.0, 1e-12 * (1.0 + std::abs(b)));
    ASSERT_GE(lever.felt() * (a + b), 0.0) << "reversed at tick " << tick << ", seed " << seed;
  }
  EXPECT_GT(saturated, families::draws(10000));
  EXPECT_GT(overpowered, families::draws(1000));
}

TEST(TorqueArm, FollowsTheHandAndYieldsByTorqueOverStiffness) {
  for (const double torque : {0.0, 2.0, -3.0}) {
    Bench bench(TorqueArmOptions{.hand_stiffness = 20.0});
    for (int tick = 0; tick < 4000; ++tick) bench.push(0.5, torque);
    EXPECT_NEAR(bench.lever.rate(), 0.5, 1e-6);
    EXPECT_NEAR(bench.lever.felt(), torque, 1e-9);
    Bench free(TorqueArmOptions{.hand_stiffness = 20.0});
    for (int tick = 0; tick < 4000; ++tick) free.push(0.5, 0.0);
    EXPECT_NEAR(bench.lever.angle() - free.lever.angle(), torque / 20.0, 1e-6);
  }
}

TEST(TorqueArm, HandIsASourceOfWhatFrictionTakes) {
  Bench bench(TorqueArmOptions{.friction = 0.05});
  for (int tick = 0; tick < 4000; ++tick) bench.push(0.5, 0.0);
  EXPECT_NEAR(bench.lever.supplied(), 0.05 * 0.5 * 0.5, 1e-6);
}

TEST(TorqueArm, SettlesAtAnyGainPeriodAndInertia) {
  for (const double stiffness : {0.0, 20.0, 1e3, 1e5}) {
    for (const double inertia : {1e-6, 1e-3, 0.01, 1.0}) {
      for (const double T : {0.001, 0.0025, 0.01}) {
        SCOPED_TRACE("stiffness " + std::to_string(stiffness) + ", inertia " +
                     std::to_string(inertia) + ", period " + std::to_string(T));
        Bench bench({.inertia = inertia, .hand_stiffness = stiffness}, T);
        for (int tick = 0; tick < 200; ++tick) bench.push(0.5, 2.0);
        const double scale = 2.0 + 0.5 * (stiffness * 200 * T + 0.6);
        for (int tick = 0; tick < 4000; ++tick) {
          bench.push(0.0, 0.0);
          ASSERT_LE(std::abs(bench.lever.rate()), 10.0 * scale / std::min(1.0, inertia / T));
        }
        EXPECT_LE(bench.ledger.deficit(), 1e-9);
      }
    }
  }
}

TEST(TorqueArm, LetsGoAtRest) {
  Bench bench(TorqueArmOptions{});
  for (int tick = 0; tick < 100; ++tick) bench.push(0.5, 1.0);
  Signals rest;
  rest.at_rest = true;
  bench.lever.read(rest);
  EXPECT_EQ(bench.lever.reflected()(0), 0.0);
  EXPECT_EQ(bench.lever.rate(), 0.0);
}

TEST(TorqueArm, RefusesNumbersOutOfRange) {
  EXPECT_THROW(TorqueArm({.inertia = 0.0}), SetupError);
  EXPECT_THROW(TorqueArm({.friction = -1.0}), SetupError);
  EXPECT_THROW(TorqueArm({.hand_stiffness = std::nan("")}), SetupError);
  EXPECT_THROW(TorqueArm({.hand_damping = -1.0}), SetupError);
  EXPECT_THROW(TorqueArm({.torque_limit = -1.0}), SetupError);
  EXPECT_THROW(TorqueArm().prepare(0.0), SetupError);
}

}  // namespace torque_arm_test
}  // namespace repel::network
