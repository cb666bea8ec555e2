// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/machinery/any_module.hpp>

#include <gtest/gtest.h>

#include <repel/network/module.hpp>
#include <repel/network/modules.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace any_module_test {

using test::period;

constexpr unsigned seed = 37;

static_assert(detail::ports_of<Multiplex>() == Ports::two);
static_assert(detail::ports_of<Limits>() == Ports::two);
static_assert(detail::ports_of<TorqueArm>() == Ports::one);
static_assert(detail::ports_of<PumaJoints>() == Ports::one);
static_assert(detail::ports_of<Spring<any_size>>() == Ports::one);
static_assert(detail::ports_of<FlowSource<any_size>>() == Ports::one);
static_assert(detail::ports_of<Line>() == Ports::line);
static_assert(detail::ports_of<Junction>() == Ports::junction);

/// A one-port, solved as in a network: its energy is that of the states.
template <class M>
void expect_settled(M module, int size) {
  Rng rng(seed);
  if constexpr (requires { module.prepare(period); }) module.prepare(period);
  double energy = 0.0;
  for (int tick = 0; tick < 1000; ++tick) {
    Equivalent<any_size> shown;
    detail::show_one_port(module, shown);
    ASSERT_EQ(shown.form, Form::impedance);
    ASSERT_EQ(shown.matrix.rows(), size);
    PortState<any_size> state;
    shown.at_flow(test::drawn_vector(rng, size, 1.0), state);
    detail::settle_one_port(module, state);
    energy += period * (state.power() + Module(module)->supplied());
    if constexpr (requires { module.stored(); }) {
      ASSERT_LE(module.stored(), energy + 1e-9 * (1.0 + energy)) << "seed " << seed;
    }
    ASSERT_GE(energy, -1e-9);
  }
}

TEST(AnyModule, OnePortsAreShownAndSettledByTheirWaves) {
  Rng rng(seed);
  expect_settled(Spring<any_size>(test::drawn_gain(rng, 6, 1.0, 100.0)), 6);
  expect_settled(Mass<any_size>(test::drawn_gain(rng, 6, 0.1, 10.0)), 6);
  expect_settled(Damper<any_size>(test::drawn_gain(rng, 3, 0.1, 10.0)), 3);
  expect_settled(TorqueArm({.torque_limit = 1e4}), 1);
}

TEST(AnyModule, SourcesShowThemselvesAndTheArmTakesItsTorque) {
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

}  // namespace any_module_test
}  // namespace repel::network
