// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What viewers are told of a part besides its shape.
#pragma once

#include <array>
#include <optional>
#include <string>

#include <repel/scene/part_list.hpp>

namespace repel::scene {

/// How it is drawn; what is not given is left to the viewer.
struct Paint {
  std::optional<std::array<double, 3>> color{};  ///< red, green, blue, sRGB, 0 to 1
  std::optional<double> opacity{};               ///< 0.01 to 1
};

/// Only looked at: no force depends on it.
struct Shown {
  Gaps gaps{};  ///< of the mesh, in the frame of the part; only of its first part
  /// What it is one of several parts of: an obstacle or part of the file, NAME, or a link of a
  /// model, NAME/LINK; empty: it is all of that.
  std::string of{};
  Paint paint{};  ///< of all parts of one obstacle alike
};

}  // namespace repel::scene
