// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The description of a network, and the checks before it runs.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/network/machinery/planner.hpp>
#include <repel/network/network.hpp>

namespace repel::network {

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
  Plan& add(std::string name, Module module, To to = {}) & {
    entries_.push_back({std::move(name), std::move(module), std::move(to)});
    return *this;
  }
  /// The same for a plan without a name, so that calls can follow each other.
  Plan&& add(std::string name, Module module, To to = {}) && {
    return std::move(add(std::move(name), std::move(module), std::move(to)));
  }

  /// Checks the structure and prepares every module for `period` [s].
  /// @throws SetupError, naming the modules, for: a duplicate or unknown name, too many connections
  /// at a port or none, spaces or sizes that do not match, a delay-free loop, two modules that both
  /// impose their flow, a nonlinear module whose flow is not measured, and a rigid or slack part
  /// that makes the network singular
  [[nodiscard]] Network build(double period) const { return build(period, std::nullopt); }
  /// The same with a module `prediction` after the others: it stands between the module that
  /// measures its flow, with the walls that need this flow, and all else. Without a module that
  /// measures its flow: as above. Gains that are `automatic` suit the `robot`.
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
inline Signals neutral_signals(int joints, double period) {
  Signals signals;
  signals.joints.setZero(joints);
  signals.rates = signals.mean_rates = signals.arm_torques = signals.joints;
  signals.jacobian.setZero(6, joints);
  for (int i = 0; i < std::min(6, joints); ++i) signals.jacobian.coeffRef(i, i) = 1.0;
  signals.period = period;
  return signals;
}

/// Sets the arm, space, size, side of the root and period of a module.
inline void ready(Node& node, const Connection& first, Side root, double period,
                  const RobotEnd& robot) {
  try {
    node.module->suit(robot);
    node.module->fit(first.space, first.size);
    if (const int size = node.module->size(); size > 0) {
      checked("size, where '" + first.left + "' is joined to '" + first.right + "',", size,
              first.size, first.size, "");
    }
    node.module->face(root);
    node.module->prepare(period);
  } catch (const SetupError& error) {
    throw SetupError("module '" + node.name + "': " + error.what());
  }
}

}  // namespace detail

inline std::ptrdiff_t Plan::find(const std::string& name) const {
  const auto same = [&](const Entry& entry) { return entry.name == name; };
  return std::find_if(entries_.begin(), entries_.end(), same) - entries_.begin();
}

inline void Plan::lay_out(Network& network, detail::Planner& planner) const {
  const auto count = static_cast<std::ptrdiff_t>(entries_.size());
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const Entry& entry = entries_[i];
    if (find(entry.name) != i) throw SetupError("two modules are called '" + entry.name + "'");
    network.nodes_.push_back({entry.name, entry.module, entry.module->traits(), -1, {}, -1, {}});
  }
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const To& to = entries_[i].to;
    if (to.next && i + 1 < count) planner.connect(static_cast<int>(i), static_cast<int>(i) + 1);
    for (const std::string& name : to.names) {
      const std::ptrdiff_t target = find(name);
      if (target == count || target == i) {
        throw SetupError("module '" + entries_[i].name + "' is joined to '" + name +
                         "'; allowed: the name of another module");
      }
      planner.connect(static_cast<int>(i), static_cast<int>(target));
    }
  }
}

// Moves the left end of the connection that leads from the walls, or from the module that measures
// its flow where there are none, to everything else.
inline bool Plan::insert(const PredictionOptions& options, std::vector<Node>& nodes,
                         std::vector<Connection>& connections) {
  const auto measures = [](const Node& node) { return node.traits.measures_flow; };
  int at = static_cast<int>(std::find_if(nodes.begin(), nodes.end(), measures) - nodes.begin());
  int boundary = -1;
  for (const int count = static_cast<int>(nodes.size()); at < count;) {
    const auto to_left = std::find_if(connections.begin(), connections.end(),
                                      [&](const Connection& c) { return c.right_node == at; });
    if (to_left == connections.end()) break;
    const Traits& traits = nodes[at].traits;
    if (traits.measures_flow || traits.needs_flow) {
      boundary = static_cast<int>(to_left - connections.begin());
    }
    if (!traits.measures_flow && !traits.keeps_flow) break;
    at = to_left->left_node;
  }
  if (boundary < 0) return false;
  const int own = static_cast<int>(nodes.size());
  const Prediction prediction(options);
  nodes.push_back({"prediction", prediction, Prediction::traits, -1, {}, -1, {}});
  Connection& before = connections[boundary];
  Connection after = before;
  after.left = before.right = nodes.back().name;
  after.left_node = before.right_node = own;
  connections.push_back(after);
  return true;
}

inline Network Plan::build(double period, const std::optional<PredictionOptions>& prediction,
                           const RobotEnd& robot) const {
  checked("number of modules", static_cast<double>(entries_.size()), 1, most_modules, "");
  Network network;
  detail::Planner planner(network.nodes_, network.connections_);
  lay_out(network, planner);
  if (prediction && insert(*prediction, network.nodes_, network.connections_)) {
    network.prediction_ = static_cast<int>(network.nodes_.size()) - 1;
  }
  planner.check_ports();
  planner.find_spaces();
  planner.find_sizes();
  for (const auto& vertex : planner.order()) {
    auto& steps = vertex.toward_root < 0 ? network.roots_ : network.upward_;
    steps.push_back({vertex.node, vertex.side});
    Node& node = network.nodes_[vertex.node];
    if (node.module.ports() == Ports::line) {
      node.branches.resize(2);
      node.branches[vertex.side == Side::left ? 0 : 1] = vertex.connections.front();
      continue;
    }
    node.toward_root = vertex.toward_root;
    for (const int c : vertex.connections) {
      if (c != vertex.toward_root) node.branches.push_back(c);
    }
  }
  RobotEnd moved = robot;
  for (const Node& node : network.nodes_) moved = moved.lightened(node.traits.lightens);
  network.downward_.assign(network.upward_.rbegin(), network.upward_.rend());
  for (std::size_t c = 0; c < network.connections_.size(); ++c) {
    network.nodes_[network.connections_[c].right_node].left = static_cast<int>(c);
  }
  for (int i = 0; i < static_cast<int>(network.nodes_.size()); ++i) {
    Node& node = network.nodes_[i];
    const int first = node.branches.empty() ? node.toward_root : node.branches.front();
    const bool on_right =
        node.toward_root >= 0 && network.connection(node.toward_root).left_node == i;
    detail::ready(node, network.connection(first), on_right ? Side::right : Side::left, period,
                  moved);
  }
  require_solvable(network, detail::neutral_signals(planner.joints(), period));
  return network;
}

inline void Plan::require_solvable(const Network& network, const Signals& rest) {
  Network trial = network;
  if (trial.run(rest)) return;
  throw SetupError("the two sides of module '" + trial.stuck_at() +
                   "' both insist: each decides its own flow in some direction, or both decide the "
                   "effort; a compliance between them (kbb2, or relief in all directions) parts "
                   "them");
}

}  // namespace repel::network
