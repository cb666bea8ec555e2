/// @file
/// What a description of an arm must hold before an engine can move it. Set-up only.
#pragma once

#include <Eigen/Eigenvalues>
#include <cmath>
#include <limits>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/world/arm.hpp>

namespace repel {

namespace detail {

inline void require(bool fact, const ArmLink& link, const std::string& otherwise) {
  if (!fact) throw SetupError("joint '" + link.joint_name + "': " + otherwise);
}

inline void require_simulable(const ArmLink& link) {
  const auto not_negative = [&](const char* what, double value, const char* unit) {
    checked("joint '" + link.joint_name + "': " + what, value, 0.0,
            std::numeric_limits<double>::max(), unit);
  };
  not_negative("mass", link.mass, "kg");
  not_negative("viscous friction", link.viscous_friction, "N m s/rad");
  not_negative("Coulomb friction", link.coulomb_friction, "N m");
  not_negative("rotor inertia", link.rotor_inertia, "kg m^2");
  require(is_finite(link.X_PJ) && is_rigid(link.X_PJ), link, "X_PJ is not a rigid pose");
  require(std::abs(link.axis_J.norm() - 1.0) <= 1e-9, link, "axis_J is not of unit length");
  require(is_finite(link.p_LC), link, "the centre of mass is not finite");
  require(link.I_C_L.allFinite() && link.I_C_L.isApprox(link.I_C_L.transpose(), 1e-9), link,
          "the inertia is not a finite symmetric matrix");
  const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(link.I_C_L).eigenvalues();
  require(moments.minCoeff() >= -1e-9 * moments.maxCoeff(), link,
          "the inertia has a negative principal moment");
  require(link.lower < link.upper, link,
          "the limits are " + to_text(link.lower) + " to " + to_text(link.upper) +
              "; the lower must be below the upper (-inf and inf: no stop)");
}

}  // namespace detail

/// Throws SetupError that names the joint and the number of `model` no engine can move: a pose that
/// is not rigid, an axis that is not of unit length, a mass, friction or inertia below zero or not
/// finite, limits out of order.
inline void require_simulable(const ArmModel& model) {
  if (model.links.empty()) throw SetupError("arm '" + model.name + "' has no links");
  if (!is_finite(model.X_WB) || !is_rigid(model.X_WB)) {
    throw SetupError("arm '" + model.name + "': X_WB is not a rigid pose");
  }
  if (!is_finite(model.gravity_W)) {
    throw SetupError("arm '" + model.name + "': gravity is not finite");
  }
  for (const ArmLink& link : model.links) detail::require_simulable(link);
}

}  // namespace repel
