// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Poses of an arm all over its workspace.
#pragma once

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include <repel/cell/description.hpp>

namespace repel::detail {

/// Sets the joints `q` [rad] or [m] to pose `index`, from 0: spread evenly over the ranges of the
/// joints, and the same in every run. Joints that turn without end are spread over a turn; those
/// that slide without end stay at the start.
///
/// By multiples of powers of the inverse of the root of x^(n+1) = x + 1, without their integers (M.
/// Roberts, 2018).
inline void draw_pose(const ArmDescription& arm, int index, std::vector<double>& q) {
  constexpr double pi = std::numbers::pi;
  const std::vector<ArmLink>& links = arm.model.links;
  double root = 2.0;
  for (int i = 0; i < 50; ++i) {
    root = std::pow(1.0 + root, 1.0 / (static_cast<double>(links.size()) + 1.0));
  }
  double step = 1.0;
  for (std::size_t i = 0; i < links.size(); ++i) {
    step /= root;
    double lower = links[i].lower;
    double upper = links[i].upper;
    if (links[i].type == JointType::revolute && !(upper - lower <= 2.0 * pi)) {
      lower = -pi;
      upper = pi;
    }
    const double share = 0.5 + (index + 1) * step;
    const double drawn = lower + (share - std::floor(share)) * (upper - lower);
    q[i] = drawn - drawn == 0.0 ? drawn : arm.start[i];
  }
}

}  // namespace repel::detail
