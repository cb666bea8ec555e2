// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What viewers are told of a part besides its shape.
#pragma once

#include <string>

#include <repel/scene/part_list.hpp>

namespace repel::scene {

/// Only looked at: no force depends on it.
struct Shown {
  Gaps gaps{};  ///< of the mesh, in the frame of the part; only of its first part
  /// What it is one of several parts of: an obstacle or part of the file, NAME, or a link of a
  /// model, NAME/LINK; empty: it is all of that.
  std::string of{};
};

}  // namespace repel::scene
