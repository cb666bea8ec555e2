// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the arms of a run look like, for display.
#pragma once

#include <repel/visual/messages.hpp>

#include "prepared_run.hpp"

namespace repel::teleop {

/// Adds the visuals of the arms, as their URDF files have them. Those of a link without a body in
/// the world are left out, as nobody says where it is, and so is collision geometry that is a part
/// of the world. What cannot be read is left out as well, which is said on stderr.
void add_visuals(const PreparedRun& prepared, visual::SceneInfo& info);

}  // namespace repel::teleop
