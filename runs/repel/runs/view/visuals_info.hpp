// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the arms of a run look like, for display.
#pragma once

#include <repel/runs/setup/prepared_run.hpp>
#include <repel/visual/messages.hpp>

namespace repel::runs {

/// Adds the visuals of the arms, as their URDF files have them, and kinematics for an arm in which
/// a link that has some has no body in the world. Collision geometry that is a part of the world is
/// left out, and so is what cannot be read, which is said on stderr.
void add_visuals(const PreparedRun& prepared, visual::SceneInfo& info);

}  // namespace repel::runs
