// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/six_axes.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <repel/base/setup_error.hpp>
#include <repel/network/elements/junction.hpp>
#include <repel/network/elements/one_ports.hpp>
#include <repel/network/plan.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace six_axes_test {

using test::period;

constexpr unsigned seed = 66;

Signals moving(const Twist& hand) {
  Signals signals = detail::neutral_signals(0, period);
  signals.hand.ball = hand;
  return signals;
}

/// The master against a spring at the tool.
Network against_a_spring(const SixAxesOptions& options, double stiffness) {
  return Plan()
      .add("six_axes", SixAxes(options))
      .add("spring", Spring<any_size>(stiffness * Matrix::Identity(6, 6)))
      .build(period);
}

TEST(SixAxes, FeelsForceAndTorqueOfWhatItMoves) {
  for (const double scale : {0.2, 1.0, 3.0}) {
    SCOPED_TRACE(scale);
    Network network = against_a_spring({.motion_scale = scale}, 50.0);
    const Twist hand{Vec3(0.02, -0.01, 0.03), Vec3(0.004, 0.01, -0.02)};
    for (int tick = 0; tick < 400; ++tick) ASSERT_TRUE(network.run(moving(hand)));
    for (int tick = 0; tick < 4000; ++tick) ASSERT_TRUE(network.run(moving({})));
    const auto& master = *network.find<SixAxes>();
    // The hand went as far in a second; its grip and the spring at the tool share it.
    const Vector wanted = to_vec(hand);
    for (Eigen::Index i = 0; i < 6; ++i) {
      const double grip = i < 3 ? 300.0 : 3.0;
      const double load = 50.0 * scale * scale;
      EXPECT_NEAR(master.position()(i), wanted(i) * grip / (grip + load), 1e-5);
      EXPECT_NEAR(master.felt()(i), -load * master.position()(i), 1e-6);
    }
    EXPECT_FALSE(master.saturated());
  }
}

TEST(SixAxes, GivesNoMoreThanItTookAndTheHandSupplied) {
  families::Rng rng(seed);
  for (const double scale : {0.3, 2.0}) {
    for (const double limit : {1.0, 100.0}) {
      SCOPED_TRACE("scale " + std::to_string(scale) + ", seed " + std::to_string(seed));
      Network network = against_a_spring(
          {.force_limit = limit, .torque_limit = 0.1 * limit, .motion_scale = scale}, 200.0);
      int saturated = 0;
      for (int tick = 0; tick < families::draws(20000); ++tick) {
        Twist hand;
        for (Eigen::Index i = 0; i < 3; ++i) {
          hand.linear[i] = families::uniform(rng, -0.5, 0.5);
          hand.angular[i] = families::uniform(rng, -2.0, 2.0);
        }
        ASSERT_TRUE(network.run(moving(hand)));
        saturated += network.find<SixAxes>()->saturated() ? 1 : 0;
      }
      for (const Node& node : network.nodes()) {
        EXPECT_LE(node.ledger.deficit(), 1e-9) << node.name;
      }
      EXPECT_GT(network.find("six_axes")->ledger.passed, 1e-2);
      EXPECT_EQ(saturated > 0, limit < 10.0);
    }
  }
}

TEST(SixAxes, AScaleThatChangesSuppliesNothingAndNothingJumps) {
  families::Rng rng(seed);
  SCOPED_TRACE(families::of_seed(seed, "change", 0));
  Network network = against_a_spring({}, 200.0);
  Signals signals = moving({Vec3(0.05, 0, 0), Vec3(0, 0, 0.2)});
  for (int tick = 0; tick < 400; ++tick) ASSERT_TRUE(network.run(signals));
  signals.hand.ball = {};
  const auto& master = *network.find<SixAxes>();
  Vector felt = master.felt();
  Vec<6> at = master.position();
  double jump = 0.0, move = 0.0, most = 0.0;
  for (int tick = 0; tick < families::draws(20000); ++tick) {
    if (tick % 200 == 0) signals.hand.scale = std::exp(families::uniform(rng, -1.5, 1.5));
    ASSERT_TRUE(network.run(signals));
    jump = std::max(jump, (master.felt() - felt).norm());
    move = std::max(move, (master.position() - at).norm());
    most = std::max(most, master.felt().norm());
    felt = master.felt();
    at = master.position();
  }
  EXPECT_GT(most, 5.0) << "the hand must lean on the spring";
  // A change of scale by e^3 in 0.3 s, in force and in place.
  EXPECT_LT(jump, 0.1 * most);
  EXPECT_LT(move, 0.005);
  for (const Node& node : network.nodes()) EXPECT_LE(node.ledger.deficit(), 1e-9) << node.name;
}

