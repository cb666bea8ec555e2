// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The description of a network, and the checks before it runs.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <repel/network/machinery/prediction.hpp>
#include <repel/network/network.hpp>

namespace repel::network {

namespace detail {
class Planner;
}

/// What the right port of a module is connected to: by default the next module of the plan. Only a
/// junction can be connected to more than one; a module connected to none ends a branch.
struct To {
  To() = default;
  // NOLINTBEGIN(google-explicit-constructor): a name stands for itself.
  /// The module of that name.
  To(const char* name) : names{name}, next(false) {}
  /// The module of that name.
  To(std::string name) : names{std::move(name)}, next(false) {}
  /// The modules of these names; empty: none.
  To(std::initializer_list<std::string> list) : names(list), next(false) {}
  /// The modules of these names; empty: none.
  To(std::vector<std::string> list) : names(std::move(list)), next(false) {}
  // NOLINTEND(google-explicit-constructor)
  std::vector<std::string> names;  ///< of modules of the plan
  bool next = true;                ///< the next module, whatever `names` holds
};

/// A list of modules from the operator to the robot. Each is connected to the next, or to the one
/// it names:
///
///     Network network = Plan()
///         .add("torque_arm", TorqueArm())
///         .add("multiplex", Multiplex())
///         .add("kbb2", Kbb2())
///         .add("puma_kin", PumaKin())
///         .add("puma_joints", PumaJoints(6))
///         .build(0.0025);
///
/// Branches meet at a `Junction`: `.add("hand", Mass<any_size>(M), "junction")` ends there, and
/// `.add("junction", Junction(), {"left_arm", "right_arm"})` continues to both.
class Plan {
 public:
  static constexpr std::size_t most_modules = 32;  ///< modules of one plan
  /// Nodes of a network: its modules and a prediction.
  static constexpr std::size_t most_nodes = most_modules + 1;

  /// @param name unique; `to` what its right port is connected to
  Plan& add(std::string name, Module module, To to = {}) &;
  /// The same for a plan without a name, so that calls can follow each other.
  Plan&& add(std::string name, Module module, To to = {}) &&;

  /// Checks the structure and prepares every module for `period` [s].
  /// @throws SetupError, naming the modules, for: a duplicate or unknown name, too many connections
  /// at a port or none, spaces or sizes that do not match, a delay-free loop, two modules imposing
  /// their flow, a nonlinear module without a measured flow, and a rigid or slack part making the
  /// network singular
  [[nodiscard]] Network build(double period) const { return build(period, std::nullopt); }
  /// The same with a module `prediction` after the others. On its one side are the module measuring
  /// its flow and the walls needing this flow, on the other all else. Without a measured flow: as
  /// above. Gains that are `automatic` suit the `robot`.
  [[nodiscard]] Network build(double period, const std::optional<PredictionOptions>& prediction,
                              const RobotEnd& robot = {}) const;

 private:
  struct Entry {
    std::string name;
    Module module;
    To to;
  };
  [[nodiscard]] std::ptrdiff_t find(const std::string& name) const;
  void lay_out(Network& network, detail::Planner& planner) const;
  static bool insert(const PredictionOptions& options, std::vector<Node>& nodes,
                     std::vector<Connection>& connections);
  static void require_solvable(const Network& network, const Signals& rest);

  std::vector<Entry> entries_;
};

namespace detail {

/// Signals of an arm at rest whose Jacobian has full rank.
Signals neutral_signals(int joints, double period);

/// Sets the arm, space, size, side of the root and period of a module.
void ready(Node& node, const Connection& first, Side root, double period, const RobotEnd& robot);

}  // namespace detail

}  // namespace repel::network
