// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads the shapes of a scene file, and tools, which are made of them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <repel/scene/scene.hpp>

#include "yaml.hpp"

namespace repel::scene::detail {

/// What the shapes of a file add up to.
struct ShapeFile {
  std::size_t& hull_points;              ///< of all hulls
  std::vector<std::string>& part_lists;  ///< paths of the lists that parts of meshes are from
};

/// From the keys `color` and `opacity`, each of which may be missing.
[[nodiscard]] Paint paint_of(const Map& map);

/// Reads the keys common to tool parts and obstacles: one part, or those of a mesh.
[[nodiscard]] std::vector<Part> parts_of(const Value& value, const Map& map,
                                         const ShapeFile& shapes);

/// The parts of a `tool`.
[[nodiscard]] std::vector<Part> tool_of(const Value& value, const ShapeFile& shapes);

}  // namespace repel::scene::detail
