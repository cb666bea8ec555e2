// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Poses of an arm all over its workspace.
#pragma once

#include <vector>

#include <repel/cell/description.hpp>

namespace repel::detail {

/// Sets the joints `q` [rad] or [m] to pose `index`, from 0: spread evenly over the ranges of the
/// joints, and the same in every run. Continuous joints are spread over a turn; prismatic ones
/// without limits stay at the start.
///
/// By multiples of powers of the inverse of the root of x^(n+1) = x + 1, without their integers (M.
/// Roberts, 2018).
void draw_pose(const ArmDescription& arm, int index, std::vector<double>& q);

}  // namespace repel::detail
