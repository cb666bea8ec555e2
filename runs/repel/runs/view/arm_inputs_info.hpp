// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a hand can switch in a network, for display.
#pragma once

#include <repel/scene/network.hpp>
#include <repel/visual/arm_info.hpp>

namespace repel::runs {

/// Adds the fixtures, the compliance, the scale and the handles of a network.
void note_inputs(const scene::Network& network, visual::ArmInfo& arm);

}  // namespace repel::runs