TEST(SixAxes, LetsGoAtRest) {
  Network network = against_a_spring({}, 50.0);
  for (int tick = 0; tick < 100; ++tick) {
    ASSERT_TRUE(network.run(moving({Vec3(0.1, 0, 0), Vec3(0, 0, 0.1)})));
  }
  Signals rest = moving({});
  rest.at_rest = true;
  ASSERT_TRUE(network.run(rest));
  EXPECT_LT(network.find<SixAxes>()->rate().norm(), 0.1);
}

/// Two masters that hold the same tool, against a spring.
Network held_by_two(double first_scale, double second_scale, double stiffness) {
  return Plan()
      .add("left", SixAxes({.motion_scale = first_scale}), "tool")
      .add("right", SixAxes({.motion_scale = second_scale, .hand = Hand::second}), "tool")
      .add("tool", Junction())
      .add("spring", Spring<any_size>(stiffness * Matrix::Identity(6, 6)))
      .build(period);
}

TEST(SixAxes, TwoHandsHoldOneToolAndEachFeelsTheOther) {
  Network network = held_by_two(1.0, 2.0, 50.0);
  Signals signals = moving({Vec3(0.02, 0.01, 0), Vec3(0, 0, 0.01)});
  signals.second.ball = {Vec3(-0.01, 0.03, 0), Vec3::Zero()};
  for (int tick = 0; tick < 400; ++tick) ASSERT_TRUE(network.run(signals));
  signals.hand.ball = signals.second.ball = {};
  for (int tick = 0; tick < 4000; ++tick) ASSERT_TRUE(network.run(signals));
  const auto& left = *network.find("left")->module.as<SixAxes>();
  const auto& right = *network.find("right")->module.as<SixAxes>();
  for (int i = 0; i < 2; ++i) {
    // The tool is where both handles say, between the hands.
    const double x = left.position()(i);
    EXPECT_NEAR(2.0 * right.position()(i), x, 1e-6);
    const double first = Vec3(0.02, 0.01, 0)[i], second = Vec3(-0.01, 0.03, 0)[i];
    EXPECT_NEAR(300.0 * (first - x) + 300.0 / 2.0 * (second - 0.5 * x), 50.0 * x, 1e-4);
    EXPECT_NEAR(left.grip()(i), 300.0 * (x - first), 1e-4);
    EXPECT_NEAR(right.grip()(i), 300.0 * (0.5 * x - second), 1e-4);
  }
}

TEST(SixAxes, TwoHandsGiveNoMoreThanTheyTookAndSupplied) {
  families::Rng rng(seed);
  SCOPED_TRACE(families::of_seed(seed, "hands", 0));
  Network network = held_by_two(0.5, 3.0, 200.0);
  for (int tick = 0; tick < families::draws(20000); ++tick) {
    Signals signals = moving({});
    for (HandInput* hand : {&signals.hand, &signals.second}) {
      hand->ball = {families::uniform(rng, 0.0, 0.3) * families::direction(rng),
                    families::uniform(rng, 0.0, 1.0) * families::direction(rng)};
    }
    ASSERT_TRUE(network.run(signals));
  }
  for (const Node& node : network.nodes()) EXPECT_LE(node.ledger.deficit(), 1e-9) << node.name;
  for (const char* name : {"left", "right"}) {
    EXPECT_GT(network.find(name)->ledger.passed, 1e-2) << name;
  }
}

