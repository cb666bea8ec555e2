// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The network of an arm whose description has none.
#pragma once

#include <vector>

#include <repel/network/modules.hpp>
#include <repel/network/plan.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// The modules of Anderson 1993, Figure 9, with their defaults: a force-feedback lever and six
/// rates without feedback, coupled to the tool by a spring-damper; walls on tool and links; joint
/// limits.
[[nodiscard]] inline network::Plan default_network(const ArmModel& arm) {
  std::vector<network::JointRange> ranges;
  for (const ArmLink& link : arm.links) ranges.push_back({link.lower, link.upper});
  return network::Plan()
      .add("torque_arm", network::TorqueArm())
      .add("multiplex", network::Multiplex())
      .add("spaceball", network::Spaceball())
      .add("relief", network::Relief())
      .add("kbb2", network::Kbb2())
      .add("obstacle", network::Obstacle())
      .add("puma_kin", network::PumaKin())
      .add("arm_obstacle", network::ArmObstacle())
      .add("limits", network::Limits({}, ranges))
      .add("puma_joints", network::PumaJoints(static_cast<int>(arm.links.size())));
}

}  // namespace repel
