// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A network of modules: solved once per tick, leaves to root and back.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <repel/network/machinery/ledger.hpp>
#include <repel/network/machinery/prediction.hpp>
#include <repel/network/module.hpp>

namespace repel::network {

/// A connection of two ports. `shown` and `state` belong to the side away from the root, with
/// effort into that side.
struct Connection {
  std::string left;            ///< name of the module on the left
  std::string right;           ///< and of that on the right
  Space space = Space::any;    ///< of both ports
  int size = 0;                ///< of both ports
  int left_node = -1;          ///< index of the module on the left
  int right_node = -1;         ///< and of that on the right
  bool root_on_right = true;   ///< the module on the right is nearer to the robot
  Equivalent<any_size> shown;  ///< all behind, seen from the root, in this tick
  PortState<any_size> state;   ///< of this tick
  double entering = 0.0;       ///< [W] into the side away from the root, as of the last `run`

  /// Effort that the left side exerts on the right [N], [N m].
  [[nodiscard]] Vec<any_size> effort() const noexcept {
    return root_on_right ? Vec<any_size>(-state.effort) : state.effort;
  }
  /// Flow from left to right, the same on both sides [m/s], [rad/s].
  [[nodiscard]] const Vec<any_size>& flow() const noexcept { return state.flow; }
  /// Power from left to right [W].
  [[nodiscard]] double power() const noexcept {
    return root_on_right ? -state.power() : state.power();
  }
};

/// A module and its connections, by index; -1: none.
struct Node {
  std::string name;           ///< as in the plan
  Module module;              ///< with its state
  Traits traits;              ///< of the module
  int toward_root = -1;       ///< -1 for the root
  std::vector<int> branches;  ///< away from the root; for a line: both its ends
  int left = -1;              ///< of its left port, for two-ports and lines
  Ledger ledger;              ///< the energy of the module since the start
};

/// Built by a Plan (plan.hpp), run once per tick. The power balance of every tick is exact: at
/// every connection both sides have the same flow and opposite efforts, whatever the modules.
class Network {
 public:
  /// Runs one tick. False when some part could not be solved. Set-up rules this out, except for
  /// signals that remove a direction, such as a lever direction of length zero; then every module
  /// has read its inputs and none has advanced. Cost: one visit to each module towards the root and
  /// one back; one inversion of size 6 at a coupling.
  bool run(const Signals& signals) noexcept {
    for (Node& node : nodes_) node.module->read(signals);
    predict(signals);
    for (const Step& step : upward_) {
      if (!show(step)) return stuck(step);
    }
    for (const Step& root : roots_) {
      if (!solve(root)) return stuck(root);
    }
    for (const Step& root : roots_) settle_root(root);
    for (const Step& step : downward_) settle(step);
    keep_accounts(signals.period);
    return true;
  }

  /// Torques of all walls and limits on the joints, as of the last `run` [N m].
  [[nodiscard]] const Vec<any_size>& walls() const noexcept { return walls_; }
  /// Prediction::given_up of the torques `total` [N m]; zero without a prediction.
  [[nodiscard]] Vec<any_size> given_up(const Vec<any_size>& total) const noexcept;

  /// The modules, in the order of the plan.
  [[nodiscard]] std::span<const Node> nodes() const noexcept { return nodes_; }
  /// The connections; a Node names them by index.
  [[nodiscard]] std::span<const Connection> connections() const noexcept { return connections_; }

