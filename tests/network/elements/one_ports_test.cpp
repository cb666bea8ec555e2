// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/one_ports.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>

#include "network/drawn.hpp"
#include "network/waves.hpp"

namespace repel::network {
namespace one_ports_test {

using test::period;

constexpr unsigned seed = 51;

template <int N>
Mat<N> gain(Rng& rng, int size, double low, double high) {
  return test::drawn_gain(rng, size, low, high);
}
template <int N>
Vec<N> vec(Rng& rng, int size, double most) {
  return test::drawn_vector(rng, size, most);
}

/// Random waves into `element`; energy absorbed minus energy stored must be `dissipated(state)` in
/// each tick.
template <int N, class Element, class Loss>
void expect_balance(Element element, Rng& rng, int ticks, Loss loss) {
  if constexpr (requires { element.prepare(period); }) element.prepare(period);
  const int size = element.size();
  double energy = 0.0;
  double lost = 0.0;
  double passed = 0.0;
  for (int tick = 0; tick < ticks; ++tick) {
    const Vec<N> a = vec<N>(rng, size, 10.0);
    const Vec<N> b = element.reflected();
    const PortState<N> state = test::state_of<N>(a, b, element.resistance());
    element.incident(a);
    energy += period * state.power();
    passed += period * std::abs(state.power());
    lost += period * loss(state);
    ASSERT_NEAR(energy, element.stored() + lost, 1e-10 * (1e-3 + passed)) << "tick " << tick;
    ASSERT_GE(element.stored(), 0.0);
  }
  EXPECT_GT(passed, 1e-6);
}

template <int N>
void expect_balances(int size) {
  SCOPED_TRACE("size " + std::to_string(size) + ", seed " + std::to_string(seed));
  Rng rng(seed);
  const int ticks = families::draws(40000) / size;
  const auto none = [](const PortState<N>&) { return 0.0; };
  expect_balance<N>(Spring<N>(gain<N>(rng, size, 1.0, 1e4)), rng, ticks, none);
  expect_balance<N>(Mass<N>(gain<N>(rng, size, 1e-2, 10.0)), rng, ticks, none);
  const Mat<N> D = gain<N>(rng, size, 0.1, 100.0);
  expect_balance<N>(Damper<N>(D), rng, ticks,
                    [&](const PortState<N>& s) { return s.flow.dot(D.lazyProduct(s.flow)); });
}

TEST(OnePorts, HoldTheirEnergyExactlyInEveryTick) {
  expect_balances<1>(1);
  expect_balances<6>(6);
  expect_balances<any_size>(1);
  expect_balances<any_size>(7);
  expect_balances<any_size>(16);
}

// A load that kept its spring stretched through a fault would kick when the force returns.
TEST(OnePorts, LetGoOfWhatTheyHoldWhenTheForceIsGone) {
  Spring<6> spring(100.0 * Mat<6>::Identity());
  Mass<6> mass(2.0 * Mat<6>::Identity());
  const auto hold_then = [](auto& element, bool at_rest) {
    element.prepare(period);
    element.incident(Vec<6>::Ones());
    EXPECT_GT(element.stored(), 0.0);
    Signals signals;
    signals.at_rest = at_rest;
    element.read(signals);
    return element.stored();
  };
  EXPECT_EQ(hold_then(spring, true), 0.0);
  EXPECT_EQ(hold_then(mass, true), 0.0);
  EXPECT_GT(hold_then(spring, false), 0.0);
  EXPECT_GT(hold_then(mass, false), 0.0);
}

/// Effort and flow of the element, tick by tick, compared with the trapezoidal rule.
template <int N>
void expect_trapezoidal(int size) {
  Rng rng(seed);
  const Mat<N> K = gain<N>(rng, size, 1.0, 1e3);
  const Mat<N> M = gain<N>(rng, size, 0.1, 10.0);
  Spring<N> spring(K);
  Mass<N> mass(M);
  spring.prepare(period);
  mass.prepare(period);
  // At the end of each tick: force of the spring and velocity of the mass.
  Vec<N> force = Vec<N>::Zero(size);
  Vec<N> velocity = Vec<N>::Zero(size);
  for (int tick = 0; tick < 1000; ++tick) {
    const Vec<N> a = vec<N>(rng, size, 10.0);
    const PortState<N> at_spring = test::state_of<N>(a, spring.reflected(), spring.resistance());
    spring.incident(a);
    const Vec<N> next_force = force + period * K.lazyProduct(at_spring.flow);
    ASSERT_LE((at_spring.effort - 0.5 * (force + next_force)).norm(), 1e-7) << "tick " << tick;
    force = next_force;
    const PortState<N> at_mass = test::state_of<N>(a, mass.reflected(), mass.resistance());
    mass.incident(a);
    const Vec<N> next_velocity =
        velocity + period * M.partialPivLu().solve(Eigen::VectorXd(at_mass.effort));
    ASSERT_LE((at_mass.flow - 0.5 * (velocity + next_velocity)).norm(), 1e-9) << "tick " << tick;
    velocity = next_velocity;
    ASSERT_NEAR(spring.stored(), 0.5 * force.dot(K.partialPivLu().solve(Eigen::VectorXd(force))),
                1e-7 * (1.0 + spring.stored()));
    ASSERT_NEAR(mass.stored(), 0.5 * velocity.dot(M.lazyProduct(velocity)),
                1e-9 * (1.0 + mass.stored()));
  }
}

TEST(OnePorts, FollowTheTrapezoidalRule) {
  expect_trapezoidal<1>(1);
  expect_trapezoidal<6>(6);
  expect_trapezoidal<any_size>(5);
}

// The bilinear rule warps the frequency to 2 / T atan(w T / 2), and adds no damping.
TEST(OnePorts, MassAndSpringSwingAtTheFrequencyOfTheBilinearRule) {
  for (const double T : {1e-4, 1e-3, 1e-2, 3e-2}) {
    const double K = 400.0;
    const double M = 1.0;
    Spring<1> spring(Mat<1>::Constant(K));
    Mass<1> mass(Mat<1>::Constant(M));
    spring.prepare(T);
    mass.prepare(T);
    mass.incident(Vec<1>(2.0 * M / T));  // 1 m/s
    const double R = spring.resistance()(0) + mass.resistance()(0);
    int turns = 0;
    double first = 0.0;
    double last = 0.0;
    double before = 1.0;
    for (int tick = 0; tick < 200000; ++tick) {
      const double v = -(spring.reflected()(0) + mass.reflected()(0)) / R;
      spring.incident(Vec<1>(spring.reflected()(0) + 2.0 * spring.resistance()(0) * v));
      mass.incident(Vec<1>(mass.reflected()(0) + 2.0 * mass.resistance()(0) * v));
      if (before < 0.0 && v >= 0.0) {
        last = (tick - v / (v - before)) * T;
        if (turns++ == 0) first = last;
      }
      before = v;
    }
    const double omega = 2.0 / T * std::atan(0.5 * T * std::sqrt(K / M));
    ASSERT_GT(turns, 10);
    EXPECT_NEAR(2.0 * M_PI * (turns - 1) / (last - first), omega, 2e-4 * omega) << "period " << T;
    EXPECT_NEAR(spring.stored() + mass.stored(), 0.5 * M, 1e-9) << "period " << T;
  }
}

TEST(OnePorts, SourcesGiveTheirOwnWhateverTheOther) {
  const Vec<6> six = (Vec<6>() << 1, 2, 3, 4, 5, 6).finished();
  EffortSource<6> effort(Vec<6>::Zero());
  FlowSource<6> flow(Vec<6>::Zero());
  effort.set(six);
  flow.set(six);
  EXPECT_EQ(effort.size(), 6);
  EXPECT_EQ(flow.size(), 6);
  Equivalent<6> shown;
  PortState<6> state;
  effort.equivalent(shown);
  ASSERT_EQ(shown.form, Form::impedance);
  shown.at_flow(Vec<6>::Constant(9.0), state);
  EXPECT_EQ(state.effort, -six);  // it pushes the rest with +six
  flow.equivalent(shown);
  ASSERT_EQ(shown.form, Form::admittance);
  shown.at_effort(Vec<6>::Constant(9.0), state);
  EXPECT_EQ(state.flow, six);
}

TEST(OnePorts, TheGroundStaysWhereItIs) {
  const Ground ground;
  EXPECT_EQ(ground.size(), 6);
  Equivalent<any_size> shown;
  ground.equivalent(shown);
  ASSERT_EQ(shown.form, Form::admittance);
  PortState<any_size> state;
  shown.at_effort(Vec<any_size>::Constant(6, 1e6), state);
  EXPECT_EQ(state.flow, Vec<any_size>::Zero(6));
  EXPECT_THROW(Ground(0), SetupError);
  EXPECT_THROW(Ground(most_joints + 1), SetupError);
}

TEST(OnePorts, RefuseAGainThatCouldGiveEnergy) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Mat<6> one = Mat<6>::Identity();
  Mat<6> skew = one;
  skew(0, 1) = 0.5;
  Mat<6> spoilt = one;
  spoilt(2, 2) = nan;
  Mat<6> indefinite = one;
  indefinite(3, 3) = -1.0;
  for (const Mat<6>& bad : {skew, spoilt, indefinite, Mat<6>(0.0 * one)}) {
    EXPECT_THROW(Spring<6>{bad}, SetupError);
    EXPECT_THROW(Mass<6>{bad}, SetupError);
    EXPECT_THROW(Damper<6>{bad}, SetupError);
  }
  EXPECT_THROW(Spring<any_size>(Mat<any_size>(2, 3)), SetupError);
  EXPECT_THROW(Mass<any_size>(Mat<any_size>(0, 0)), SetupError);
  for (const double period_of : {0.0, -1.0, nan, 1e-10, 4000.0}) {
    EXPECT_THROW(Spring<1>(Mat<1>::Ones()).prepare(period_of), SetupError);
    EXPECT_THROW(Mass<1>(Mat<1>::Ones()).prepare(period_of), SetupError);
  }
}

}  // namespace one_ports_test
}  // namespace repel::network
