// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How close the obstacles of a scene are to its tool.
#pragma once

#include "scene.hpp"

namespace repel::scale {

/// The scene of a setting, its obstacles spread so that the mean number of pairs within range is as
/// close to the target as possible.
[[nodiscard]] Scene crowded_scene(const Setting& setting);

}  // namespace repel::scale
