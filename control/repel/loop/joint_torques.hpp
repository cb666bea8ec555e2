// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Composes the joint torques from their contributions, within the limits.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <repel/base/status.hpp>
#include <repel/loop/arm_inertia.hpp>
#include <repel/loop/entry_barrier.hpp>
#include <repel/loop/options.hpp>
#include <repel/network/elements/friction.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// The share of each contribution in a tick.
struct TorqueShares {
  double operators = 1.0;  ///< of the network's torques other than walls and limits
  double drive = 1.0;      ///< further factor on these while they deliver power
  double walls = 1.0;      ///< of walls and joint limits
  double friction = 1.0;   ///< of the compensation of dry friction
  double brake = 0.0;      ///< of a damping against all motion
  double gravity = 1.0;    ///< of the gravity compensation
};

/// The part of a torque `asked` [N m] that is allowed for a joint that moves at `v` [rad/s] with
/// speed limit `limit` (0 or infinite: none is known): all of it while it brakes; while it drives,
/// a factor that falls linearly to zero over the last fifth below the limit. It only removes power,
/// so passivity is preserved. The motion of other joints can still carry a joint past its limit.
[[nodiscard]] double within_speed(double asked, double v, double limit) noexcept;

/// Sums the contributions:
///
///     tau = g(q) + operator + walls + friction - M v / brake_time
///
/// within the speed, effort and slew-rate limits of each joint. Braking uses the effort that is
/// left over: all its torques are scaled together, so that it never drives. While a wall pushes the
/// arm along, braking is reduced. Allocates at construction only.
class JointTorques {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param period [s]; @throws SetupError for an option out of range
  JointTorques(const ArmModel& model, double period, const JointTorqueOptions& options);

  /// Buffer for the gravity torques, to be filled before `compose` [N m].
  [[nodiscard]] std::span<double> gravity() noexcept { return gravity_; }

  /// Computes the torques of this tick. @param network all its joint torques [N m]; `walls` the
  /// part of them that comes from walls and limits; `v` [rad/s]
  /// @param barrier before hard walls, or null @param probes [N m] net torques that joints must
  /// exceed, signed, 0 where there is no doubt (StillJoint::probe)
  /// @return status bits
  [[nodiscard]] Status compose(const Vector& network, const Vector& walls, const TorqueShares& s,
                               const std::vector<double>& v, const ArmInertia& inertia,
                               EntryBarrier* barrier = nullptr,
                               std::span<const double> probes = {}) noexcept;

  [[nodiscard]] const std::vector<double>& torques() const noexcept { return torques_; }  ///< [N m]
  /// tau - g of the last tick [N m].
  [[nodiscard]] const Vector& net() const noexcept { return net_; }
  /// What accelerates each joint whatever holds the others: the smaller of `net` and of the torque
  /// that would accelerate it alone as `net` accelerates it with all others [N m]; 0 where they
  /// disagree. Without a barrier the same as `net`: what the network sends is not meant to cancel,
  /// what holds an arm is.
  [[nodiscard]] const Vector& alone() const noexcept { return alone_; }
  /// Predicted rate of each joint one period later with the torques sent and dry friction [rad/s].
  [[nodiscard]] const Vector& expected_rate() const noexcept { return rate_; }

 private:
  static bool is_number(double x) noexcept { return x - x == 0.0; }
  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  // Rejects torques that are not finite; gravity falls back to its last finite value.
  [[nodiscard]] bool keep_sound(const Vector& network, const Vector& walls) noexcept;

  // True when the speed limit of a joint reduced its torque.
  [[nodiscard]] bool share_out(const Vector& network, const Vector& walls, const TorqueShares& s,
                               const std::vector<double>& v) noexcept;

  // Of dry friction [N m]; starts anew after it was switched off.
  [[nodiscard]] double compensation(std::size_t i, double asked, double share) noexcept;

  void probe(std::size_t i, double level) noexcept;

  // Returns the share of the damping M v / brake_time that is applied; its torques are in `brake_`.
  double brake(const Vector& walls, const TorqueShares& s, const std::vector<double>& v,
               const ArmInertia& inertia) noexcept;

  // Sums the contributions, and the range in which the joint can follow.
  [[nodiscard]] Status bound(std::size_t i) noexcept;

  void expect(const std::vector<double>& v, const ArmInertia& inertia, double braking) noexcept;

  // [rad/s] Of a joint with this `momentum`, after a period of friction. Implicit: a light joint is
  // stopped by its friction, and not thrown back.
  [[nodiscard]] double slowed(std::size_t i, double momentum, double v, double mass) const noexcept;

  // The same by the whole inertia matrix.
  void expect_together(const std::vector<double>& v, const ArmInertia& inertia) noexcept;

  static constexpr double give_way = 4.0;

  const ArmModel& model_;
  std::vector<network::FrictionCompensation> friction_;
  double period_;               // [s]
  double brake_time_;           // [s]
  double slew_;                 // largest change in a tick, as a share of the effort
  std::vector<double> effort_;  // [N m] limits
  std::vector<double> gravity_, last_gravity_, torques_;  // [N m]
  std::vector<double> sum_, lower_, upper_;               // [N m] asked for, and its range
  Vector wanted_, brake_, net_, alone_, rate_;
  network::dense::Factored mass_;
  bool has_sent_ = false;
};

}  // namespace repel
