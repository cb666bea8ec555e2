// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Arms that are a little different from their model: with another inertia, or with a payload. To
/// simulate an arm that its controller does not know exactly.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/base/types.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/arm_drive.hpp>

namespace repel {

/// A point mass that is fixed to the tool frame.
struct Payload {
  static constexpr double heaviest = 100.0;  ///< [kg]
  static constexpr double furthest = 10.0;   ///< [m] from the tool frame, along each axis

  double mass = 0.0;   ///< [kg] 0 to `heaviest`; 0: none
  Vec3 p_TC{0, 0, 0};  ///< [m] in the tool frame
};

/// Range of the factor of `with_inertia`.
inline constexpr double least_inertia_factor = 0.3;
inline constexpr double most_inertia_factor = 3.0;  ///< the greatest

namespace detail {

/// Writes the brake torques into the model, so that they stay when its masses change. One without
/// bound stays unknown, which gives the same.
inline void keep_brakes(ArmModel& model) {
  std::vector<double> torques;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    torques.push_back(brake_torque(model, static_cast<int>(i)));
  }
  for (std::size_t i = 0; i < torques.size(); ++i) {
    if (std::isfinite(torques[i])) model.links[i].brake_torque = torques[i];
  }
}

}  // namespace detail

/// The arm with masses, inertias of links and inertias of rotors `factor` times as large, and
/// gravity divided by `factor`, so that every link keeps its weight: the same torques hold it, and
/// accelerate it 1 / `factor` times as much. Friction, brakes and limits stay.
/// @throws SetupError if `factor` is not within `least_inertia_factor` to `most_inertia_factor`
[[nodiscard]] inline ArmModel with_inertia(ArmModel model, double factor) {
  checked("inertia factor", factor, least_inertia_factor, most_inertia_factor, "");
  detail::keep_brakes(model);
  for (ArmLink& link : model.links) {
    link.mass *= factor;
    link.I_C_L *= factor;
    link.rotor_inertia *= factor;
  }
  model.gravity_W /= factor;
  return model;
}

/// The arm with `payload` in its last link: mass, centre of mass and inertia are those of both, by
/// the parallel-axis theorem. Friction, brakes and limits stay.
/// @throws SetupError if mass or position are out of range, or the arm has no link
[[nodiscard]] inline ArmModel with_payload(ArmModel model, const Payload& payload) {
  checked("payload mass", payload.mass, 0.0, Payload::heaviest, "kg");
  for (const double coordinate : payload.p_TC) {
    checked("payload position", coordinate, -Payload::furthest, Payload::furthest, "m");
  }
  if (payload.mass == 0.0) return model;
  if (model.links.empty()) throw SetupError("arm '" + model.name + "' has no link for a payload");
  detail::keep_brakes(model);
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
