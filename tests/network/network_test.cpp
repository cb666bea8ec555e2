// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/network.hpp>

#include <gtest/gtest.h>

#include <array>
#include <optional>

#include <repel/base/setup_error.hpp>

#include "network/drawn_network.hpp"
// Counts every heap call in this program, by defining its own malloc.
#include "support/heap_counter.hpp"

namespace repel::network {
namespace network_test {

using test::between;
using test::DrawnPlan;
using test::period;

/// Number of modules met, for each type of the library.
template <class... M>
struct MetOf {
  std::array<int, sizeof...(M)> count{};

  void note(const Module& module) {
    std::size_t i = 0;
    ((count[i++] += module.as<M>() != nullptr ? 1 : 0), ...);
  }
  void expect_more_than(int least) const {
    for (std::size_t i = 0; i < count.size(); ++i) EXPECT_GT(count[i], least) << "type " << i;
  }
};
using Met =
    MetOf<TorqueArm, Multiplex, Spaceball, Relief, Kbb2, Obstacle, PumaKin, ArmObstacle,
          ForceSensor, Limits, Posture, Visual, PumaJoints, Junction, Line, Spring<any_size>,
          Mass<any_size>, Damper<any_size>, EffortSource<any_size>, FlowSource<any_size>>;

/// The sum of the ledgers of all modules, sources and robot included: energy into one comes out of
/// another. A multiplex with a power factor declares the part it does not pass on.
void expect_tellegen(const Network& network) {
  double sum = 0.0;
  double passed = 0.0;
  for (const Node& node : network.nodes()) {
    const auto* multiplex = node.module.as<Multiplex>();
    if (multiplex != nullptr && multiplex->power_factor() != 1.0) return;
    sum += node.ledger.energy - node.ledger.supplied;
    passed += node.ledger.passed;
  }
  EXPECT_LE(std::abs(sum), 1e-9 * std::max(passed, 1e-3));
}

void run_drawn(Network& network, int joints, Rng& rng, int ticks, const Matrix& inertia) {
  DrawnSignals drawn(rng, joints);
  drawn.signals.inertia = inertia;
  for (int tick = 0; tick < ticks; ++tick) {
    ASSERT_TRUE(network.run(drawn.next())) << network.stuck_at() << " at tick " << tick;
    if (tick % 16 == 0) {
      ASSERT_EQ(test::Laws(network).breach(), "") << "at tick " << tick;
    }
  }
  test::expect_passive(network);
  expect_tellegen(network);
}

std::string written(const Network& network) {
  std::string text;
  for (const Connection& c : network.connections()) {
    text += c.left + (c.root_on_right ? " -> " : " <- ") + c.right + ", ";
  }
  return text;
}

/// What random trees had in them.
struct Drawn {
  Met met;
  int facing_left = 0;  ///< connections
  int in_joints = 0;    ///< networks that are joined to the mass of their arm in the joints
};

/// Runs `wanted` random trees, with the mass of the arm or without.
Drawn run_random_trees(int wanted, bool has_mass) {
  constexpr int ticks = 2000;
  Drawn all;
  int built = 0;
  for (std::uint64_t seed = 1; built < wanted && seed < 4000; ++seed) {
    Rng rng(seed);
    const DrawnPlan drawn(rng);
    if (has_mass && drawn.joints == 0) continue;
    SCOPED_TRACE("seed " + std::to_string(seed));
    try {
      std::optional<PredictionOptions> prediction;
      if (has_mass) prediction.emplace();
      Network network = drawn.plan.build(period, prediction);
      SCOPED_TRACE(written(network));
      Matrix inertia;
      if (has_mass) inertia = test::drawn_gain(rng, drawn.joints, 0.01, 10.0);
      run_drawn(network, drawn.joints, rng, ticks, inertia);
      ++built;
      for (const Node& node : network.nodes()) all.met.note(node.module);
      for (const Connection& c : network.connections()) {
        all.facing_left += c.root_on_right ? 0 : 1;
        all.in_joints += c.left == "prediction" && c.space == Space::joints ? 1 : 0;
      }
    } catch (const SetupError& error) {
      const std::string text = error.what();
      EXPECT_TRUE(text.find("insist") < text.size() || text.find("nothing says") < text.size())
          << text;
    }
  }
  EXPECT_EQ(built, wanted);
  return all;
}

TEST(Network, RandomTreesKeepThePowerBalanceOfEveryModule) {
  const int networks = families::draws(1000000) / 2000;
  const Drawn drawn = run_random_trees(networks, false);
  drawn.met.expect_more_than(networks / 20);
  EXPECT_GT(drawn.facing_left, networks / 2);
}

// Where nothing keeps the tool off walls, arms of seven joints, and of six in a singular pose, were
// never solved: what the tool does not feel has no admittance.
TEST(Network, RandomTreesAreSolvedWithTheMassOfTheArmInEveryPose) {
  const int networks = families::draws(200000) / 2000;
  EXPECT_GT(run_random_trees(networks, true).in_joints, networks / 5);
}

/// Every kind of module in one network of two parts.
Plan of_everything() {
  const Matrix six = Matrix::Identity(6, 6);
  LineOptions late;
  late.channel = {.delay = 0.02, .jitter = 0.01, .loss = 0.1};
  Plan plan;
  plan.add("torque_arm", TorqueArm()).add("multiplex", Multiplex(), "near");
  plan.add("weight", Mass<any_size>(six), "near").add("hold", Spring<any_size>(six), "near");
  plan.add("push", EffortSource<any_size>(Vector::Ones(6)), "near");
  plan.add("near", Junction()).add("line", Line(late));
  plan.add("kbb2", Kbb2({.shunt = 20.0, .angular_shunt = 0.5}), "far");
  plan.add("moved", FlowSource<any_size>(Vector::Ones(6))).add("soft", Kbb2(), "far");
  plan.add("brake", Damper<any_size>(six), "far").add("far", Junction());
  plan.add("spaceball", Spaceball());
  plan.add("relief", Relief({.compliant = {true, true, true, true, true, true}}));
  plan.add("obstacle", Obstacle()).add("visual", Visual()).add("puma_kin", PumaKin());
  plan.add("arm_obstacle", ArmObstacle());
  plan.add("limits", Limits({}, std::vector<JointRange>(6, {-0.2, 0.2})));
  plan.add("posture", Posture());
  plan.add("force_sensor", ForceSensor());
  plan.add("puma_joints", PumaJoints(6));
  return plan;
}

TEST(Network, TickTakesNothingFromTheHeap) {
  if (REPEL_COUNTS_HEAP == 0) GTEST_SKIP() << "a sanitizer owns malloc";
  Network network = of_everything().build(period);
  Met met;
  for (const Node& node : network.nodes()) met.note(node.module);
  met.expect_more_than(0);
  Rng rng(1);
  DrawnSignals drawn(rng, 6);
  repel::test::is_counted = true;
  for (int tick = 0; tick < 2000; ++tick) {
    const Signals& signals = drawn.next();
    repel::test::calls = 0;
    repel::test::watched = true;
    const bool solved = network.run(signals);
    repel::test::watched = false;
    ASSERT_TRUE(solved);
    ASSERT_EQ(repel::test::calls, 0) << "tick " << tick;
  }
}

TEST(Network, SameSignalsGiveTheSameBits) {
  Network one = of_everything().build(period);
  Network two = of_everything().build(period);
  Rng rng(2);
  DrawnSignals drawn(rng, 6);
  Network copy = one;
  for (int tick = 0; tick < 4000; ++tick) {
    const Signals& signals = drawn.next();
    ASSERT_TRUE(one.run(signals) && two.run(signals));
    if (tick == 2000) copy = one;
    if (tick > 2000) {
      ASSERT_TRUE(copy.run(signals));
    }
    for (std::size_t i = 0; i < one.connections().size(); ++i) {
      const auto& state = one.connections()[i].state;
      ASSERT_EQ(state.effort, two.connections()[i].state.effort) << "tick " << tick;
      ASSERT_EQ(state.flow, two.connections()[i].state.flow) << "tick " << tick;
      if (tick > 2000) {
        ASSERT_EQ(state.effort, copy.connections()[i].state.effort) << "tick " << tick;
      }
    }
  }
  for (std::size_t i = 0; i < one.nodes().size(); ++i) {
    EXPECT_EQ(one.nodes()[i].ledger.energy, two.nodes()[i].ledger.energy);
  }
}

// The first branch supports both forms and is given the form required by the second.
TEST(Network, JunctionSettlesEveryBranchWhicheverInsists) {
  const FlowSource<any_size> moved(Vector::Constant(6, 0.1));
  const std::array<bool, 6> all{true, true, true, true, true, true};
  Network network = Plan()
                        .add("a", moved)
                        .add("yielding", Relief({.compliant = all}), "junction")
                        .add("b", FlowSource<any_size>(Vector::Zero(6)), "junction")
                        .add("junction", Junction())
                        .add("ball", Spaceball())
                        .add("mass", Mass<any_size>(Matrix::Identity(6, 6)))
                        .build(period);
  Rng rng(3);
  DrawnSignals drawn(rng, 0);
  for (int tick = 0; tick < 1000; ++tick) {
    ASSERT_TRUE(network.run(drawn.next()));
    ASSERT_EQ(repel::test::Laws(network).breach(), "") << "at tick " << tick;
  }
  repel::test::expect_passive(network);
  EXPECT_GT(network.find("yielding")->ledger.passed, 1e-6);
}

// With a direction of length zero the lever has nothing to act on. By then the other part, that of
// 'end', is solved.
TEST(Network, SaysWhereItCouldNotGoOnAndMovesNoModule) {
  const Mass<any_size> mass(Matrix::Identity(6, 6));
  Network network = Plan()
                        .add("line", Line(), "end")
                        .add("load", mass, "junction")
                        .add("push", EffortSource<any_size>(Vector::Ones(1)))
                        .add("multiplex", Multiplex({.turning_time = 0.0}), "junction")
                        .add("junction", Junction(), "line")
                        .add("end", mass)
                        .build(period);
  Signals signals = detail::neutral_signals(0, period);
  const auto stored = [&](const char* name) {
    return network.find(name)->module.as<Mass<any_size>>()->stored();
  };
  for (int tick = 0; tick < 50; ++tick) ASSERT_TRUE(network.run(signals));
  const double load = stored("load");
  const double end = stored("end");
  const double passed = network.find("end")->ledger.passed;
  EXPECT_GT(load * end, 0.0);
  signals.hand.direction_W.setZero();
  ASSERT_FALSE(network.run(signals));
  EXPECT_EQ(network.stuck_at(), "push");
  EXPECT_EQ(stored("load"), load);
  EXPECT_EQ(stored("end"), end);
  EXPECT_EQ(network.find("end")->ledger.passed, passed);
  signals.hand.direction_W = Vec3::UnitY();
  EXPECT_TRUE(network.run(signals));
}

TEST(Network, PowerGoesFromLeftToRightOnEitherSideOfTheRoot) {
  const Matrix I = Matrix::Identity(6, 6);
  for (const Side root : {Side::left, Side::right}) {
    Network network = between(FlowSource<any_size>(Vector::Constant(6, 0.5)), Spaceball(),
                              Damper<any_size>(4.0 * I), root);
    ASSERT_TRUE(network.run(detail::neutral_signals(0, period)));
    const Node* ball = network.find("module");
    const Connection& c = network.connection(ball->left);
    EXPECT_EQ(c.left, "left");
    EXPECT_EQ(c.root_on_right, root == Side::right);
    EXPECT_NEAR(c.power(), 6.0 * 4.0 * 0.5 * 0.5, 1e-12);  // into the damper
    EXPECT_LE((c.effort() - Vector::Constant(6, 2.0)).norm(), 1e-12);
    EXPECT_LE((c.flow() - Vector::Constant(6, 0.5)).norm(), 1e-12);
  }
}

}  // namespace network_test
}  // namespace repel::network
