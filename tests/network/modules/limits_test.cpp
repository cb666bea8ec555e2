// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/limits.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace limits_test {

using test::period;

constexpr unsigned seed = 12;

TEST(JointLimits, FreeBetweenTheRangesWhateverTheRate) {
  const JointLimits limits;
  for (const double v : {-10.0, 0.0, 10.0}) {
    EXPECT_EQ(limits(0.0, v, -1.0, 1.0), 0.0);
    EXPECT_EQ(limits(0.9, v, -1.0, 1.0), 0.0);
    EXPECT_EQ(limits(-0.9, v, -1.0, 1.0), 0.0);
  }
}

TEST(JointLimits, OnlyEverPushInward) {
  Rng rng(seed);
  int pushed = 0;
  for (int i = 0; i < 20000; ++i) {
    const JointLimits limits{.range = families::uniform(rng, 0.01, 0.3)};
    const double q = families::uniform(rng, -1.5, 1.5);
    const double torque = limits(q, families::uniform(rng, -5.0, 5.0), -1.0, 1.0);
    if (q > 0.0) {
      ASSERT_LE(torque, 0.0) << "seed " << seed;
    }
    if (q < 0.0) {
      ASSERT_GE(torque, 0.0) << "seed " << seed;
    }
    pushed += torque != 0.0 ? 1 : 0;
  }
  EXPECT_GT(pushed, 5000);
}

TEST(JointLimits, BeginAtZeroAndRiseWithTheSpring) {
  const JointLimits limits{.range = 0.1, .stiffness = 200.0, .damping = 10.0};
  EXPECT_NEAR(limits(0.9 + 1e-9, 0.0, -1.0, 1.0), 0.0, 1e-6);
  EXPECT_NEAR(limits(0.95, 0.0, -1.0, 1.0), -10.0, 1e-9);
  EXPECT_NEAR(limits(-1.0, 0.0, -1.0, 1.0), 20.0, 1e-9);
  EXPECT_NEAR(limits(1.05, 0.0, -1.0, 1.0), -30.0, 1e-9);
  EXPECT_NEAR(limits(0.95, 0.5, -1.0, 1.0), -15.0, 1e-9);  // moving outward: damped
  EXPECT_NEAR(limits(0.95, -2.0, -1.0, 1.0), 0.0, 1e-9);   // moving back: never resisted
}

/// Joints that move arbitrarily through their ranges, with inaccurate rates.
class Swinging {
 public:
  explicit Swinging(Rng& rng) : rng_(rng) {
    signals.joints = signals.rates = signals.mean_rates = Vector::Zero(2);
    signals.period = period;
  }
  const Signals& next() {
    const Vector last = signals.joints;
    signals.rates += test::drawn_vector(rng_, 2, 0.3) - 0.02 * signals.joints;
    signals.rates *= 0.999;
    signals.joints += period * (signals.rates + test::drawn_vector(rng_, 2, 0.5));
    signals.mean_rates = (signals.joints - last) / period;
    return signals;
  }
  Signals signals;

 private:
  Rng& rng_;
};

TEST(Limits, PushInwardOnlyAndGiveNoMoreThanTheyTook) {
  for (const Side root : {Side::left, Side::right}) {
    SCOPED_TRACE(std::string(test::to_text(root)) + ", seed " + std::to_string(seed));
    Rng rng(seed);
    Swinging arm(rng);
    DrawnEnds ends(rng, 2, 5.0);
    Cell cell(Limits({.range = 0.2}, {{-0.6, 0.6}, {-0.5, 0.7}}), root);
    const int ticks = families::draws(1000000) / 2;
    int pushed = 0;
    for (int tick = 0; tick < ticks; ++tick) {
      const Signals& signals = arm.next();
      Equivalent<any_size> measured;
      measured.set_admittance(test::Matrix::Zero(2, 2), signals.rates);
      Equivalent<any_size> none;
      none.set_impedance(test::Matrix::Zero(2, 2), Vector::Zero(2));
      ASSERT_TRUE(cell.run(signals, tick % 2 == 0 ? none : ends.definite(), measured));
      ASSERT_EQ(cell.at_root.flow, cell.at_leaf.flow);
      if (tick % 2 != 0) continue;  // with no load behind, the torque is that of the limits alone
      const Vector torque = -cell.at_root.effort;
      for (int i = 0; i < 2; ++i) {
        const bool near_end =
            signals.joints(i) > (i == 0 ? 0.4 : 0.5) || signals.joints(i) < (i == 0 ? -0.4 : -0.3);
        if (near_end) {
          ASSERT_LE(torque(i) * (signals.joints(i) - 0.05), 1e-9) << "tick " << tick;
        } else {
          ASSERT_EQ(torque(i), 0.0) << "tick " << tick;
        }
        pushed += torque(i) != 0.0 ? 1 : 0;
      }
    }
    EXPECT_GT(pushed, ticks / 50);
    EXPECT_LT(pushed, ticks);
    EXPECT_GT(cell.module.passivity().dissipated, 0.0);
    EXPECT_LE(cell.ledger.deficit(), 1e-9);
  }
}

