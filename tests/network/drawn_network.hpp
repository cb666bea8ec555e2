// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Small networks and random trees of modules.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <repel/network/modules.hpp>
#include <repel/network/plan.hpp>

#include "network/drawn.hpp"

namespace repel::test {

/// `left` - `module` - `right`. The root is the one-port on that side.
inline network::Network between(const network::Module& left, const network::Module& module,
                                const network::Module& right, Side root) {
  network::Plan plan;
  if (root == Side::right) {
    plan.add("left", left).add("module", module).add("right", right);
  } else {
    plan.add("right", right, "junction").add("left", left).add("module", module, "junction");
    plan.add("junction", network::Junction());
  }
  return plan.build(period);
}

/// Every module that claims to be passive delivered no more energy than it absorbed.
inline void expect_passive(const network::Network& network) {
  for (const network::Node& node : network.nodes()) {
    EXPECT_TRUE(std::isfinite(node.ledger.energy)) << node.name;
    if (node.traits.passive) {
      EXPECT_LE(node.ledger.deficit(), 1e-9)
          << node.name << " is at " << node.ledger.least << " J of " << node.ledger.passed;
    }
  }
}

/// A random plan, drawn from the root outward: as root an arm of any number of joints with walls
/// and limits before it, or a junction, or a one-port; then chains, junctions, lines and couplings.
class DrawnPlan {
 public:
  explicit DrawnPlan(Rng& rng) : rng_(rng) {
    if (chance(0.5)) {
      draw_arm();
    } else if (chance(0.5)) {
      branch("end", space(), 3);
      plan.add("end", drawn_junction());
    } else {
      const network::Space at = space();
      grow("end", at, 4);
      plan.add("end", drawn_mass(at));
    }
  }

  network::Plan plan;
  int joints = 0;

 private:
  [[nodiscard]] bool chance(double p) { return families::uniform(rng_, 0.0, 1.0) < p; }
  [[nodiscard]] network::Space space() {
    return chance(0.3) ? network::Space::lever : network::Space::tool;
  }
  [[nodiscard]] int size_of(network::Space at) const {
    return at == network::Space::lever ? 1 : at == network::Space::tool ? 6 : joints;
  }
  [[nodiscard]] Matrix gain(network::Space at, double low, double high) {
    return drawn_gain(rng_, size_of(at), low, high);
  }
  [[nodiscard]] network::Junction drawn_junction() {
    return network::Junction(chance(0.7) ? network::Common::flow : network::Common::effort);
  }
  [[nodiscard]] network::Mass<any_size> drawn_mass(network::Space at) {
    return network::Mass<any_size>(gain(at, 0.05, 5.0));
  }
  std::string name(const char* kind) { return kind + std::to_string(count_++); }

  void draw_arm() {
    joints = families::count_between(rng_, 1, 8);
    std::string first = "puma_kin";
    if (chance(0.7)) {
      first = "obstacle";
      plan.add("obstacle", network::Obstacle(), "visual").add("visual", network::Visual());
    }
    const bool braked = first != "obstacle" && chance(0.5);
    const bool whole = chance(0.5);
    const std::string next = whole ? "arm_obstacle" : "limits";
    plan.add("puma_kin", network::PumaKin(), braked ? "elbow" : next);
    if (braked) {
      plan.add("brake", network::Damper<any_size>(gain(network::Space::joints, 0.1, 10.0)),
               "elbow");
      plan.add("elbow", network::Junction(), next);
    }
    if (whole) plan.add("arm_obstacle", network::ArmObstacle(), "limits");
    const std::vector<network::JointRange> ranges(static_cast<std::size_t>(joints), {-0.2, 0.2});
    const bool measures = joints % 2 == 0;
    const std::string last = measures ? "force_sensor" : "puma_joints";
    const bool is_redundant = joints > 6;
    plan.add("limits", network::Limits({}, ranges), is_redundant ? "posture" : last);
    if (is_redundant) plan.add("posture", network::Posture(), last);
    if (measures) plan.add("force_sensor", network::ForceSensor(), "puma_joints");
    grow(first, network::Space::tool, 4);
    plan.add("puma_joints", network::PumaJoints(joints));
  }

  void branch(const std::string& to, network::Space at, int depth) {
    const int branches = families::count_between(rng_, 2, 3);
    for (int i = 0; i < branches; ++i) grow(to, at, depth);
  }

  void add(const char* kind, network::Module module, const std::string& to, network::Space behind,
           int depth) {
    const std::string own = name(kind);
    plan.add(own, std::move(module), to);
    grow(own, behind, depth);
  }

  // The module on the left of `to`.
  void grow(const std::string& to, network::Space at, int depth) {
    const bool tool = at == network::Space::tool;
    const int kind = depth > 0 && count_ < 20 ? families::count_between(rng_, 0, 9) : 9;
    if (kind == 0 || kind == 1) {
      const std::string own = name("junction");
      plan.add(own, drawn_junction(), to);
      branch(own, at, depth - 1);
    } else if (kind == 2 || kind == 3) {
      add("kbb2", drawn_kbb2(), to, at, depth - 1);
    } else if (kind == 4 && tool) {
      add("relief", drawn_relief(), to, at, depth - 1);
    } else if (kind == 5 && tool) {
      add("spaceball", network::Spaceball(), to, at, depth - 1);
    } else if (kind == 6) {
      add("visual", network::Visual(), to, at, depth - 1);
    } else if (kind == 7) {
      add("line", drawn_line(), to, at, depth - 1);
    } else if (kind == 8 && tool) {
      const double s_v = families::log_uniform(rng_, 0.01, 1.0);
      const double s_f = chance(0.5) ? s_v : families::log_uniform(rng_, 0.01, 1.0);
      add("multiplex", network::Multiplex({.velocity_scale = s_v, .force_scale = s_f}), to,
          network::Space::lever, depth - 1);
    } else {
      plan.add(name("leaf"), drawn_leaf(at), to);
    }
  }

