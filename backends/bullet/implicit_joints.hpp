/// @file
/// Rotor inertia, friction and stops at the joints of an arm, solved together with its inertia.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "contacts.hpp"
#include "repel/bullet/arm.hpp"

namespace repel::bullet::detail {

/// What an articulated-body algorithm leaves out at the joints, taken implicitly.
///
/// With M the inertia matrix of the links, c(q, v) the Coriolis, centrifugal and gravity torques, R
/// the rotor inertias, B the viscous friction, K and C stiffness and damping of the stops that are
/// touched, e how far the joint would be beyond its stop after h, and f the Coulomb friction, the
/// acceleration a over a sub-step of h seconds solves
///
///     M a + c = tau - R a - B v' - C v' - K (e + h^2 a) + f,        v' = v + h a
///
/// that is, with D = R + h (B + C) + h^2 K, which is diagonal, and u = tau - (B + C) v - K e,
///
///     (M + D) a = u - c + f,   |f_i| <= F_i,   f_i = -F_i sign(v'_i) unless v'_i = 0.
///
/// D is positive, so no stiffness or friction makes a step unstable. R is in it exactly. A brake
/// that is on adds its torque to F.
class ImplicitJoints {
 public:
  ImplicitJoints(const ArmModel& model, const ArmOptions& options);

  /// Fixes D and u for one sub-step of `h` [s]. Returns u, the torque the engine is to apply when
  /// asked for its free acceleration M^-1 (u - c).
  const Eigen::VectorXd& linearize(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                   const Eigen::VectorXd& torque, double h) noexcept;

  /// Turns `a`, the free acceleration, into the acceleration, and `M_inverse` into (M + D)^-1.
  /// @param braked true when the brakes are on
  /// @param contacts what is found to touch; null for an arm that touches nothing
  void solve(Eigen::MatrixXd& M_inverse, Eigen::VectorXd& a, const Eigen::VectorXd& v, double h,
             bool braked, Contacts* contacts) noexcept;

 private:
  void add_diagonal(Eigen::MatrixXd& W, Eigen::VectorXd& a) noexcept;
  void stand(const Eigen::MatrixXd& W, Eigen::VectorXd& a, const Eigen::VectorXd& v,
             double h) noexcept;
  void find_friction(const Eigen::MatrixXd& W, Eigen::VectorXd& a, const Eigen::VectorXd& v,
                     double h, Contacts* contacts) noexcept;

  Eigen::VectorXd lower_, upper_;                      // [rad]
  Eigen::VectorXd rotor_inertia_, viscous_, coulomb_;  // [kg m^2], [N m s/rad], [N m]
  Eigen::VectorXd brake_;                              // [N m]
  Eigen::VectorXd diagonal_, torque_, most_, friction_, column_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  double stop_stiffness_, stop_damping_;
};

}  // namespace repel::bullet::detail
