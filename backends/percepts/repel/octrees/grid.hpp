// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A region of an octree of OctoMap as cubes, each solid or not.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include <octomap/OcTree.h>

#include <repel/base/layout.hpp>
#include <repel/cover/occupancy.hpp>

namespace repel::octrees {

/// Defined for the compiler flags of this library: a program with incompatible flags does not link.
void is_built_for(EigenAlignmentHere, VectorRegisterHere) noexcept;
/// Makes the program link `is_built_for`.
[[gnu::used, gnu::retain]] constexpr auto built_alike = &is_built_for;

/// A box along the axes of the map.
struct Region {
  static constexpr std::size_t most = 16'777'216;  ///< cubes

  Vec3 low = Vec3(-2, -2, -2);  ///< [m]
  Vec3 high = Vec3(2, 2, 2);    ///< [m]
};

/// The cubes of edge `cube` [m] that have a part in a region, counted from the origin of the map:
/// cube 0 begins there.
/// @throws SetupError for a region empty, out of a map (32768 cubes on each side of its origin) or
/// of more cubes than Region::most
[[nodiscard]] cover::CubeRange cubes_in(const Region& region, double cube);

/// Reads a file of OctoMap, .bt or .ot, in a child process.
/// @throws SetupError naming the file, if it cannot be read, is too deep, or has cubes outside 1 um
/// to 1 km; also if the reader crashes or exceeds the limits of input_limits for meshes
[[nodiscard]] std::unique_ptr<octomap::OcTree> read_tree(const std::string& path);

/// The smallest range, counted from the origin, with all that a tree knows, occupied or free; the
/// tree has a node.
[[nodiscard]] cover::CubeRange known_range(const octomap::OcTree& tree);

/// The finest cubes of a tree, in a range counted from its origin: solid are the occupied ones, and
/// with `is_unseen_solid` the unknown ones. Cost: about 50 ns for each leaf of the tree in the
/// range and 1 ns a cube.
[[nodiscard]] cover::OccupancyGrid grid_of(const octomap::OcTree& tree,
                                           const cover::CubeRange& range, bool is_unseen_solid);

}  // namespace repel::octrees
