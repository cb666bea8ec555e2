// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The equations of motion of an arm, and a reference simulation with which simulated arms are
/// compared.
#pragma once

#include <memory>
#include <span>

#include <Eigen/Core>

#include <repel/base/types.hpp>
#include <repel/robots/built_alike.hpp>
#include <repel/simulated/simulated_arm.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// M(q) a + c(q, v) = tau of one arm, by Orocos KDL, with the rotor inertias on the diagonal of M.
/// Not thread-safe: use one instance per thread. Spans have one entry per link, base outward.
class Dynamics {
 public:
  using MatrixRef = Eigen::Ref<Eigen::MatrixXd>;  ///< square, by columns

  /// @throws SetupError if `arm` has no link or a value is not finite
  explicit Dynamics(const ArmModel& arm);
  /// Moves; the other may then only be assigned to or destroyed.
  Dynamics(Dynamics&&) noexcept;
  /// Moves; the other may then only be assigned to or destroyed.
  Dynamics& operator=(Dynamics&&) noexcept;
  ~Dynamics();

  /// The number of moving links.
  [[nodiscard]] int links() const noexcept;

  /// Inertia matrix, links x links [kg m^2] or [kg], motors and gears included.
  void inertia(std::span<const double> q, MatrixRef M) noexcept;

  /// Coriolis, centrifugal and gravity torques c(q, v) [N m] or [N].
  void bias(std::span<const double> q, std::span<const double> v, std::span<double> out) noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Integration parameters of a ReferenceArm.
struct ReferenceOptions {
  int substeps = 16;  ///< equal parts of one `step`; 1 to 100 000
  /// [rad/s] or [m/s], > 0. Coulomb friction is a smooth function of speed, zero at rest and 76 %
  /// of its full value at this speed, so a joint held by friction alone creeps.
  double friction_speed = 0.01;
  double watchdog = 0.0;  ///< [s] without torques after which the arm stops; 0: never
};

/// An arm that integrates its equations of motion, gravity and friction included, by the
/// fourth-order Runge-Kutta method. It has no stops: joints move beyond their limits, and a reset
/// may put them there. It starts at zero and touches nothing. Made for accuracy, not speed, and
/// unstable for strong friction on little inertia with long sub-steps. With the brakes engaged it
/// uses a first-order method with dry friction that stops a joint and holds it still.
class ReferenceArm final : public SimulatedArm {
 public:
  /// @throws SetupError if a number of `model` or `options` is out of range, or a joint moves no
  ///   mass
  explicit ReferenceArm(const ArmModel& model, const ReferenceOptions& options = {});

  /// Kinetic energy [J], rotors included.
  [[nodiscard]] double kinetic_energy() noexcept;
};

}  // namespace repel
