// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The equations of motion of an arm, and a reference simulation with which simulated arms are
/// compared.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <Eigen/Core>

#include <repel/base/types.hpp>
#include <repel/robots/built_alike.hpp>
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
/// fourth-order Runge-Kutta method. It has no stops: joints move beyond their limits. Made for
/// accuracy, not speed, and unstable for strong friction on little inertia with long sub-steps.
/// With the brakes engaged it uses a first-order method with dry friction that stops a joint and
/// holds it still. It has brakes. One thread at a time.
class ReferenceArm final : public TorqueDrivenArm {
 public:
  /// Starts at rest at zero.
  /// @throws SetupError if a number of `model` or `options` is out of range, or a joint moves no
  ///   mass
  explicit ReferenceArm(const ArmModel& model, const ReferenceOptions& options = {});
  /// Moves; the other may then only be assigned to or destroyed.
  ReferenceArm(ReferenceArm&&) noexcept;
  /// Moves; the other may then only be assigned to or destroyed.
  ReferenceArm& operator=(ReferenceArm&&) noexcept;
  ~ReferenceArm() override;

  /// The number of moving links.
  [[nodiscard]] int links() const noexcept;

  /// Puts the arm at `q` [rad] or [m], moving at `v` [rad/s] or [m/s] (at rest if empty), enabled,
  /// with zero torque.
  /// @throws SetupError if a size is wrong or an entry is not finite
  void reset(std::span<const double> q, std::span<const double> v = {});

  /// Joint torques [N m] or forces [N], held until the next call. An entry that is not finite or
  /// missing counts as zero.
  void set_torques(std::span<const double> torques) noexcept override;

  /// Advances the arm by `period` [s]; does nothing if that is not finite and positive. If the
  /// state would become not finite, the arm stops at its last position.
  void step(double period) noexcept override;

  /// Enables the arm: torques act and the brakes are off. This is the initial state.
  void enable() noexcept override;

  /// Stops the arm: no torque acts and the brakes are on, until `enable`. The watchdog of the
  /// options does the same if no torques are set for its timeout, in simulated time.
  void stop() noexcept override;

  /// Brakes on or off while the arm is enabled; no torque acts while they are on.
  void engage_brakes(bool on) noexcept override;

  /// Whether torques act, or it has been stopped.
  [[nodiscard]] ArmState state() const noexcept override;

  /// Zero: the arm touches nothing.
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override { return Wrench{}; }

  /// Joint positions [rad] or [m]; fills as many as `out` holds.
  void read_positions(std::span<double> out) const noexcept override;

  /// Joint velocities [rad/s] or [m/s]; fills as many as `out` holds.
  void read_velocities(std::span<double> out) const noexcept override;

  /// Kinetic energy [J], rotors included.
  [[nodiscard]] double kinetic_energy() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace repel
