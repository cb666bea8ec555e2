// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads the `robot` of an arm.
#pragma once

#include <repel/scene/scene.hpp>

#include "obstacle_reader.hpp"
#include "yaml.hpp"

namespace repel::scene::detail {

[[nodiscard]] RobotChoice robot_of(const Value& value, const Laws& laws);

}  // namespace repel::scene::detail
