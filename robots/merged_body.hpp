// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Merges a body into the link it is fixed to.
#pragma once

#include <repel/world/arm.hpp>

namespace repel::detail {

/// Inertia about the origin of a point mass at `p`.
[[nodiscard]] inline Mat3 point_inertia(double mass, const Vec3& p) {
  return mass * (p.squaredNorm() * Mat3::Identity() - p * p.transpose());
}

/// Adds mass, centre of mass and inertia of a body to those of `link`.
/// @param I_C [kg m^2] of the body about its centre of mass, in axes of X_LC
inline void add_body(double mass, const Mat3& I_C, const Pose& X_LC, ArmLink& link) {
  const double total = link.mass + mass;
  // Without any mass the centre is undefined, but the inertia still counts.
  const Vec3 centre = total > 0.0
                          ? Vec3((link.mass * link.p_LC + mass * X_LC.translation()) / total)
                          : Vec3(X_LC.translation());
  link.I_C_L += point_inertia(link.mass, link.p_LC - centre) +
                X_LC.linear() * I_C * X_LC.linear().transpose() +
                point_inertia(mass, X_LC.translation() - centre);
  link.p_LC = centre;
  link.mass = total;
}

}  // namespace repel::detail
