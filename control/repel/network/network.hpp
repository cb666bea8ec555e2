// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A network of modules: solved once per tick, leaves to root and back.
#pragma once

#include <string>
#include <vector>

#include <repel/network/machinery/ledger.hpp>
#include <repel/network/module.hpp>

namespace repel::network {

class Prediction;

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
  [[nodiscard]] Vec<any_size> effort() const noexcept;
  /// Flow from left to right, the same on both sides [m/s], [rad/s].
  [[nodiscard]] const Vec<any_size>& flow() const noexcept { return state.flow; }
  /// Power from left to right [W].
  [[nodiscard]] double power() const noexcept;
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
  bool run(const Signals& signals) noexcept;

  /// Torques of all walls and limits on the joints, as of the last `run` [N m].
  [[nodiscard]] const Vec<any_size>& walls() const noexcept { return walls_; }
  /// Prediction::foreseen; zero without a prediction.
  [[nodiscard]] Vec<any_size> foreseen(const Vec<any_size>& total) const noexcept;
  /// Prediction::given_up; zero without a prediction.
  [[nodiscard]] Vec<any_size> given_up(const Vec<any_size>& change) const noexcept;

  /// The modules, in the order of the plan.
  [[nodiscard]] const std::vector<Node>& nodes() const noexcept { return nodes_; }
  /// The connections; a Node names them by index.
  [[nodiscard]] const std::vector<Connection>& connections() const noexcept { return connections_; }

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
  [[nodiscard]] const Node* find(std::string_view name) const noexcept;
  /// Name of the module at which the last failed `run` stopped.
  [[nodiscard]] const std::string& stuck_at() const noexcept;
  /// One of `connections`, by its index in a Node.
  [[nodiscard]] const Connection& connection(int index) const noexcept;

 private:
  friend class Plan;
  /// A module, or one end of a line.
  struct Step {
    int node = 0;
    Side side = Side::left;  ///< of a line: which end
  };

  void predict(const Signals& signals) noexcept;
  // Null when there is none.
  [[nodiscard]] const Prediction* prediction() const noexcept;
  bool stuck(const Step& step) noexcept;
  [[nodiscard]] Connection& at(int index) noexcept;
  [[nodiscard]] Node& node_at(const Step& step) noexcept;
  /// The connection of a one-port or of an end of a line.
  [[nodiscard]] int only_connection(const Step& step) noexcept;
  // Towards the root: the equivalent that the module shows, from those of its branches.
  [[nodiscard]] bool show(const Step& step) noexcept;
  [[nodiscard]] bool show_junction(const Junction& junction, const Node& node) noexcept;

  // Away from the root: the states of the branches from that at the root.
  void settle(const Step& step) noexcept;

  // At most one branch imposes its flow on a common-flow junction (its effort on a common-effort
  // one): it takes what the others leave.
  void settle_junction(const Junction& junction, Node& node) noexcept;

  // The root and everything behind it share one flow, and their efforts sum to zero.
  [[nodiscard]] bool solve(const Step& root) noexcept;
  void settle_root(const Step& root) noexcept;

  void keep_accounts(double period) noexcept;
  // An end of a line is either the root of its tree or a leaf of it.
  [[nodiscard]] double sign_of_end(int index, const Node& node) noexcept;

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

}  // namespace repel::network