TEST(Limits, SayWhenTheyAreFelt) {
  Limits limits({.range = 0.1}, {{-1.0, 1.0}});
  Signals signals;
  signals.joints = signals.rates = signals.mean_rates = Vector::Zero(1);
  limits.read(signals);
  EXPECT_FALSE(limits.active());
  signals.joints(0) = 0.95;
  limits.read(signals);
  EXPECT_TRUE(limits.active());
  EXPECT_NEAR(limits.most_torque(0), 0.05 * JointLimits{}.stiffness, 1e-9);
  signals.joints(0) = 0.0;
  limits.read(signals);
  EXPECT_FALSE(limits.active());
  EXPECT_NEAR(limits.most_torque(0), 0.05 * JointLimits{}.stiffness, 1e-9) << "the most of all";
  EXPECT_EQ(limits.size(), 1);
}

TEST(Limits, BeginWhereTheirOwnJointSays) {
  Limits limits({.range = 0.1, .stiffness = 100.0, .damping = 0.0},
                {{-1.0, 1.0}, {-1.0, 1.0, 0.3}, {-1.0, 1.0, 0.02}});
  Signals signals;
  signals.rates = signals.mean_rates = Vector::Zero(3);
  signals.joints = Vector::Constant(3, 0.95);
  limits.read(signals);
  EXPECT_NEAR(limits.torques()(0), -5.0, 1e-12);
  EXPECT_NEAR(limits.torques()(1), -25.0, 1e-12);
  EXPECT_EQ(limits.torques()(2), 0.0);
  EXPECT_THROW(Limits({}, {{-1.0, 1.0, 0.0}}), SetupError);
  EXPECT_THROW(Limits({}, {{-1.0, 1.0, std::nan("")}}), SetupError);
}

TEST(Limits, RefuseARangeThatEndsBeforeItBegins) {
  EXPECT_THROW(Limits({}, {{1.0, -1.0}}), SetupError);
  EXPECT_THROW(Limits({}, {}), SetupError);
  EXPECT_THROW(Limits({}, std::vector<JointRange>(17, {-1.0, 1.0})), SetupError);
  EXPECT_THROW(Limits({.range = 0.0}, {{-1.0, 1.0}}), SetupError);
  EXPECT_THROW(Limits({.stiffness = -1.0}, {{-1.0, 1.0}}), SetupError);
  EXPECT_THROW(Limits({.damping = std::nan("")}, {{-1.0, 1.0}}), SetupError);
  EXPECT_THROW(Limits({}, {{-1.0, std::nan("")}}), SetupError);
  EXPECT_THROW(Limits({}, {{std::nan(""), 1.0}}), SetupError);
}

TEST(Limits, LeaveAJointAloneThatTurnsWithoutEnd) {
  const double never = std::numeric_limits<double>::infinity();
  Limits limits({}, {{-never, never}, {-1.0, never}});
  Signals signals;
  signals.rates = signals.mean_rates = Vector::Zero(2);
  signals.joints = Vector::Constant(2, 1000.0);
  limits.read(signals);
  EXPECT_EQ(limits.torques(), Vector::Zero(2));
  signals.joints(1) = -1.0;
  limits.read(signals);
  EXPECT_EQ(limits.torques()(0), 0.0);
  EXPECT_GT(limits.torques()(1), 0.0);
}

}  // namespace limits_test
}  // namespace repel::network
