// SPDX-License-Identifier: BSD-3-Clause
#include "setting.hpp"

#include <cstddef>
#include <memory>

#include <repel/network/modules.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::hard_walls {
namespace {

/// @param most [N] and [N m] of the hand
network::Plan hand_of(const ArmModel& arm, double most) {
  std::vector<network::JointRange> ranges;
  for (const ArmLink& link : arm.links) ranges.push_back({link.lower, link.upper});
  return network::Plan()
      .add("torque_arm", network::TorqueArm())
      .add("multiplex", network::Multiplex())
      .add("spaceball", network::Spaceball(
                            {.saturation = 10.0, .angular_saturation = 10.0, .time_constant = 0.0}))
      .add("kbb2", network::Kbb2({.stiffness = 5000.0,
                                  .damping = 250.0,
                                  .force_limit = most,
                                  .angular_stiffness = 150.0,
                                  .angular_damping = 8.0,
                                  .torque_limit = most}))
      .add("obstacle", network::Obstacle())
      .add("puma_kin", network::PumaKin())
      .add("arm_obstacle", network::ArmObstacle())
      .add("limits", network::Limits({}, ranges))
      .add("puma_joints", network::PumaJoints(static_cast<int>(arm.links.size())));
}

void lighten(ArmLink& link, double inertia) {
  link.mass = 0.01;
  link.p_LC = Vec3(0, 0, 0.01);
  link.I_C_L = inertia * Mat3::Identity();
  link.rotor_inertia = link.viscous_friction = link.coulomb_friction = 0.0;
}

}  // namespace

const char* text_of(Way way) {
  constexpr const char* names[] = {"springs",           "hard",
                                   "velocity damper",   "barrier function",
                                   "stopping distance", "velocity damper of the arm",
                                   "OSCBF of the arm"};
  return names[static_cast<std::size_t>(way)];
}
scene::Scene load(const std::string& name) {
  return scene::load(REPEL_SOURCE "/scenes/" + name + ".yaml");
}

runs::DescribedScene described(const Setting& setting, const scene::Scene& scene) {
  runs::DescribedScene described = runs::describe(scene, setting.rate, true);
  const auto change = [&](ForceLaw& law) {
    if (law.passable) return;
    law.damping_may_rise = true;
    law.hold = setting.way == Way::hard ? HoldKind::hard : HoldKind::soft;
  };
  for (ObstacleDescription& obstacle : described.cell.obstacles) change(obstacle.law);
  for (std::size_t i = 0; i < described.cell.arms.size(); ++i) {
    ArmDescription& arm = described.cell.arms[i];
    if (setting.wrist > 0.0) {
      lighten(arm.model.links.back(), setting.wrist);
      lighten(described.robots[i].arm.links.back(), setting.wrist);
      arm.kinematics = std::make_unique<Kinematics>(arm.model);
    }
    change(arm.law);
    if (arm.self_law) change(*arm.self_law);
    arm.network = hand_of(arm.model, setting.hand);
    arm.options.drive_delay += setting.delay;
    // The cell does not know of the torques that act in its place: a joint that they hold is not
    // frozen.
    arm.options.joints.touches |= is_of_arm(setting.way);
  }
  described.cell.gain_check = network::GainCheck::warning;
  described.cell.loose.clear();
  if (!setting.obstacles.empty()) described.cell.obstacles = setting.obstacles;
  return described;
}

}  // namespace repel::hard_walls