TEST(SixAxes, GivesTheHandThePowerOfItsGrip) {
  families::Rng rng(seed);
  SCOPED_TRACE(families::of_seed(seed, "hand", 0));
  Network network = against_a_spring({}, 200.0);
  const auto& master = *network.find<SixAxes>();
  double most = 0.0;
  for (int tick = 0; tick < families::draws(2000); ++tick) {
    Twist hand;
    for (Eigen::Index i = 0; i < 3; ++i) hand.linear[i] = families::uniform(rng, -0.1, 0.1);
    ASSERT_TRUE(network.run(moving(hand)));
    ASSERT_NEAR(-master.grip().dot(to_vec(hand)), master.supplied(), 1e-12);
    most = std::max(most, master.supplied());
  }
  EXPECT_GT(most, 0.1);
}

/// [J] of a device of 0.1 kg that held still, was pushed once and moves the hand for two seconds,
/// as a part of what the push gave; a force acts on it from the tick after its motion was read.
double energy_left(const SixAxesOptions& options, double load, double damping) {
  constexpr double mass = 0.1;
  Network network = against_a_spring(options, load);
  const auto& master = *network.find<SixAxes>();
  double rate = 0.1, position = 0.0, read = 0.0, force = 0.0;
  for (int tick = 0; tick < 800; ++tick) {
    Signals signals = moving({});
    signals.hand.ball.linear.x() = (position - read) / period;
    read = position;
    if (!network.run(signals)) return 1e9;
    force = master.grip()(0);
    for (int part = 0; part < 20; ++part) {
      rate += period / 20 / mass * (force - damping * rate);
      position += period / 20 * rate;
    }
    if (!(std::abs(rate) < 1e3)) return 1e9;
  }
  return rate * rate / 0.01;
}

TEST(SixAxes, ADeviceWithTheDampingThatItNeedsComesToRest) {
  families::Rng rng(seed);
  int restless = 0;
  for (int i = 0; i < families::draws(60); ++i) {
    SCOPED_TRACE(families::of_seed(seed, "device", i));
    const SixAxesOptions options{.mass = families::uniform(rng, 0.05, 0.5),
                                 .hand_stiffness = families::uniform(rng, 100.0, 1500.0),
                                 .hand_damping = families::uniform(rng, 0.3, 10.0),
                                 .force_limit = 1e5};
    const double load = std::pow(10.0, families::uniform(rng, 1.0, 6.0));
    SixAxes alone(options);
    alone.prepare(period);
    EXPECT_LT(energy_left(options, load, alone.device_damping(0.0)(0)), 1.0);
    restless += energy_left(options, load, 0.01) > 1.0 ? 1 : 0;
  }
  // The few draws under a sanitizer need not have one.
  if (families::draws(60) == 60) {
    EXPECT_GT(restless, 6) << "the condition must be about something";
  }
}

TEST(SixAxes, TheDampingThatADeviceNeedsIsLeastForADamperOfItsOwnHalf) {
  const auto needed = [](double damping, double late) {
    SixAxes master({.hand_stiffness = 400.0, .hand_damping = damping});
    master.prepare(period);
    return master.device_damping(late)(0);
  };
  const double k_t = 400.0 * period;
  EXPECT_NEAR(needed(0.5 * k_t, 0.0), k_t, 1e-12);
  EXPECT_GT(needed(0.4 * k_t, 0.0), k_t);
  EXPECT_GT(needed(0.6 * k_t, 0.0), k_t);
  EXPECT_NEAR(needed(k_t, period), 2.0 * k_t, 1e-12);
  EXPECT_TRUE(std::isinf(needed(0.0, 0.0)));
  SixAxes master({.hand_stiffness = 400.0});
  master.prepare(period);
  EXPECT_NEAR(master.best_grip_damping(period)(0), k_t, 1e-12);
}

TEST(SixAxes, RefusesNumbersOutOfRange) {
  EXPECT_THROW(SixAxes({.mass = 0.0}), SetupError);
  EXPECT_THROW(SixAxes({.inertia = -1.0}), SetupError);
  EXPECT_THROW(SixAxes({.force_limit = 1e6}), SetupError);
  EXPECT_THROW(SixAxes({.motion_scale = 0.0}), SetupError);
}

}  // namespace six_axes_test
}  // namespace repel::network