  [[nodiscard]] network::Module drawn_leaf(network::Space at) {
    const int size = size_of(at);
    switch (families::count_between(rng_, 0, at == network::Space::lever ? 8 : 5)) {
      case 0:
        return network::EffortSource<any_size>(drawn_vector(rng_, size, 10.0));
      case 1:
        return network::FlowSource<any_size>(drawn_vector(rng_, size, 0.2));
      case 2:
        return network::Spring<any_size>(gain(at, 1.0, 1000.0));
      case 3:
        return network::Damper<any_size>(gain(at, 0.1, 100.0));
      case 6:
      case 7:
      case 8:
        return network::TorqueArm({.torque_limit = families::uniform(rng_, 0.0, 5.0)});
      default:
        return drawn_mass(at);
    }
  }
  [[nodiscard]] network::Kbb2 drawn_kbb2() {
    return network::Kbb2({.stiffness = families::log_uniform(rng_, 10.0, 1e5),
                          .damping = families::uniform(rng_, 0.0, 200.0),
                          .shunt = chance(0.5) ? 20.0 : 0.0,
                          .force_limit = families::uniform(rng_, 1.0, 60.0),
                          .angular_damping = families::uniform(rng_, 0.0, 5.0),
                          .angular_shunt = chance(0.5) ? 0.5 : 0.0});
  }
  [[nodiscard]] network::Relief drawn_relief() {
    network::ReliefOptions options;
    for (bool& dof : options.compliant) dof = chance(0.5);
    options.frame = chance(0.5) ? network::ReliefFrame::tool : network::ReliefFrame::world;
    options.stiffness = chance(0.3) ? 0.0 : families::log_uniform(rng_, 10.0, 1e4);
    return network::Relief(options);
  }
  [[nodiscard]] network::Line drawn_line() {
    network::LineOptions options;
    options.channel = {.delay = families::uniform(rng_, 0.0, 0.1),
                       .jitter = chance(0.5) ? 0.02 : 0.0,
                       .loss = chance(0.5) ? 0.1 : 0.0,
                       .seed = rng_()};
    return network::Line(options);
  }

  Rng& rng_;
  int count_ = 0;
};

/// Invariants of every connection and every lossless module in one tick, for any one-ports.
class Laws {
 public:
  explicit Laws(const network::Network& network) : network_(network) {}

  /// Describes the violations; empty if there are none.
  [[nodiscard]] std::string breach() const {
    for (const network::Connection& c : network_.connections()) {
      if (!holds_shown(c)) return c.left + " - " + c.right + " is off what it shows";
    }
    for (const network::Node& node : network_.nodes()) {
      if (!holds(node)) return node.name + " does not pass on what it should";
    }
    return {};
  }

 private:
  // Below a hundredth of a newton, values are residuals of larger terms elsewhere in the network.
  [[nodiscard]] static bool near(const Vector& a, const Vector& b, double scale) {
    return (a - b).norm() <= 1e-8 * (1e-2 + scale + a.norm() + b.norm());
  }
  // Both sides have one state: it must satisfy the equivalent of the far side.
  [[nodiscard]] static bool holds_shown(const network::Connection& c) {
    const bool impedance = c.shown.form == network::Form::impedance;
    const Vector& given = impedance ? c.state.flow : c.state.effort;
    const Vector answer = c.shown.matrix * given;
    return near(answer + c.shown.offset, impedance ? c.state.effort : c.state.flow,
                answer.norm() + c.shown.offset.norm());
  }
  [[nodiscard]] bool holds(const network::Node& node) const {
    if (const auto* m = node.module.as<network::Junction>()) {
      return holds_at_junction(node, m->common());
    }
    if (node.toward_root < 0 || node.branches.size() != 1) return true;
    const State& root = network_.connection(node.toward_root).state;
    const State& leaf = network_.connection(node.branches[0]).state;
    if (node.module.as<network::Relief>() != nullptr ||
        node.module.as<network::Spaceball>() != nullptr) {
      return near(root.effort, leaf.effort, 0.0);
    }
    if (node.module.as<network::Obstacle>() != nullptr ||
        node.module.as<network::Limits>() != nullptr ||
        node.module.as<network::Posture>() != nullptr) {
      return near(root.flow, leaf.flow, 0.0);
    }
    return true;
  }
  [[nodiscard]] bool holds_at_junction(const network::Node& node, network::Common common) const {
    const bool by_flow = common == network::Common::flow;
    const State& root = network_.connection(node.toward_root).state;
    Vector sum = by_flow ? root.effort : root.flow;
    double scale = sum.norm();
    for (const int index : node.branches) {
      const network::Connection& branch = network_.connection(index);
      const State& state = branch.state;
      const bool same =
          near(by_flow ? state.flow : state.effort, by_flow ? root.flow : root.effort, 0.0);
      if (!same) return false;
      sum -= by_flow ? state.effort : state.flow;
      scale += (by_flow ? state.effort : state.flow).norm();
      // Behind a stiff element the effort is a small difference of large terms.
      if ((branch.shown.form == network::Form::impedance) == by_flow) {
        scale += branch.shown.offset.norm();
      }
    }
    return near(sum, 0.0 * sum, scale);
  }

  const network::Network& network_;
};

}  // namespace repel::test
