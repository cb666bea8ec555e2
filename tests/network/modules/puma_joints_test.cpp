// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/puma_joints.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace puma_joints_test {

using test::period;

constexpr unsigned seed = 61;

/// Joints that move for a minute, with rates corrupted by a bias and noise.
struct Tracked {
  double most = 0.0;       ///< [rad] largest deviation of the integral from the position, after 1 s
  double most_rate = 0.0;  ///< [rad/s] largest deviation of the flow from the true rate
  double turns = 0.0;      ///< [rad] total motion of the joint
};
Tracked track(double bias, double noise, unsigned of_seed, double T = period) {
  Rng rng(of_seed);
  MeasuredFlow measured(2);
  Vector q = Vector::Constant(2, 0.7);
  measured.reset(q);
  Vector integral = q;
  Vector last = measured.flow();
  Tracked result;
  for (int tick = 1; tick * T < 60.0; ++tick) {
    Vector rate(2);
    rate << 0.8 * std::sin(1.3 * tick * T), 0.5;
    q += T * rate;
    measured.step(q, rate + Vector::Constant(2, bias) + test::drawn_vector(rng, 2, noise), T);
    integral += 0.5 * T * (last + measured.flow());
    last = measured.flow();
    EXPECT_LE((measured.mean() - rate).norm(), 1e-9);
    result.turns = std::max(result.turns, std::abs(q(1)));
    if (tick * T < 1.0) continue;
    result.most = std::max(result.most, (integral - q).cwiseAbs().maxCoeff());
    result.most_rate = std::max(result.most_rate, (measured.flow() - rate).cwiseAbs().maxCoeff());
  }
  return result;
}

TEST(MeasuredFlow, IntegralStaysAtTheMeasuredPositionWhateverTheRateSays) {
  const Tracked exact = track(0.0, 0.0, seed);
  EXPECT_GT(exact.turns, 20.0);
  EXPECT_LE(exact.most, 1e-3);
  // The remaining error is half the trim time multiplied by the bias, at any rate.
  for (const double bias : {0.05, -0.2, 1.0}) {
    const Tracked biased = track(bias, 0.0, seed);
    EXPECT_LE(biased.most, exact.most + 5.5 * period * std::abs(bias)) << bias;
    EXPECT_GE(biased.most, 4.0 * period * std::abs(bias)) << bias;
    EXPECT_LE(biased.most_rate, 0.02 + 0.1 * std::abs(bias)) << bias;
    EXPECT_NEAR(track(bias, 0.0, seed, period / 10.0).most, biased.most, 0.2 * biased.most) << bias;
  }
  EXPECT_LE(track(0.1, 0.5, seed).most, 10.0 * period * 0.6) << "seed " << seed;
}

TEST(MeasuredFlow, TrueRateOfAnEvenMotionIsLeftAlone) {
  MeasuredFlow measured(1);
  Vector q = Vector::Zero(1);
  measured.reset(q);
  for (int tick = 0; tick < 1000; ++tick) {
    q(0) += period * 0.3;
    measured.step(q, Vector::Constant(1, 0.3), period);
  }
  EXPECT_NEAR(measured.flow()(0), 0.3, 1e-9);
  measured.reset(q);
  EXPECT_EQ(measured.flow()(0), 0.0);
  EXPECT_EQ(measured.mean()(0), 0.0);
  measured.step(q, Vector::Zero(1), period);
  EXPECT_EQ(measured.flow()(0), 0.0);
}

Signals moving(const Vector& rates, const Vector& mean_rates) {
  Signals signals;
  signals.joints = Vector::Zero(rates.size());
  signals.rates = rates;
  signals.mean_rates = mean_rates;
  signals.period = period;
  return signals;
}

TEST(PumaJoints, DecideTheirFlowAndTakeTheTorques) {
  Rng rng(seed);
  PumaJoints arm(3);
  EXPECT_EQ(arm.size(), 3);
  EXPECT_FALSE(PumaJoints::traits.passive);
  EXPECT_TRUE(PumaJoints::traits.measures_flow);
  const Vector rates = test::drawn_vector(rng, 3, 1.0);
  const Vector torques = test::drawn_vector(rng, 3, 5.0);
  arm.read(moving(rates, rates));
  Equivalent<any_size> shown;
  arm.equivalent(shown);
  PortState<any_size> state;
  ASSERT_EQ(shown.form, Form::admittance);
  shown.at_effort(torques, state);
  EXPECT_EQ(state.flow, rates);
  arm.incident(state);
  EXPECT_EQ(arm.torques(), torques);
}

// sum T tau(k) . (mean flow of the period after k - flow at k)
TEST(PumaJoints, ReportTheEnergyThatHoldingATorqueGives) {
  Rng rng(seed);
  PumaJoints arm(4);
  double energy = 0.0;
  Vector torques = Vector::Zero(4);
  Vector flow = Vector::Zero(4);
  for (int tick = 0; tick < families::draws(100000); ++tick) {
    const Vector mean = test::drawn_vector(rng, 4, 1.0);
    energy += period * torques.dot(mean - flow);
    flow = test::drawn_vector(rng, 4, 1.0);
    arm.read(moving(flow, mean));
    torques = test::drawn_vector(rng, 4, 5.0);
    arm.incident({torques, flow});
    ASSERT_NEAR(arm.sampling_energy(), energy, 1e-9 * (1.0 + std::abs(energy))) << "seed " << seed;
  }
}

// A stop asked 475 N m of a light wrist, got 0.3 of it, and 4 J by sampling were read off the rest.
TEST(PumaJoints, TorqueThatWasHeldBackGivesNoEnergy) {
  PumaJoints arm(3);
  Signals signals = moving(Vector::Zero(3), Vector::Zero(3));
  arm.read(signals);
  arm.incident({Vector::Constant(3, 475.0), Vector::Zero(3)});
  signals = moving(Vector::Ones(3), Vector::Ones(3));
  signals.sent = Vector::Zero(3);
  signals.sent << 0.3, -0.3, 500.0;
  arm.read(signals);
  EXPECT_NEAR(arm.sampling_energy(), period * (0.3 + 0.0 + 475.0), 1e-9);
}

TEST(PumaJoints, RefuseNoJointsAndTooMany) {
  EXPECT_THROW(PumaJoints(0), SetupError);
  EXPECT_THROW(PumaJoints(most_joints + 1), SetupError);
  EXPECT_NO_THROW(PumaJoints{most_joints});
}

}  // namespace puma_joints_test
}  // namespace repel::network
