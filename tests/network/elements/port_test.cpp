// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/port.hpp>

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "network/drawn.hpp"
#include "network/waves.hpp"

namespace repel::network {
namespace port_test {

constexpr unsigned seed = 11;

template <int N>
void expect_waves(int size) {
  Rng rng(seed);
  for (int i = 0; i < families::draws(5000); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "draw", i));
    const Mat<N> R = test::drawn_gain(rng, size, 1e-2, 1e2);
    const PortState<N> state{test::drawn_vector(rng, size, 10.0),
                             test::drawn_vector(rng, size, 1.0)};
    const Vec<N> a = state.incident(R);
    const Vec<N> b = state.reflected(R);
    ASSERT_EQ(a.size(), size);
    EXPECT_LE((a - state.effort - R * state.flow).norm(), 1e-12 * (1.0 + a.norm()));
    EXPECT_LE((b - state.effort + R * state.flow).norm(), 1e-12 * (1.0 + a.norm()));
    const Eigen::MatrixXd inverse = Eigen::MatrixXd(R).inverse();
    const double power = 0.25 * (a.dot(inverse * a) - b.dot(inverse * b));
    EXPECT_NEAR(power, state.power(), 1e-9 * (1.0 + a.dot(inverse * a)));
    const PortState<N> back = test::state_of<N>(a, b, R);
    EXPECT_LE((back.effort - state.effort).norm(), 1e-12 * (1.0 + a.norm() + b.norm()));
    EXPECT_LE((back.flow - state.flow).norm(), 1e-9 * (1.0 + state.flow.norm()));
  }
}

TEST(Port, WavesCarryThePower) {
  expect_waves<1>(1);
  expect_waves<6>(6);
  expect_waves<any_size>(1);
  expect_waves<any_size>(16);
}

TEST(Port, SixNumbersAreLinearFirst) {
  const Twist V{{1, 2, 3}, {4, 5, 6}};
  const Wrench F{{7, 8, 9}, {10, 11, 12}};
  const Vec<any_size> v = to_vec(V);
  const Vec<any_size> f = to_vec(F);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(v(i), 1.0 + i);
    EXPECT_EQ(f(i), 7.0 + i);
  }
  EXPECT_EQ((PortState<any_size>{f, v}.power()), power(F, V));
  EXPECT_EQ(to_wrench(f).force, F.force);
  EXPECT_EQ(to_wrench(f).torque, F.torque);
}

TEST(Port, SumsAndMultiplesGoEntryByEntry) {
  Rng rng(seed);
  const Vec<any_size> a = test::drawn_vector(rng, 5, 10.0);
  const Vec<any_size> b = test::drawn_vector(rng, 5, 10.0);
  const Vec<any_size> c = product(-(2.0 * a + b), a - b * 3.0) / 7.0;
  for (int i = 0; i < 5; ++i) {
    EXPECT_DOUBLE_EQ(c(i), -(2.0 * a(i) + b(i)) * (a(i) - b(i) * 3.0) / 7.0);
  }
  EXPECT_EQ(three(a, 2), Vec3(a(2), a(3), a(4)));
}

TEST(Port, SpacesHaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Space space : {Space::any, Space::lever, Space::tool, Space::joints}) {
    names.insert(name_of(space));
  }
  EXPECT_EQ(names, (std::set<std::string>{"any", "lever", "tool", "joints"}));
}

}  // namespace port_test
}  // namespace repel::network
