// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Decides the joint torques: those asked for, within all bounds.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <repel/base/status.hpp>
#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/loop/barrier/entry_barrier.hpp>
#include <repel/loop/barrier/least_constraint.hpp>
#include <repel/loop/barrier/speed_bounds.hpp>
#include <repel/loop/options.hpp>
#include <repel/network/elements/friction.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// The share of each contribution in a tick.
struct TorqueShares {
  double operators = 1.0;  ///< of the network's torques other than walls and limits
  double drive = 1.0;      ///< further factor on these while they deliver power; 0 lets go
  double walls = 1.0;      ///< of walls and joint limits
  double friction = 1.0;   ///< of the compensation of dry friction
  double brake = 0.0;      ///< of a damping against all motion
  double gravity = 1.0;    ///< of the gravity compensation
};

/// Bounds of the torques, besides those of the arm itself.
struct TorqueBounds {
  EntryBarrier* barrier = nullptr;  ///< before hard walls; null: none is hard
  ToolSpeed tool{};                 ///< how fast the tool may become
  /// [N m] net torques that joints must exceed, signed; 0 without doubt (StillJoint::probe)
  std::span<const double> probes{};
  std::span<const double> q{};  ///< [rad] or [m] of the joints; empty: their ranges do not count
};

/// Decides the torques of an arm. What is asked for is the sum of the contributions,
///
///     tau = g(q) + operator + walls + friction - M v / brake_time
///
/// Braking uses the remaining effort. All its torques are scaled together, so it never drives. It
/// is reduced while a wall pushes the arm along. Of all torques within the bounds, those with the
/// least change of acceleration are sent (LeastConstraint). Of conflicting bounds, the first of
/// these holds: effort and slew rate; hard walls (EntryBarrier); speeds of joints and tool
/// (SpeedBounds). A bound on one torque therefore changes those of the other joints too: a
/// shortfall at a heavy joint would else throw a light one. Allocates at construction only.
class JointTorques {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param period [s] @param drive_delay [ticks] @throws SetupError for an option out of range
  JointTorques(const ArmModel& model, double period, const JointTorqueOptions& options,
               double drive_delay = 0.0);

  /// Buffer for the gravity torques, to be filled before `compose` [N m].
  [[nodiscard]] std::span<double> gravity() noexcept { return gravity_; }

  /// Computes the torques of this tick. @param network all its joint torques [N m]; `walls` the
  /// part of them that comes from walls and limits; `v` [rad/s]
  /// @return status bits
  [[nodiscard]] Status compose(const Vector& network, const Vector& walls, const TorqueShares& s,
                               const std::vector<double>& v, const ArmInertia& inertia,
                               const TorqueBounds& bounds = {}) noexcept;

  [[nodiscard]] const std::vector<double>& torques() const noexcept { return torques_; }  ///< [N m]
  /// tau - g of the last tick [N m].
  [[nodiscard]] const Vector& net() const noexcept { return net_; }
  /// Torque surely accelerating each joint, even with the others held [N m]: the smaller of `net`
  /// and of the torque for the same acceleration of this joint alone; 0 if their signs differ.
  /// Equals `net` if no bound changed a torque and no wall is hard: torques of the network are not
  /// meant to cancel, holding torques are.
  [[nodiscard]] const Vector& alone() const noexcept { return alone_; }
  /// Predicted rate of each joint one period later with the torques sent and dry friction [rad/s].
  [[nodiscard]] const Vector& expected_rate() const noexcept { return rate_; }

 private:
  static bool is_number(double x) noexcept { return x - x == 0.0; }
  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  // Rejects torques not finite; gravity falls back to its last finite value.
  [[nodiscard]] bool keep_sound(const Vector& network, const Vector& walls) noexcept;

  // Sums the torques of operator, walls and friction.
  void share_out(const Vector& network, const Vector& walls, const TorqueShares& s,
                 const std::vector<double>& v) noexcept;

  // Of dry friction [N m]; starts anew after it was switched off.
  [[nodiscard]] double compensation(std::size_t i, double asked, double share) noexcept;

  void probe(std::size_t i, double level) noexcept;

  // Returns the applied share of the damping M v / brake_time; its torques are in `brake_`.
  double brake(const TorqueShares& s, const std::vector<double>& v,
               const ArmInertia& inertia) noexcept;

  // Sums the contributions, and the range in which the joint can follow.
  [[nodiscard]] Status bound(std::size_t i) noexcept;

  // M and the viscous friction until the torque of this tick has acted, by an implicit rule.
  [[nodiscard]] bool begin(const ArmInertia& inertia) noexcept;

  // The torques asked for are within the bounds.
  [[nodiscard]] bool is_within_range() const noexcept;

  // Finds the torques within all bounds.
  [[nodiscard]] Status decide(const std::vector<double>& v, const ArmInertia& inertia,
                              const TorqueBounds& bounds) noexcept;

  void expect(const std::vector<double>& v, const ArmInertia& inertia, double braking) noexcept;

  // [rad/s] Of a joint with this `momentum`, after a period of friction. Implicit: a light joint is
  // stopped by its friction, and not thrown back.
  [[nodiscard]] double slowed(std::size_t i, double momentum, double v, double mass) const noexcept;

  // The same by the whole inertia matrix.
  void expect_together(const std::vector<double>& v, const ArmInertia& inertia) noexcept;

  static constexpr double give_way = 4.0;
  static constexpr int most_rounds = 4;  // until all speeds are kept

  const ArmModel& model_;
  std::vector<network::FrictionCompensation> friction_;
  double period_;               // [s]
  double brake_time_;           // [s]
  double slew_;                 // largest change in a tick, as a share of the effort
  std::vector<double> effort_;  // [N m] limits
  std::vector<double> gravity_, last_gravity_, torques_;  // [N m]
  std::vector<double> sum_, lower_, upper_;               // [N m] asked for, and its range
  Vector walls_, wanted_, brake_, net_, alone_, rate_;
  network::dense::Factored mass_;
  double step_;   // [s] in which a bound of a rate is reached
  double until_;  // [s] until the middle of it
  SpeedBounds speeds_;
  LeastConstraint problem_;
  bool has_sent_ = false;
  bool is_cut_ = false;  // some bound changed a torque
};

}  // namespace repel
