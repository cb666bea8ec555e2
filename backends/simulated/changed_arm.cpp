// SPDX-License-Identifier: BSD-3-Clause
#include <repel/simulated/changed_arm.hpp>

#include <cmath>
#include <cstddef>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/simulated/brake_torque.hpp>

namespace repel {

namespace {

/// Writes the brake torques into the model, so that they stay when its masses change. An infinite
/// one stays unknown.
void keep_brakes(ArmModel& model) {
  std::vector<double> torques;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    torques.push_back(brake_torque(model, static_cast<int>(i)));
  }
  for (std::size_t i = 0; i < torques.size(); ++i) {
    if (std::isfinite(torques[i])) model.links[i].brake_torque = torques[i];
  }
}

}  // namespace

ArmModel with_inertia(ArmModel model, double factor) {
  checked("inertia factor", factor, least_inertia_factor, most_inertia_factor, "");
  keep_brakes(model);
  for (ArmLink& link : model.links) {
    link.mass *= factor;
    link.I_C_L *= factor;
    link.rotor_inertia *= factor;
  }
  model.gravity_W /= factor;
  return model;
}

ArmModel with_payload(ArmModel model, const Payload& payload) {
  checked("payload mass", payload.mass, 0.0, Payload::heaviest, "kg");
  for (const double coordinate : payload.p_TC) {
    checked("payload position", coordinate, -Payload::furthest, Payload::furthest, "m");
  }
  if (payload.mass == 0.0) return model;
  if (model.links.empty()) throw SetupError("arm '" + model.name + "' has no link for a payload");
  keep_brakes(model);
  ArmLink& link = model.links.back();
  const double share = payload.mass / (link.mass + payload.mass);
  const Vec3 d = model.X_LT * payload.p_TC - link.p_LC;  // from centre to centre
  const double reduced_mass = share * link.mass;
  link.I_C_L += reduced_mass * (squared_norm(d) * Mat3::Identity() - d * d.transpose());
  link.p_LC = link.p_LC + share * d;
  link.mass += payload.mass;
  return model;
}

}  // namespace repel