  /// The node of the first module of type `M`; null when there is none.
  template <class M>
  [[nodiscard]] const Node* node_of() const noexcept {
    for (const Node& node : nodes_) {
      if (node.module.as<M>() != nullptr) return &node;
    }
    return nullptr;
  }
  /// The first module of type `M`; null when there is none.
  template <class M>
  [[nodiscard]] const M* find() const noexcept {
    const Node* node = node_of<M>();
    return node == nullptr ? nullptr : node->module.as<M>();
  }
  /// The node with this name; null when there is none.
  [[nodiscard]] const Node* find(std::string_view name) const noexcept {
    for (const Node& node : nodes_) {
      if (node.name == name) return &node;
    }
    return nullptr;
  }
  /// Name of the module at which the last failed `run` stopped.
  [[nodiscard]] const std::string& stuck_at() const noexcept {
    return nodes_[static_cast<std::size_t>(stuck_)].name;
  }
  /// One of `connections`, by its index in a Node.
  [[nodiscard]] const Connection& connection(int index) const noexcept {
    return connections_[static_cast<std::size_t>(index)];
  }

 private:
  friend class Plan;
  /// A module, or one end of a line.
  struct Step {
    int node = 0;
    Side side = Side::left;  ///< of a line: which end
  };

  void predict(const Signals& signals) noexcept {
    const Eigen::Index n = signals.joints.size();
    walls_.setZero(n);
    wall_damping_.setZero(n, n);
    const bool is_told = signals.wall_damping.rows() == n;
    for (Eigen::Index i = 0; is_told && i < n * n; ++i) {
      wall_damping_.data()[i] = signals.wall_damping.data()[i];
    }
    for (const Node& node : nodes_) {
      node.module->add_walls(signals.jacobian, walls_);
      node.module->add_wall_damping(signals.jacobian, wall_damping_);
    }
    if (prediction_ >= 0) {
      nodes_[static_cast<std::size_t>(prediction_)].module->predict(signals, walls_, wall_damping_);
    }
  }
  bool stuck(const Step& step) noexcept {
    stuck_ = step.node;
    return false;
  }
  [[nodiscard]] Connection& at(int index) noexcept {
    return connections_[static_cast<std::size_t>(index)];
  }
  [[nodiscard]] Node& node_at(const Step& step) noexcept {
    return nodes_[static_cast<std::size_t>(step.node)];
  }
  /// The connection of a one-port or of an end of a line.
  [[nodiscard]] int only_connection(const Step& step) noexcept {
    const Node& node = node_at(step);
    if (node.module.ports() == Ports::line) {
      return node.branches[step.side == Side::left ? 0 : 1];
    }
    return node.toward_root >= 0 ? node.toward_root : node.branches.front();
  }
  // Towards the root: the equivalent that the module shows, from those of its branches.
  [[nodiscard]] bool show(const Step& step) noexcept {
    Node& node = node_at(step);
    if (node.module.ports() == Ports::two) {
      return node.module->reflected(at(node.branches.front()).shown, at(node.toward_root).shown);
    }
    if (const auto* junction = node.module.as<Junction>()) return show_junction(*junction, node);
    node.module->show_end(step.side, at(only_connection(step)).shown);
    return true;
  }
  [[nodiscard]] bool show_junction(const Junction& junction, const Node& node) noexcept {
    Equivalent<any_size>& sum = at(node.toward_root).shown;
    junction.begin(at(node.branches.front()).shown, sum);
    for (std::size_t i = 1; i < node.branches.size(); ++i) {
      if (!junction.add(at(node.branches[i]).shown, sum)) return false;
    }
    return true;
  }

  // Away from the root: the states of the branches from that at the root.
  void settle(const Step& step) noexcept {
    Node& node = node_at(step);
    if (node.module.ports() == Ports::two) {
      Connection& leaf = at(node.branches.front());
      node.module->incident(at(node.toward_root).state, leaf.shown, leaf.state);
    } else if (const auto* junction = node.module.as<Junction>()) {
      settle_junction(*junction, node);
    } else {
      node.module->settle_end(step.side, at(only_connection(step)).state);
    }
  }

