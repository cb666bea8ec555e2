// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A cell that most tests of this folder change a little.
#pragma once

#include <memory>

#include <repel/cell/description.hpp>

#include "loop/slider.hpp"

namespace repel::test {

/// Three sliders with enough friction for the wall 0.2 m in front of their ball.
inline CellDescription sliders() {
  CellDescription cell;
  ArmDescription& arm = cell.arms.emplace_back();
  arm.model = slider_model(1000.0);
  for (ArmLink& link : arm.model.links) link.viscous_friction = 500.0;
  arm.kinematics = std::make_unique<SliderKinematics>();
  arm.parts.push_back({"ball", Shape::sphere(0.05)});
  Pose X_WP = Pose::Identity();
  X_WP.translation().x() = 0.35;
  cell.obstacles.push_back({"wall", Shape::box({0.1, 1.0, 1.0}), X_WP, {}});
  return cell;
}

}  // namespace repel::test
