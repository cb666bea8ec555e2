// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/remote_line.hpp>

#include <gtest/gtest.h>

#include <memory>

#include <repel/base/setup_error.hpp>
#include <repel/network/elements/junction.hpp>
#include <repel/network/elements/one_ports.hpp>
#include <repel/network/plan.hpp>

#include "network/drawn.hpp"
#include "network/remote/relay.hpp"

namespace repel::network {
namespace remote_line_test {

using test::at;
using test::period;
using test::Relay;
using test::RelayPath;

constexpr unsigned seed = 1989;

/// The state of an end, effort into the line, with `end` connected to it.
State joined(const RemoteLine& line, const Equivalent<any_size>& end) {
  Equivalent<any_size> sum;
  line.equivalent(sum);
  const Equivalent<any_size> shown = sum;
  sum.add_impedance(end.matrix, end.offset);
  EXPECT_TRUE(sum.take_form(Form::admittance));
  State state;
  shown.at_flow(sum.offset, state);
  return state;
}

void expect_passive_over(const RelayPath& path, int size, double other_period) {
  SCOPED_TRACE("jitter " + std::to_string(path.jitter) + ", loss " + std::to_string(path.loss) +
               ", seed " + std::to_string(seed));
  families::Rng rng(seed);
  const std::array<double, 2> periods{period, other_period};
  RemoteLink left({.session = 1}), right({.session = 2});
  const std::array links{&left, &right};
  std::array lines{RemoteLine(left), RemoteLine(right)};
  for (std::size_t i = 0; i < 2; ++i) {
    lines[i].fit(size == 6 ? Space::tool : Space::lever, size);
    lines[i].prepare(periods[i]);
  }
  Relay forth(seed), back(seed + 1);
  test::DrawnEnds ends(rng, size, 5.0);
  std::array<double, 2> next = periods;
  double energy = 0.0, passed = 0.0;
  for (int tick = 0; tick < families::draws(60000); ++tick) {
    const std::size_t i = next[0] <= next[1] ? 0 : 1;
    const double now = next[i];
    next[i] += periods[i];
    links[i]->receive(at(now));
    lines[i].read({});
    const State state = joined(lines[i], ends.definite());
    lines[i].incident(state);
    energy += periods[i] * state.power();
    passed += periods[i] * std::abs(state.power());
    ASSERT_GE(energy, -1e-9 * passed) << "tick " << tick;
    const double stored =
        left.energy_sent() - right.player().output() + right.energy_sent() - left.player().output();
    ASSERT_NEAR(stored, energy, 1e-9 * (1.0 + passed)) << "tick " << tick;
    forth.carry(left, right, path, now);
    back.carry(right, left, path, now);
  }
  EXPECT_GT(passed, 1.0);
  EXPECT_GT(left.player().output(), 0.01 * right.energy_sent());
}

TEST(RemoteLine, GivesNoMoreThanWasSentForAnyPathAndAnyRates) {
  for (const RelayPath& path : {RelayPath{.delay = 0.0},
                                {.delay = 0.05},
                                {.delay = 0.05, .jitter = 0.0313},
                                {.delay = 0.01, .jitter = 0.1, .loss = 0.3, .copies = 0.3},
                                {.delay = 0.2, .loss = 0.9}}) {
    expect_passive_over(path, 1, period);
    expect_passive_over(path, 6, 0.001);
  }
}

/// A mass on a lever.
struct Bar : Mass<any_size> {
  static constexpr Traits traits{.left = Space::lever, .right = Space::lever};
  explicit Bar(double inertia) : Mass(test::Matrix::Constant(1, 1, inertia)) {}
};

/// A hand of 2 kg that pushes with a force, over a link, a robot of 10 kg that is held by a spring:
/// one side, as a program of its own.
struct Half {
  RemoteLink link;
  Network network;

  Half(std::uint64_t session, double mass, Module rest)
      : link({.session = session}),
        network(
            Plan()
                .add("line", RemoteLine(link), "junction")
                .add("mass", Bar(mass), "junction")
                .add("friction", Damper<any_size>(test::Matrix::Constant(1, 1, 5.0)), "junction")
                .add("rest", std::move(rest), "junction")
                .add("junction", Junction(), To(std::vector<std::string>{}))
                .build(period)) {}
  void step(double now) {
    Signals signals = detail::neutral_signals(0, period);
    link.receive(at(now));
    ASSERT_TRUE(network.run(signals));
    ASSERT_GE(network.find("line")->ledger.least,
              -1e-9 * (1.0 + network.find("line")->ledger.passed));
  }
  [[nodiscard]] double flow() const { return network.connections().front().flow()(0); }
  [[nodiscard]] double effort() const { return network.connections().front().effort()(0); }
};

std::unique_ptr<Half> hand(std::uint64_t session, double force) {
  return std::make_unique<Half>(session, 2.0, EffortSource<any_size>(Vector::Constant(1, force)));
}

// A wall of 50 kN/m behind 0 to 200 ms, 5 % loss, and either side killed and started again.
TEST(RemoteLine, AStiffWallFarAwayStaysBoundedThroughRestarts) {
  for (const double delay : {0.0, 0.05, 0.2}) {
    SCOPED_TRACE(delay);
    const RelayPath path{.delay = delay, .jitter = 0.0131, .loss = 0.05};
    const Spring<any_size> wall(test::Matrix::Constant(1, 1, 50e3));
    auto station = hand(1, -10.0);
    auto site = std::make_unique<Half>(2, 10.0, wall);
    Relay forth(seed), back(seed + 1);
    double now = 0.0, fastest = 0.0;
    const auto run = [&](double seconds, bool has_station, bool has_site) {
      for (const double until = now + seconds; now < until;) {
        now += period;
        if (has_station) station->step(now);
        if (has_site) site->step(now);
        forth.carry(station->link, site->link, path, now);
        back.carry(site->link, station->link, path, now);
        if (has_station) fastest = std::max(fastest, std::abs(station->flow()));
        if (has_site) fastest = std::max(fastest, std::abs(site->flow()));
      }
    };
    run(6.0, true, true);
    // The hand feels the wall as it is: what it pushes with.
    EXPECT_NEAR(std::abs(station->effort()), 10.0, 2.5);
    EXPECT_LT(std::abs(site->flow()), 0.02);
    run(1.0, false, true);
    EXPECT_LT(std::abs(site->flow()), 0.02);
    station = hand(3, -10.0);
    run(6.0, true, true);
    EXPECT_NEAR(std::abs(station->effort()), 10.0, 2.5);
    run(0.5, true, false);
    site = std::make_unique<Half>(4, 10.0, wall);
    run(6.0, true, true);
    EXPECT_EQ(station->link.counts().sessions, 2);
    EXPECT_EQ(site->link.counts().sessions, 1);
    station = hand(5, 0.0);
    run(40.0, true, true);
    EXPECT_LT(std::abs(site->flow()), 2e-3);
    EXPECT_LT(std::abs(station->flow()), 2e-3);
    // Pushed against nothing but the impedance of the line.
    EXPECT_LE(fastest, 10.0 / 20.0 + 0.3);
  }
}

TEST(RemoteLine, ATrialOfTheNetworkSendsNothing) {
  const auto station = hand(1, 1.0);
  EXPECT_EQ(station->link.outgoing().front(), nullptr);
}

TEST(RemoteLine, RefusesAnImpossibleImpedance) {
  RemoteLink link({.session = 1});
  EXPECT_THROW(RemoteLine(link, {.impedance = 0.0}), SetupError);
}

}  // namespace remote_line_test
}  // namespace repel::network
