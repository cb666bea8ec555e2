// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/default_network.hpp>

#include <vector>

#include <repel/network/modules/arm_obstacle.hpp>
#include <repel/network/modules/kbb2.hpp>
#include <repel/network/modules/limits.hpp>
#include <repel/network/modules/multiplex.hpp>
#include <repel/network/modules/obstacle.hpp>
#include <repel/network/modules/puma_joints.hpp>
#include <repel/network/modules/puma_kin.hpp>
#include <repel/network/modules/relief.hpp>
#include <repel/network/modules/spaceball.hpp>
#include <repel/network/modules/torque_arm.hpp>

namespace repel {

network::Plan default_network(const ArmModel& arm) {
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
