// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The visuals of the arms of a run, for display.
#pragma once

#include <repel/runs/setup/prepared_run.hpp>
#include <repel/visual/messages.hpp>

namespace repel::runs {

/// Adds the visuals of the arms from their URDF files, and kinematics for an arm having visuals on
/// a link without a body in the world. Collision geometry in the world is left out. So are
/// unreadable files, with a message on stderr.
void add_visuals(const PreparedRun& prepared, visual::SceneInfo& info);

}  // namespace repel::runs