  // At most one branch imposes its flow on a common-flow junction (its effort on a common-effort
  // one): it takes what the others leave.
  void settle_junction(const Junction& junction, Node& node) noexcept {
    const bool by_flow = junction.common() == Common::flow;
    const PortState<any_size>& root = at(node.toward_root).state;
    PortState<any_size> left_over = root;
    Connection* insisting = nullptr;
    for (const int index : node.branches) {
      Connection& branch = at(index);
      const Form wanted = by_flow ? Form::impedance : Form::admittance;
      if (branch.shown.form != wanted) {
        insisting = &branch;
        continue;
      }
      if (by_flow) {
        branch.shown.at_flow(root.flow, branch.state);
        left_over.effort -= branch.state.effort;
      } else {
        branch.shown.at_effort(root.effort, branch.state);
        left_over.flow -= branch.state.flow;
      }
    }
    if (insisting != nullptr) insisting->state = left_over;
  }

  // The root and everything behind it share one flow, and their efforts sum to zero.
  [[nodiscard]] bool solve(const Step& root) noexcept {
    Connection& connection = at(only_connection(root));
    Equivalent<any_size> own;
    node_at(root).module->show_end(root.side, own);
    Vec<any_size> flow = own.offset;
    if (own.form == Form::impedance) {
      Equivalent<any_size> sum = connection.shown;
      sum.add_impedance(own.matrix, own.offset);
      const Equivalent<any_size> total = sum;
      if (!sum.take_form(Form::admittance)) return false;
      flow = sum.offset;
      // One refinement step: removes the rounding error in the sum of efforts, which must be zero.
      if (total.form == Form::impedance) {
        const Vec<any_size> rest = total.offset + dense::product<Vec<any_size>>(total.matrix, flow);
        dense::add_product(sum.matrix, rest, flow, -1.0);
      }
      own.at_flow(flow, connection.state);
    } else {
      if (!connection.shown.take_form(Form::impedance)) return false;
      connection.shown.at_flow(flow, connection.state);
      connection.state.effort = -connection.state.effort;
    }
    connection.state.effort = -connection.state.effort;
    return true;
  }
  void settle_root(const Step& root) noexcept {
    PortState<any_size> own = at(only_connection(root)).state;
    own.effort = -own.effort;
    node_at(root).module->settle_end(root.side, own);
  }

  void keep_accounts(double period) noexcept {
    for (Connection& connection : connections_) connection.entering = connection.state.power();
    for (Node& node : nodes_) {
      const double left_weight = node.left < 0 ? 1.0 : node.module->left_weight();
      double in = 0.0;
      double moved = 0.0;
      const auto count = [&](int index, double sign) {
        const double power = (index == node.left ? left_weight : 1.0) * at(index).entering;
        in += sign * power;
        moved += std::abs(power);
      };
      if (node.toward_root >= 0) count(node.toward_root, 1.0);
      const bool line = node.module.ports() == Ports::line;
      for (const int index : node.branches) count(index, line ? sign_of_end(index, node) : -1.0);
      node.ledger.add(period * in, period * moved, period * node.module->supplied());
    }
  }
  // An end of a line is either the root of its tree or a leaf of it.
  [[nodiscard]] double sign_of_end(int index, const Node& node) noexcept {
    const Connection& end = at(index);
    const bool line_on_left = index != node.left;
    return line_on_left == end.root_on_right ? 1.0 : -1.0;
  }

  std::vector<Node> nodes_;
  std::vector<Connection> connections_;
  std::vector<Step> upward_;    // leaves first, without the roots
  std::vector<Step> downward_;  // the same in reverse order
  std::vector<Step> roots_;     // one for each part between lines
  int prediction_ = -1;         // index of its node
  Vec<any_size> walls_;         // [N m] of walls and limits on the joints
  Mat<any_size> wall_damping_;  // [N m s/rad] theirs
  int stuck_ = 0;
};

inline Vec<any_size> Network::given_up(const Vec<any_size>& total) const noexcept {
  if (prediction_ < 0) return Vec<any_size>::Zero(total.size());
  return nodes_[static_cast<std::size_t>(prediction_)].module.as<Prediction>()->given_up(total);
}

}  // namespace repel::network
