// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Reads the `script` of an arm: its phases, and what each does to parts and cameras.
#pragma once

#include <vector>

#include <repel/scene/scene.hpp>

#include "yaml.hpp"

namespace repel::scene::detail {

/// Reads it into `setup`, whose network has been read.
/// @param loose which parts can come and go @param cameras which can be silent
void read_script(const Map& of_arm, const std::vector<LoosePart>& loose,
                 const std::vector<CameraChoice>& cameras, ArmSetup& setup);

}  // namespace repel::scene::detail
