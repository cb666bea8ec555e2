// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/module.hpp>

#include <gtest/gtest.h>

#include <repel/network/modules.hpp>
#include <repel/network/plan.hpp>

#include "network/drawn.hpp"

namespace repel::network {
namespace module_test {

using test::period;

constexpr unsigned seed = 37;

const Matrix one = Matrix::Identity(1, 1);

TEST(Module, ClaimsPassivityWhereItHasIt) {
  EXPECT_TRUE(detail::traits_of(TorqueArm()).passive);
  EXPECT_TRUE(detail::traits_of(Spaceball()).passive);  // its supply is accounted for
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

TEST(Module, OnlyAMultiplexWeighsAndOnlyHandsSupply) {
  EXPECT_DOUBLE_EQ(Module(Multiplex({.velocity_scale = 0.2, .force_scale = 0.1}))->left_weight(),
                   2.0);
  EXPECT_EQ(Module(PumaKin())->left_weight(), 1.0);
  EXPECT_EQ(Module(Kbb2())->supplied(), 0.0);
  TorqueArm arm({.friction = 1.0});
  arm.prepare(period);
  Signals signals;
  signals.hand.lever_rate = 1.0;
  for (int tick = 0; tick < 2000; ++tick) {
    arm.read(signals);
    // No load at the motor: f = 0.
    detail::settle_one_port(arm, {Vector::Zero(1), -arm.reflected() / arm.resistance()(0)});
  }
  EXPECT_NEAR(Module(arm)->supplied(), 1.0, 1e-6);
}

TEST(Module, IsOneOfItsTypeAndItsCopiesAreTheirOwn) {
  Module first{Spaceball({.time_constant = 0.0})};
  EXPECT_EQ(first.as<TorqueArm>(), nullptr);
  Module second = first;
  Signals signals;
  signals.hand.ball.linear = Vec3::UnitX();
  first->prepare(period);
  first->read(signals);
  EXPECT_GT(first.as<Spaceball>()->twist().linear.x(), 0.1);
  EXPECT_EQ(second.as<Spaceball>()->twist().linear.x(), 0.0);
  second = first;
  EXPECT_GT(second.as<Spaceball>()->twist().linear.x(), 0.1);
}

/// A two-port unknown to the library's headers, with only the required functions: it halves what is
/// behind it, like a two-arm lever, and so passes on all power.
struct Lever {
  static constexpr Traits traits{.left = Space::tool, .right = Space::tool};
  bool reflected(const Equivalent<any_size>& behind, Equivalent<any_size>& shown) noexcept {
    shown = behind;
    if (!shown.take_form(Form::impedance)) return false;
    shown.matrix *= 0.25;
    shown.offset *= 0.5;
    return true;
  }
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& behind,
                PortState<any_size>& at_leaf) noexcept {
    Equivalent<any_size> other = behind;
    (void)other.take_form(Form::impedance);
    other.at_flow(0.5 * at_root.flow, at_leaf);
  }
};

TEST(Module, OfAnotherProgramStandsInANetworkLikeAnyOther) {
  const Matrix six = Matrix::Identity(6, 6);
  const auto flow_behind = [&](const Module& between) {
    Network network = Plan()
                          .add("near", Mass<any_size>(six), "middle")
                          .add("push", EffortSource<any_size>(Vector::Ones(6)), "middle")
                          .add("middle", Junction())
                          .add("between", between)
                          .add("far", Mass<any_size>(2.0 * six))
                          .build(period);
    for (int tick = 0; tick < 50; ++tick) EXPECT_TRUE(network.run(Signals{}));
    for (const Node& node : network.nodes()) {
      EXPECT_TRUE(!node.traits.passive || node.ledger.deficit() <= 1e-9) << node.name;
    }
    const Node& node = *network.find("between");
    EXPECT_GT(node.ledger.passed, 1e-3);
    const Vector& behind = network.connection(node.branches.front()).state.flow;
    return behind.norm() / network.connection(node.toward_root).state.flow.norm();
  };
  EXPECT_NEAR(flow_behind(Lever()), 0.5, 1e-12);
  EXPECT_NEAR(flow_behind(Spaceball()), 1.0, 1e-12);
}

/// A custom wall in the space of joints, with the functions for walls.
struct Fence : JointSource {
  static constexpr Traits traits{
      .left = Space::joints, .right = Space::joints, .needs_flow = true, .keeps_flow = true};
  Fence() { effort_ = Vector::Constant(2, -3.0); }
  [[nodiscard]] bool saturated() const noexcept { return true; }
  [[nodiscard]] PassivityReport passivity() const noexcept { return {.dissipated = 1.0}; }
};

TEST(Module, TellsOfWallsSaturationAndPassivityWhereItHasThem) {
  Vector torques = Vector::Ones(2);
  const Module fence{Fence()};
  fence->add_walls({}, torques);
  EXPECT_EQ(torques, Vector(Vector::Constant(2, 4.0)));
  EXPECT_TRUE(fence->saturated());
  EXPECT_EQ(fence->passivity()->dissipated, 1.0);
  const Module ball{Visual()};
  ball->add_walls({}, torques);
  EXPECT_EQ(torques, Vector(Vector::Constant(2, 4.0)));
  EXPECT_FALSE(ball->saturated());
  EXPECT_FALSE(ball->passivity().has_value());
}

}  // namespace module_test
}  // namespace repel::network
