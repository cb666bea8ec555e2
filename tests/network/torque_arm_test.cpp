#include <repel/network/torque_arm.hpp>

#include <gtest/gtest.h>

#include "support/families.hpp"

namespace repel::network {
namespace {

constexpr double period = 0.0025;
constexpr unsigned seed = 1;

// The port of the motor: with the hand still, no more energy comes out than went in. The power is
// that of the torque over the period in which it acted.
TEST(TorqueArm, IsPassiveSeenFromTheMotor) {
  families::Rng random(seed);
  for (int run = 0; run < 200; ++run) {
    TorqueArmOptions options;
    options.inertia = families::log_uniform(random, 1e-3, 0.1);
    options.friction = families::log_uniform(random, 1e-3, 1.0);
    options.hand_stiffness = families::log_uniform(random, 0.1, 100.0);
    options.hand_damping = families::log_uniform(random, 1e-3, 5.0);
    TorqueArm lever(options);
    double energy = 0.0;
    double torque = 0.0;
    double scale = 0.0;
    for (int tick = 0; tick < 2000; ++tick) {
      // A torque that changes its mind, at times with the sign of the rate to draw energy out.
      if (tick % 17 == 0) torque = families::uniform(random, -8.0, 8.0);
      const double applied = tick % 3 == 0 && lever.rate() != 0.0
                                 ? -std::copysign(std::abs(torque), lever.rate())
                                 : torque;
      energy += period * applied * lever.step(0.0, applied, period);
      scale += period * std::abs(applied * lever.rate());
      ASSERT_GE(energy, -1e-9 * (1.0 + scale))
          << "tick " << tick << ", run " << run << ", seed " << seed;
    }
  }
}

TEST(TorqueArm, StaysStableAtAnyDamping) {
  for (const double damping : {0.0, 1.0, 1e3, 1e6}) {
    for (const double inertia : {1e-6, 1e-2, 10.0}) {
      const TorqueArmOptions options{
          .inertia = inertia, .friction = damping, .hand_stiffness = 0.0, .hand_damping = damping};
      TorqueArm lever(options);
      (void)lever.step(0.0, 5.0, period);
      const double kicked = std::abs(lever.rate());
      for (int tick = 0; tick < 1000; ++tick) {
        ASSERT_LE(std::abs(lever.step(0.0, 0.0, period)), kicked * (1.0 + 1e-12))
            << "damping " << damping << ", inertia " << inertia;
      }
    }
  }
}

TEST(TorqueArm, StaysStableAtAnyGainOfTheHand) {
  for (const double stiffness : {0.0, 20.0, 1e3, 1e5}) {
    for (const double inertia : {1e-6, 1e-3, 0.01, 1.0}) {
      for (const double T : {0.001, 0.0025, 0.01}) {
        const TorqueArmOptions options{.inertia = inertia, .hand_stiffness = stiffness};
        TorqueArm lever(options);
        for (int tick = 0; tick < 200; ++tick) (void)lever.step(0.5, 2.0, T);
        double largest = 0.0;
        for (int tick = 0; tick < 4000; ++tick) {
          largest = std::max(largest, std::abs(lever.step(0.0, 0.0, T)));
        }
        ASSERT_LT(largest, 1e4) << "stiffness " << stiffness << ", inertia " << inertia
                                << ", period " << T;
      }
    }
  }
}

TEST(TorqueArm, MotorGivesNoMoreThanItsLimit) {
  TorqueArm limited{TorqueArmOptions{.torque_limit = 3.0}};
  TorqueArm exact{TorqueArmOptions{.torque_limit = 3.0}};
  for (int tick = 0; tick < 100; ++tick) {
    EXPECT_EQ(limited.step(0.2, -1e6, period), exact.step(0.2, -3.0, period));
    EXPECT_EQ(limited.felt(), -3.0);
  }
}

TEST(TorqueArm, FollowsTheHandAndYieldsToTheMotor) {
  TorqueArm lever{TorqueArmOptions{}};
  for (int tick = 0; tick < 4000; ++tick) (void)lever.step(0.5, 0.0, period);
  EXPECT_NEAR(lever.rate(), 0.5, 1e-6);
  const double free_angle = lever.angle();
  lever.reset();
  EXPECT_EQ(lever.angle(), 0.0);
  for (int tick = 0; tick < 4000; ++tick) (void)lever.step(0.5, -2.0, period);
  EXPECT_NEAR(lever.rate(), 0.5, 1e-6);
  EXPECT_NEAR(free_angle - lever.angle(), 2.0 / 20.0, 1e-6);  // pushed back by torque / stiffness
}

}  // namespace
}  // namespace repel::network
