#include <repel/network/module.hpp>

#include <gtest/gtest.h>

#include "network/drawn.hpp"

namespace repel::network {
namespace module_test {

using test::Matrix;
using test::period;
using test::Rng;
using test::Vector;

constexpr unsigned seed = 37;

template <class M>
constexpr int kinds = (detail::is_two_port<M> ? 1 : 0) + (detail::is_one_port<M> ? 1 : 0) +
                      (detail::is_junction<M> ? 1 : 0) + (detail::is_line<M> ? 1 : 0);

template <class... M>
constexpr bool each_is_of_one_kind(const std::variant<M...>* /*list*/) {
  return ((kinds<M> == 1) && ...);
}
static_assert(each_is_of_one_kind(static_cast<const Module*>(nullptr)));
static_assert(detail::is_two_port<Multiplex> && detail::is_two_port<Limits>);
static_assert(detail::is_one_port<TorqueArm> && detail::is_one_port<PumaJoints>);
static_assert(detail::is_one_port<Spring<any_size>> && detail::is_source<FlowSource<any_size>>);

const Matrix one = Matrix::Identity(1, 1);

TEST(Module, ClaimsPassivityWhereItHasIt) {
  EXPECT_TRUE(detail::traits_of(TorqueArm()).passive);
  EXPECT_TRUE(detail::traits_of(Spaceball()).passive);  // its own supply is counted
  EXPECT_TRUE(detail::traits_of(Spring<any_size>(one)).passive);
  EXPECT_TRUE(detail::traits_of(Obstacle()).passive);
  EXPECT_FALSE(detail::traits_of(PumaJoints(6)).passive);
  EXPECT_FALSE(detail::traits_of(EffortSource<any_size>(Vector::Zero(1))).passive);
  EXPECT_FALSE(detail::traits_of(FlowSource<any_size>(Vector::Zero(1))).passive);
  EXPECT_TRUE(detail::traits_of(Line()).passive);
  LineOptions plain;
  plain.kind = LineKind::force_velocity;
  EXPECT_FALSE(detail::traits_of(Line(plain)).passive);
}

TEST(Module, OnlyWhatReadsAMeasuredFlowNeedsOne) {
  EXPECT_TRUE(detail::traits_of(Obstacle()).needs_flow);
  EXPECT_TRUE(detail::traits_of(Limits({}, {{-1.0, 1.0}})).needs_flow);
  EXPECT_FALSE(detail::traits_of(PumaKin()).needs_flow);
  EXPECT_TRUE(detail::traits_of(PumaKin()).keeps_flow);
  EXPECT_TRUE(detail::traits_of(Visual()).keeps_flow);
  for (const bool keeps :
       {detail::traits_of(Kbb2()).keeps_flow, detail::traits_of(Relief()).keeps_flow,
        detail::traits_of(Spaceball()).keeps_flow, detail::traits_of(Multiplex()).keeps_flow}) {
    EXPECT_FALSE(keeps);
  }
}

/// A one-port, shown and settled as a network does it: its energy is what the states say.
template <class M>
void expect_settled(M module, int size) {
  Rng rng(seed);
  module.prepare(period);
  double energy = 0.0;
  for (int tick = 0; tick < 1000; ++tick) {
    Equivalent<any_size> shown;
    detail::show_one_port(module, shown);
    ASSERT_EQ(shown.form, Form::impedance);
    ASSERT_EQ(shown.matrix.rows(), size);
    PortState<any_size> state;
    shown.at_flow(test::drawn_vector(rng, size, 1.0), state);
    detail::settle_one_port(module, state);
    energy += period * (state.power() + detail::supplied_by(module));
    if constexpr (requires { module.stored(); }) {
      ASSERT_LE(module.stored(), energy + 1e-9 * (1.0 + energy)) << "seed " << seed;
    }
    ASSERT_GE(energy, -1e-9);
  }
}

TEST(Module, OnePortsAreShownAndSettledByTheirWaves) {
  Rng rng(seed);
  expect_settled(Spring<any_size>(test::drawn_gain(rng, 6, 1.0, 100.0)), 6);
  expect_settled(Mass<any_size>(test::drawn_gain(rng, 6, 0.1, 10.0)), 6);
  expect_settled(Damper<any_size>(test::drawn_gain(rng, 3, 0.1, 10.0)), 3);
  expect_settled(TorqueArm({.torque_limit = 1e4}), 1);
}

TEST(Module, SourcesShowThemselvesAndTheArmTakesItsTorque) {
  Equivalent<any_size> shown;
  detail::show_one_port(FlowSource<any_size>(Vector::Constant(2, 3.0)), shown);
  EXPECT_EQ(shown.form, Form::admittance);
  EXPECT_EQ(shown.offset, Vector(Vector::Constant(2, 3.0)));
  PumaJoints arm(2);
  detail::show_one_port(arm, shown);
  EXPECT_EQ(shown.form, Form::admittance);
  detail::settle_one_port(arm, PortState<any_size>{Vector::Ones(2), Vector::Zero(2)});
  EXPECT_EQ(arm.torques(), Vector(Vector::Ones(2)));
}

TEST(Module, OnlyAMultiplexWeighsAndOnlyHandsSupply) {
  const Multiplex multiplex({.velocity_scale = 0.2, .force_scale = 0.1});
  EXPECT_DOUBLE_EQ(detail::left_weight_of(multiplex), 2.0);
  EXPECT_EQ(detail::left_weight_of(PumaKin()), 1.0);
  EXPECT_EQ(detail::supplied_by(Kbb2()), 0.0);
  TorqueArm arm({.friction = 1.0});
  arm.prepare(period);
  Signals signals;
  signals.hand.lever_rate = 1.0;
  for (int tick = 0; tick < 2000; ++tick) {
    arm.read(signals);
    // Nothing at the motor: f = 0.
    detail::settle_one_port(arm, {Vector::Zero(1), -arm.reflected() / arm.resistance()(0)});
  }
  EXPECT_NEAR(detail::supplied_by(arm), 1.0, 1e-6);
}

}  // namespace module_test
}  // namespace repel::network
