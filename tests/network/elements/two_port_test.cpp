// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/two_port.hpp>

#include <gtest/gtest.h>

#include "network/drawn.hpp"

namespace repel::network {
namespace two_port_test {

constexpr unsigned seed = 29;
using Map = Eigen::Matrix<double, any_size, any_size, Eigen::ColMajor, most_joints, most_joints>;

Map drawn_map(Rng& rng, int rows, int columns) {
  Map map(rows, columns);
  for (double& x : map.reshaped()) x = families::uniform(rng, -1.0, 1.0);
  return map;
}
Equivalent<any_size> drawn(Rng& rng, int n, Form form, int zeros) {
  Equivalent<any_size> some;
  some.form = form;
  some.matrix = test::drawn_gain(rng, n, 1e-1, 1e1, zeros);
  some.offset = test::drawn_vector(rng, n, 10.0);
  return some;
}
double error_of(const Equivalent<any_size>& of, const PortState<any_size>& state) {
  const bool impedance = of.form == Form::impedance;
  const Vector answer = of.matrix * (impedance ? state.flow : state.effort) + of.offset;
  const Vector& is = impedance ? state.effort : state.flow;
  return (answer - is).norm() / (1.0 + answer.norm() + is.norm());
}

TEST(Transformer, ShowsBWhatStandsAtA) {
  Rng rng(seed);
  for (int i = 0; i < families::draws(20000); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "draw", i));
    const int a = families::count_between(rng, 1, 8);
    const int b = families::count_between(rng, 1, 8);
    const Map V = drawn_map(rng, a, b);
    const bool impedance = i % 2 == 0;
    const auto at_a = drawn(rng, a, impedance ? Form::impedance : Form::admittance,
                            impedance ? families::count_between(rng, 0, a) : 0);
    Equivalent<any_size> shown;
    ASSERT_TRUE(transformer::shown_at_b(at_a, V, V, shown));
    PortState<any_size> state_b;
    PortState<any_size> state_a;
    ASSERT_EQ(shown.form, Form::impedance);
    shown.at_flow(test::drawn_vector(rng, b, 1.0), state_b);
    transformer::to_a(state_b, at_a, V, state_a);
    EXPECT_LE(error_of(at_a, state_a), 1e-9);
    EXPECT_LE((state_a.flow - V * state_b.flow).norm(), 1e-12 * (1.0 + state_a.flow.norm()));
    EXPECT_LE((state_b.effort - V.transpose() * state_a.effort).norm(),
              1e-9 * (1.0 + state_a.effort.norm()));
    EXPECT_NEAR(state_a.power(), state_b.power(), 1e-9 * (1.0 + std::abs(state_a.power())));
  }
}

TEST(Transformer, ShowsAWhatStandsAtB) {
  Rng rng(seed);
  for (int i = 0; i < families::draws(20000); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "draw", i));
    const int a = families::count_between(rng, 1, 8);
    const int b = families::count_between(rng, 1, 8);
    const Map V = drawn_map(rng, a, b);
    const bool admittance = i % 2 == 0;
    const auto at_b = drawn(rng, b, admittance ? Form::admittance : Form::impedance,
                            admittance ? families::count_between(rng, 0, b) : 0);
    Equivalent<any_size> shown;
    ASSERT_TRUE(transformer::shown_at_a(at_b, V, V, shown));
    PortState<any_size> state_a;
    PortState<any_size> state_b;
    ASSERT_EQ(shown.form, Form::admittance);
    shown.at_effort(test::drawn_vector(rng, a, 1.0), state_a);
    transformer::to_b(state_a, at_b, V, state_b);
    EXPECT_LE(error_of(at_b, state_b), 1e-9);
    EXPECT_LE((state_a.flow - V * state_b.flow).norm(), 1e-9 * (1.0 + state_b.flow.norm()));
    EXPECT_LE((state_b.effort - V.transpose() * state_a.effort).norm(),
              1e-12 * (1.0 + state_b.effort.norm()));
    EXPECT_NEAR(state_a.power(), state_b.power(), 1e-9 * (1.0 + std::abs(state_a.power())));
  }
}

TEST(Transformer, OfTwoScalesPassesOnTheirRatio) {
  Rng rng(seed);
  const Map V = drawn_map(rng, 6, 1);
  const Map F = 0.25 * V;
  const auto at_a = drawn(rng, 6, Form::impedance, 0);
  Equivalent<any_size> shown;
  ASSERT_TRUE(transformer::shown_at_b(at_a, V, F, shown));
  PortState<any_size> state_b;
  PortState<any_size> state_a;
  shown.at_flow(Vector::Ones(1), state_b);
  transformer::to_a(state_b, at_a, V, state_a);
  EXPECT_NEAR(state_b.power(), 0.25 * state_a.power(), 1e-9 * std::abs(state_a.power()));
}

TEST(Transformer, CannotShowWhatHasNotTheForm) {
  Rng rng(seed);
  const Map V = drawn_map(rng, 3, 3);
  Equivalent<any_size> shown;
  EXPECT_FALSE(transformer::shown_at_b(drawn(rng, 3, Form::admittance, 1), V, V, shown));
  EXPECT_FALSE(transformer::shown_at_a(drawn(rng, 3, Form::impedance, 1), V, V, shown));
}

}  // namespace two_port_test
}  // namespace repel::network
