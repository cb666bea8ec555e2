// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads maps of OctoMap.
#pragma once

#include <string>

#include <repel/cover/occupancy.hpp>

namespace repel::cover {

/// Whether a file is such a map, by the end of its name: .bt or .ot.
[[nodiscard]] bool is_octree(const std::string& path);

/// The cubes of a map, those that are occupied; those that nobody has seen, within the box around
/// all that is known, are solid if `is_unseen_solid`.
/// @throws SetupError naming the file, if it cannot be read, or this build cannot read such files
[[nodiscard]] OccupancyGrid read_octree(const std::string& path, bool is_unseen_solid);

}  // namespace repel::cover
