// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/machinery/planner.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/setup_error.hpp>

namespace repel::network::detail {

void Planner::connect(int from, int to) {
  Connection c;
  c.left = nodes_[from].name;
  c.right = nodes_[to].name;
  c.left_node = from;
  c.right_node = to;
  connections_.push_back(c);
}

void Planner::check_ports() {
  for (int i = 0; i < count(); ++i) {
    const auto [in, out] = ports_of(i);
    const bool junction = nodes_[i].module.ports() == Ports::junction;
    if (junction && in + out < 2) fail(i, "joins fewer than two ports");
    if (junction) continue;
    if (is_one_port_at(i) && in + out != 1) {
      fail(i, "is a one-port and has " + std::to_string(in + out) + " connections; use a junction");
    }
    if (!is_one_port_at(i) && (in > 1 || out > 1)) {
      fail(i, "has more than one module on its " + std::string(in > 1 ? "left" : "right") +
                  " port; use a junction");
    }
    if (!is_one_port_at(i) && in + out != 2) {
      fail(i, std::string("has nothing on its ") + (in == 0 ? "left" : "right") +
                  " port; a chain ends with a one-port");
    }
  }
}

void Planner::find_spaces() {
  for (std::size_t round = 0; round <= connections_.size(); ++round) {
    for (Connection& c : connections_) {
      settle_space(c, own_space(c.left_node, Side::right));
      settle_space(c, own_space(c.right_node, Side::left));
      settle_space(c, passed_on(c.left_node));
      settle_space(c, passed_on(c.right_node));
    }
  }
  for (const Connection& c : connections_) {
    if (c.space == Space::any) {
      throw SetupError("nothing says what passes between '" + c.left + "' and '" + c.right +
                       "': no module there belongs to a lever, a tool or joints");
    }
  }
}

void Planner::find_sizes() {
  int joints = 0;
  for (const Node& node : nodes_) {
    const bool of_joints = node.traits.left == Space::joints || node.traits.right == Space::joints;
    const int own = of_joints ? node.module->size() : 0;
    if (own > 0 && joints > 0 && own != joints) {
      throw SetupError("'" + node.name + "' has " + std::to_string(own) +
                       " joints, a module before it " + std::to_string(joints));
    }
    joints = std::max(joints, own);
  }
  joints_ = joints;
  for (Connection& c : connections_) {
    c.size = c.space == Space::lever ? 1 : c.space == Space::tool ? 6 : joints;
    if (c.size == 0) {
      throw SetupError("'" + c.left + "' is joined to '" + c.right +
                       "' in joints, and no module says how many there are");
    }
  }
}

std::vector<Planner::Vertex> Planner::order() {
  make_vertices();
  std::vector<Vertex> ordered;
  for (;;) {
    const int root = next_root();
    if (root < 0) break;
    std::vector<int> tree{root};
    vertices_[root].reached = true;
    for (std::size_t i = 0; i < tree.size(); ++i) grow(tree, tree[i]);
    check_part(tree);
    std::reverse(tree.begin(), tree.end());
    for (const int v : tree) ordered.push_back(vertices_[v]);
  }
  return ordered;
}

void Planner::fail(int node, const std::string& what) const {
  throw SetupError("module '" + nodes_[node].name + "' " + what);
}

bool Planner::is_one_port_at(int node) const {
  return nodes_[node].module.ports() == Ports::one;
}

std::pair<int, int> Planner::ports_of(int node) const {
  int in = 0;
  int out = 0;
  for (const Connection& c : connections_) {
    in += c.right_node == node ? 1 : 0;
    out += c.left_node == node ? 1 : 0;
  }
  return {in, out};
}

Space Planner::own_space(int node, Side side) const {
  const Traits& traits = nodes_[node].traits;
  const Space here = side == Side::left ? traits.left : traits.right;
  const Space there = side == Side::left ? traits.right : traits.left;
  return here == Space::any && is_one_port_at(node) ? there : here;
}

Space Planner::passed_on(int node) const {
  const Traits& traits = nodes_[node].traits;
  if (traits.left != Space::any || traits.right != Space::any) return Space::any;
  for (const Connection& c : connections_) {
    if ((c.left_node == node || c.right_node == node) && c.space != Space::any) return c.space;
  }
  return Space::any;
}

void Planner::settle_space(Connection& c, Space space) {
  if (space == Space::any || c.space == space) return;
  if (c.space != Space::any) {
    throw SetupError("'" + c.left + "' cannot be joined to '" + c.right + "': one side is " +
                     name_of(c.space) + ", the other " + name_of(space));
  }
  c.space = space;
}

void Planner::make_vertices() {
  for (int i = 0; i < count(); ++i) {
    if (nodes_[i].module.ports() != Ports::line) {
      vertices_.push_back({i, Side::left, {}, -1, false});
      for (int c = 0; c < static_cast<int>(connections_.size()); ++c) {
        const bool here = connections_[c].left_node == i || connections_[c].right_node == i;
        if (here) vertices_.back().connections.push_back(c);
      }
      continue;
    }
    for (int c = 0; c < static_cast<int>(connections_.size()); ++c) {
      if (connections_[c].right_node == i) vertices_.push_back({i, Side::left, {c}, -1, false});
      if (connections_[c].left_node == i) vertices_.push_back({i, Side::right, {c}, -1, false});
    }
  }
}

bool Planner::measures(int vertex) const {
  return nodes_[vertices_[vertex].node].traits.measures_flow;
}

int Planner::next_root() const {
  const int n = static_cast<int>(vertices_.size());
  for (int v = 0; v < n; ++v) {
    if (!vertices_[v].reached && measures(v)) return v;
  }
  for (int v = n - 1; v >= 0; --v) {
    if (!vertices_[v].reached && vertices_[v].connections.size() == 1) return v;
  }
  for (int v = 0; v < n; ++v) {
    if (!vertices_[v].reached) fail_loop();
  }
  return -1;
}

int Planner::across(int c, int v) const {
  for (int other = 0; other < static_cast<int>(vertices_.size()); ++other) {
    if (other == v) continue;
    const auto& list = vertices_[other].connections;
    if (std::find(list.begin(), list.end(), c) != list.end()) return other;
  }
  return v;
}

void Planner::grow(std::vector<int>& tree, int v) {
  for (const int c : vertices_[v].connections) {
    if (c == vertices_[v].toward_root) continue;
    const int next = across(c, v);
    if (vertices_[next].reached) fail_loop();
    vertices_[next].reached = true;
    vertices_[next].toward_root = c;
    const int left = connections_[c].left_node;
    connections_[c].root_on_right = left != vertices_[v].node;
    tree.push_back(next);
  }
}

void Planner::fail_loop() const {
  std::vector<int> degree;
  for (const Vertex& v : vertices_) degree.push_back(static_cast<int>(v.connections.size()));
  for (std::size_t round = 0; round < vertices_.size(); ++round) {
    for (int v = 0; v < static_cast<int>(vertices_.size()); ++v) {
      if (degree[v] != 1) continue;
      degree[v] = 0;
      for (const int c : vertices_[v].connections) {
        const int other = across(c, v);
        if (degree[other] > 0) --degree[other];
      }
    }
  }
  std::string names;
  for (int v = 0; v < static_cast<int>(vertices_.size()); ++v) {
    if (degree[v] > 1)
      names += (names.empty() ? "'" : ", '") + nodes_[vertices_[v].node].name + "'";
  }
  throw SetupError("delay-free loop through " + names + "; a line with a delay would cut it");
}

void Planner::check_part(const std::vector<int>& tree) const {
  const int root = tree.front();
  for (const int v : tree) {
    if (v != root && measures(v)) {
      throw SetupError("'" + nodes_[vertices_[root].node].name + "' and '" +
                       nodes_[vertices_[v].node].name +
                       "' both decide their flow; a line between them would part them");
    }
  }
  for (const int v : tree) {
    if (nodes_[vertices_[v].node].traits.needs_flow) check_flow(v, root);
    if (nodes_[vertices_[v].node].traits.at_robot) check_place(v, root);
  }
}

void Planner::check_place(int v, int root) const {
  const int next = across(vertices_[v].toward_root, v);
  if (next == root) return;
  const std::string& name = nodes_[vertices_[v].node].name;
  const std::string& robot = nodes_[vertices_[root].node].name;
  throw SetupError("'" + name + "' must be the last module before '" + robot + "'; '" +
                   nodes_[vertices_[next].node].name + "' stands between them: put it before '" +
                   name + "'");
}

void Planner::check_flow(int v, int root) const {
  const std::string& name = nodes_[vertices_[v].node].name;
  if (!measures(root)) {
    throw SetupError("'" + name + "' is nonlinear and needs a measured flow; join it to a robot (" +
                     "puma_joints), not to '" + nodes_[vertices_[root].node].name + "'");
  }
  for (int at = across(vertices_[v].toward_root, v); at != root;
       at = across(vertices_[at].toward_root, at)) {
    const Node& between = nodes_[vertices_[at].node];
    if (between.traits.keeps_flow) continue;
    fail_second(name, nodes_[vertices_[root].node].name, between.name);
  }
}

void Planner::fail_second(const std::string& name, const std::string& root,
                          const std::string& between) {
  throw SetupError("'" + name + "' is a second nonlinear element beside '" + root + "': '" +
                   between + "' stands between them and gives way; put '" + between +
                   "' on the other side of '" + name + "'");
}

}  // namespace repel::network::detail
