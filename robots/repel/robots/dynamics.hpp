/// @file
/// The equations of motion of an arm, and an arm that obeys them: what simulated arms are measured
/// against.
#pragma once

#include <memory>
#include <span>

#include <Eigen/Core>

#include <repel/base/types.hpp>
#include <repel/robots/built_alike.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// M(q) a + c(q, v) = tau of one arm, by Orocos KDL, with the rotors on the diagonal of M. It holds
/// its state: use one per thread. Spans have one entry per link, base outward.
class Dynamics {
 public:
  using MatrixRef = Eigen::Ref<Eigen::MatrixXd>;

  /// Throws SetupError when `arm` has no link or a value is not finite.
  explicit Dynamics(const ArmModel& arm);
  Dynamics(Dynamics&&) noexcept;
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

/// How finely a ReferenceArm steps.
struct ReferenceOptions {
  int substeps = 16;  ///< equal parts of one `step`; 1 to 100 000
  /// [rad/s] or [m/s], > 0. Coulomb friction grows from none at rest to 76 % at this speed: what
  /// stands by friction alone creeps.
  double friction_speed = 0.01;
  double watchdog = 0.0;  ///< [s] without torques after which the arm stops; 0: never
};

/// An arm that obeys its equations of motion, weight and friction included, by Runge and Kutta's
/// fourth order. Without stops: it turns beyond its limits. Made to be right, not fast, and
/// unstable where friction is strong on little inertia and the sub-step is long. While its brakes
/// are on it moves by the first order instead, with dry friction that stops it and holds it still.
/// Satisfies TorqueDrivenArm and BrakedArm. One thread at a time.
class ReferenceArm {
 public:
  /// Starts at rest at zero. Throws SetupError when a number of `model` or `options` is out of
  /// range, or a joint moves no mass.
  explicit ReferenceArm(const ArmModel& model, const ReferenceOptions& options = {});
  ReferenceArm(ReferenceArm&&) noexcept;
  ReferenceArm& operator=(ReferenceArm&&) noexcept;
  ~ReferenceArm();

  [[nodiscard]] int links() const noexcept;

  /// Puts the arm at `q` [rad] or [m], moving at `v` [rad/s] or [m/s] (at rest when empty),
  /// enabled, with zero torque. Throws SetupError when a size is wrong or an entry is not finite.
  void reset(std::span<const double> q, std::span<const double> v = {});

  /// Joint torques [N m] or forces [N], held until the next call. An entry that is not finite or
  /// missing counts as zero.
  void set_torques(std::span<const double> torques) noexcept;

  /// Moves the arm by `period` [s]; not when that is not finite and positive. A motion that leaves
  /// the range of numbers stops where it was.
  void step(double period) noexcept;

  /// Torques act and the brakes are off, from now on; so the arm begins.
  void enable() noexcept;

  /// No torque acts and the brakes are on, until `enable`. So it ends as well when the watchdog of
  /// the options finds that no torques were set for too long a time of the arm.
  void stop() noexcept;

  /// Brakes on or off while the arm is enabled; no torque acts while they are on.
  void engage_brakes(bool on) noexcept;

  [[nodiscard]] ArmState state() const noexcept;

  /// Joint positions [rad] or [m]; fills as many as `out` holds.
  void read_positions(std::span<double> out) const noexcept;

  /// Joint velocities [rad/s] or [m/s]; fills as many as `out` holds.
  void read_velocities(std::span<double> out) const noexcept;

  /// Kinetic energy [J], rotors included.
  [[nodiscard]] double kinetic_energy() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace repel
