// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/brake_torque.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace repel {

namespace {

/// Greatest distance [m] of the centre of mass of link `i` from the axis of a revolute joint
/// `first`. Infinite where a prismatic joint between them has no stop.
double longest_lever(const ArmModel& model, std::size_t first, std::size_t i) {
  double lever = norm(model.links[i].p_LC);
  for (std::size_t k = first + 1; k <= i; ++k) {
    const ArmLink& link = model.links[k];
    lever += norm(origin(link.X_PJ));
    if (link.type == JointType::revolute) continue;
    lever += std::max(std::abs(link.lower), std::abs(link.upper));
  }
  return lever;
}

}  // namespace

double brake_torque(const ArmModel& model, int joint) {
  const auto first = static_cast<std::size_t>(joint);
  const ArmLink& braked = model.links[first];
  if (braked.brake_torque > 0.0) return braked.brake_torque;
  if (braked.effort_limit > 0.0) return 1.5 * braked.effort_limit;
  const bool turns = braked.type == JointType::revolute;
  double weight = 0.0;                    // [N m] or [N]
  double inertia = braked.rotor_inertia;  // [kg m^2] or [kg]
  for (std::size_t i = first; i < model.links.size(); ++i) {
    const ArmLink& link = model.links[i];
    if (turns) inertia += link.I_C_L.norm();
    if (!(link.mass > 0.0)) continue;  // without weight
    const double lever = turns ? longest_lever(model, first, i) : 1.0;
    weight += link.mass * lever * norm(model.gravity_W);
    inertia += link.mass * lever * lever;
  }
  const double usual_speed = turns ? 3.0 : 1.0;  // [rad/s] or [m/s]
  const double speed = braked.velocity_limit > 0.0 ? braked.velocity_limit : usual_speed;
  return 2.0 * weight + inertia * speed / 0.25;
}

}  // namespace repel
