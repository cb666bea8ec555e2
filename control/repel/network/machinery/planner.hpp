// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Arranges a list of modules into trees that can be solved, or reports why it cannot.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <repel/network/network.hpp>

namespace repel::network::detail {

/// Arranges a list of modules into a tree for each part between lines. Single use.
class Planner {
 public:
  Planner(std::vector<Node>& nodes, std::vector<Connection>& connections)
      : nodes_(nodes), connections_(connections) {}

  /// A vertex is a module, or one end of a line.
  struct Vertex {
    int node = 0;
    Side side = Side::left;
    std::vector<int> connections;
    int toward_root = -1;
    bool reached = false;
  };

  void connect(int from, int to);
  void check_ports();

  /// Determines the space of every connection, from the modules that declare theirs.
  void find_spaces();
  void find_sizes();
  [[nodiscard]] int joints() const noexcept { return joints_; }

  /// Splits at the lines, picks each root, and returns all vertices, leaves before roots.
  [[nodiscard]] std::vector<Vertex> order();

 private:
  [[nodiscard]] int count() const noexcept { return static_cast<int>(nodes_.size()); }
  [[noreturn]] void fail(int node, const std::string& what) const;
  [[nodiscard]] bool is_one_port_at(int node) const;
  [[nodiscard]] std::pair<int, int> ports_of(int node) const;
  // Declared space of a port; a one-port has only one, whichever side is connected.
  [[nodiscard]] Space own_space(int node, Side side) const;
  // The space that a module without a declared one passes from some connection to the others.
  [[nodiscard]] Space passed_on(int node) const;
  static void settle_space(Connection& c, Space space);

  void make_vertices();
  [[nodiscard]] bool measures(int vertex) const;
  // Modules that impose their flow first, then the ends of chains, the later ones first.
  [[nodiscard]] int next_root() const;
  // The other end of connection `c` seen from vertex `v`.
  [[nodiscard]] int across(int c, int v) const;
  void grow(std::vector<int>& tree, int v);
  // Names the modules with at least two connections left after repeated removal of all leaves.
  [[noreturn]] void fail_loop() const;

  void check_part(const std::vector<int>& tree) const;
  void check_place(int v, int root) const;
  void check_flow(int v, int root) const;
  [[noreturn]] static void fail_second(const std::string& name, const std::string& root,
                                       const std::string& between);

  std::vector<Node>& nodes_;
  std::vector<Connection>& connections_;
  std::vector<Vertex> vertices_;
  int joints_ = 0;
};

}  // namespace repel::network::detail
