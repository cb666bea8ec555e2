// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/plan.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/network/machinery/planner.hpp>

namespace repel::network {

Plan& Plan::add(std::string name, Module module, To to) & {
  entries_.push_back({std::move(name), std::move(module), std::move(to)});
  return *this;
}

Plan&& Plan::add(std::string name, Module module, To to) && {
  return std::move(add(std::move(name), std::move(module), std::move(to)));
}

}  // namespace repel::network

namespace repel::network::detail {

Signals neutral_signals(int joints, double period) {
  Signals signals;
  signals.joints.setZero(joints);
  signals.rates = signals.mean_rates = signals.arm_torques = signals.joints;
  signals.jacobian.setZero(6, joints);
  for (int i = 0; i < std::min(6, joints); ++i) signals.jacobian.coeffRef(i, i) = 1.0;
  signals.period = period;
  return signals;
}

void ready(Node& node, const Connection& first, Side root, double period, const RobotEnd& robot) {
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

}  // namespace repel::network::detail

namespace repel::network {

std::ptrdiff_t Plan::find(const std::string& name) const {
  const auto same = [&](const Entry& entry) { return entry.name == name; };
  return std::find_if(entries_.begin(), entries_.end(), same) - entries_.begin();
}

void Plan::lay_out(Network& network, detail::Planner& planner) const {
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

bool Plan::insert(const PredictionOptions& options, std::vector<Node>& nodes,
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

Network Plan::build(double period, const std::optional<PredictionOptions>& prediction,
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

void Plan::require_solvable(const Network& network, const Signals& rest) {
  Network trial = network;
  if (trial.run(rest)) return;
  throw SetupError("the two sides of module '" + trial.stuck_at() +
                   "' both insist: each decides its own flow in some direction, or both decide the "
                   "effort; a compliance between them (kbb2, or relief in all directions) parts "
                   "them");
}

}  // namespace repel::network
