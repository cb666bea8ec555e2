// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Rotor inertia, friction and stops at the joints of an arm, solved together with its inertia.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include <repel/simulated/simulated_arm.hpp>
#include <repel/world/arm.hpp>

#include "contacts.hpp"

namespace repel::bullet::detail {

/// The joint effects that an articulated-body algorithm omits, integrated implicitly.
///
/// With M the inertia matrix of the links, c(q, v) the Coriolis, centrifugal and gravity torques, R
/// the rotor inertias, B the viscous friction, K and C stiffness and damping of the active stops, e
/// the predicted penetration of a stop after h at constant velocity, and f the Coulomb friction,
/// the acceleration a over a sub-step of h seconds solves
///
///     M a + c = tau - R a - B v' - C v' - K (e + h^2 a) + f,        v' = v + h a
///
/// that is, with D = R + h (B + C) + h^2 K, which is diagonal, and u = tau - (B + C) v - K e,
///
///     (M + D) a = u - c + f,   |f_i| <= F_i,   f_i = -F_i sign(v'_i) unless v'_i = 0.
///
/// D is positive, so no stiffness or friction makes a step unstable. R enters exactly. An engaged
/// brake adds its torque to F.
class ImplicitJoints {
 public:
  ImplicitJoints(const ArmModel& model, const SimulationOptions& options);

  /// Computes D and u for one sub-step of `h` [s]. Returns u, the torque to apply when the engine
  /// computes its free acceleration M^-1 (u - c).
  const Eigen::VectorXd& linearize(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                   std::span<const double> torque, double h) noexcept;

  /// Replaces the free acceleration `a` by the acceleration, and `M_inverse` by (M + D)^-1.
  /// @param braked true if the brakes are on
  /// @param contacts current contact points; null for an arm without contact
  void solve(Eigen::MatrixXd& M_inverse, Eigen::VectorXd& a, const Eigen::VectorXd& v, double h,
             bool braked, Contacts* contacts) noexcept;

 private:
  void add_diagonal(Eigen::MatrixXd& W, Eigen::VectorXd& a) noexcept;
  void stand(const Eigen::MatrixXd& W, Eigen::VectorXd& a, const Eigen::VectorXd& v,
             double h) noexcept;
  void find_friction(const Eigen::MatrixXd& W, Eigen::VectorXd& a, const Eigen::VectorXd& v,
                     double h, Contacts* contacts) noexcept;

  std::vector<ArmLink> links_;
  SimulationOptions options_;
  Eigen::VectorXd coulomb_, brake_;  // [N m]
  Eigen::VectorXd diagonal_, torque_, most_, friction_, column_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
};

}  // namespace repel::bullet::detail
