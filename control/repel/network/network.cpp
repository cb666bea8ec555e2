// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/network.hpp>

#include <string>

#include <repel/network/machinery/prediction.hpp>

namespace repel::network {

Vec<any_size> Connection::effort() const noexcept {
  return root_on_right ? Vec<any_size>(-state.effort) : state.effort;
}

double Connection::power() const noexcept {
  return root_on_right ? -state.power() : state.power();
}

bool Network::run(const Signals& signals) noexcept {
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

const Node* Network::find(std::string_view name) const noexcept {
  for (const Node& node : nodes_) {
    if (node.name == name) return &node;
  }
  return nullptr;
}

const std::string& Network::stuck_at() const noexcept {
  return nodes_[static_cast<std::size_t>(stuck_)].name;
}

const Connection& Network::connection(int index) const noexcept {
  return connections_[static_cast<std::size_t>(index)];
}

void Network::predict(const Signals& signals) noexcept {
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

bool Network::stuck(const Step& step) noexcept {
  stuck_ = step.node;
  return false;
}

Connection& Network::at(int index) noexcept {
  return connections_[static_cast<std::size_t>(index)];
}

Node& Network::node_at(const Step& step) noexcept {
  return nodes_[static_cast<std::size_t>(step.node)];
}

int Network::only_connection(const Step& step) noexcept {
  const Node& node = node_at(step);
  if (node.module.ports() == Ports::line) {
    return node.branches[step.side == Side::left ? 0 : 1];
  }
  return node.toward_root >= 0 ? node.toward_root : node.branches.front();
}

bool Network::show(const Step& step) noexcept {
  Node& node = node_at(step);
  if (node.module.ports() == Ports::two) {
    return node.module->reflected(at(node.branches.front()).shown, at(node.toward_root).shown);
  }
  if (const auto* junction = node.module.as<Junction>()) return show_junction(*junction, node);
  node.module->show_end(step.side, at(only_connection(step)).shown);
  return true;
}

bool Network::show_junction(const Junction& junction, const Node& node) noexcept {
  Equivalent<any_size>& sum = at(node.toward_root).shown;
  junction.begin(at(node.branches.front()).shown, sum);
  for (std::size_t i = 1; i < node.branches.size(); ++i) {
    if (!junction.add(at(node.branches[i]).shown, sum)) return false;
  }
  return true;
}

void Network::settle(const Step& step) noexcept {
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

void Network::settle_junction(const Junction& junction, Node& node) noexcept {
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

bool Network::solve(const Step& root) noexcept {
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

void Network::settle_root(const Step& root) noexcept {
  PortState<any_size> own = at(only_connection(root)).state;
  own.effort = -own.effort;
  node_at(root).module->settle_end(root.side, own);
}

void Network::keep_accounts(double period) noexcept {
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

double Network::sign_of_end(int index, const Node& node) noexcept {
  const Connection& end = at(index);
  const bool line_on_left = index != node.left;
  return line_on_left == end.root_on_right ? 1.0 : -1.0;
}

const Prediction* Network::prediction() const noexcept {
  if (prediction_ < 0) return nullptr;
  return nodes_[static_cast<std::size_t>(prediction_)].module.as<Prediction>();
}

Vec<any_size> Network::foreseen(const Vec<any_size>& total) const noexcept {
  const Prediction* known = prediction();
  return known != nullptr ? known->foreseen(total) : Vec<any_size>::Zero(total.size());
}

Vec<any_size> Network::given_up(const Vec<any_size>& change) const noexcept {
  const Prediction* known = prediction();
  return known != nullptr ? known->given_up(change) : Vec<any_size>::Zero(change.size());
}

}  // namespace repel::network
