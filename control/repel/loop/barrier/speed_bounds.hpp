// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Bounds of the speeds of joints and tool, among those of the torques.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <repel/base/status.hpp>
#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/loop/barrier/least_constraint.hpp>
#include <repel/network/elements/dense.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// How fast a tool may become.
struct ToolSpeed {
  const network::Jacobian* jacobian = nullptr;             ///< of the tool; null: it is not bounded
  double limit = std::numeric_limits<double>::infinity();  ///< [m/s]
  bool is_carried = false;  ///< pushed by moving walls, as fast as they are
};

/// [m/s] Greatest speed s of approach with a stop within `distance` [m]: distance = reaction s +
/// s^2 / (2 deceleration). 0 for a distance not above 0.
/// @param deceleration [m/s^2] @param reaction [s] until it acts
[[nodiscard]] double braked_within(double distance, double deceleration, double reaction) noexcept;

/// Bounds the speed s of a joint or the tool, if a torque would take it beyond its limit within the
/// horizon h:
///
///     s + h ds/dt <= limit
///
/// So a limit is approached exponentially, and an excess is braked. At a distance d from an end of
/// its range, the speed of a joint is bounded by its stopping distance:
///
///     d = 2 h s + s^2 / (2 a)
///
/// with the deceleration a by its own effort, its inertia taken 1.7 times. With a late drive, the
/// springs ahead of the stops (network/modules/limits.hpp) act too late to stop a fast joint, and
/// throw it back. Dry friction counts: a torque must overcome it before it moves anything. A bound
/// of the tool acts along its predicted velocity: forces across and against it stay as they are.
/// Nothing is scaled, so balanced forces stay balanced.
///
/// Wall forces are bounded only above half the speed limit. Those of moving walls are not: there
/// may be unmodelled objects behind the arm.
class SpeedBounds {
 public:
  /// @param horizon [s] from a torque to its effect, with the delay of the drive
  SpeedBounds(const ArmModel& model, double horizon);

  /// To be called in every tick, before `foresee`: how fast each joint may be. @param q [rad] or
  /// [m] of the joints; empty: the ends of their ranges do not count
  void observe(std::span<const double> q, const ArmInertia& inertia) noexcept;

  /// To be called in every tick, before `bound`. @param mass of the arm @param asked [N m]
  /// @param weight [N m] the part of it carrying the weight
  /// @param v [rad/s] or [m/s] of the joints
  /// @return true if the torques asked for take a joint or the tool beyond its limit Cost: a
  /// solution with the mass matrix, and a product with the Jacobian
  [[nodiscard]] bool foresee(const network::dense::Factored& mass, std::span<const double> asked,
                             std::span<const double> weight, std::span<const double> v,
                             const ToolSpeed& tool) noexcept;
  /// Adds bounds where the solution of a problem makes joints or the tool too fast; the problem
  /// must then be solved again. Once may not suffice: the bound of the tool is a ball, approximated
  /// by tangent planes, and slowing the tool can make a light joint fast.
  /// @param walls [N m] of the walls, by their share
  /// @return false if nothing was added. Cost: a product with the Jacobian, and a solution with the
  /// mass matrix for each bound
  bool bound(LeastConstraint& problem, std::span<const double> v, const ArmInertia::Vector& walls,
             const ToolSpeed& tool) noexcept;
  /// Of the solution: `speed_limit` and `tool_speed` where their bounds changed a torque.
  [[nodiscard]] static Status said(const LeastConstraint& problem) noexcept;

 private:
  // Tolerance of the solution of soft bounds.
  static constexpr double rounding = 1.01;
  static constexpr double of_joints = 5e-3;  // [rad/s] likewise, of joints
  static constexpr double mass_uncertainty = 1.7;
  // Above the limit, so that the full limit is available and a small overshoot is not reported.
  static constexpr double tool_slack = 0.075;

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  // A row for a rate that must not fall below -limit within the horizon. @param h its direction
  // @param rate [m/s] now @param walls left as they are; null: none @return false: overflow
  bool add(LeastConstraint& problem, const ArmInertia::Vector& h, double rate, double limit,
           const ArmInertia::Vector* walls, Status tag) const noexcept;
  bool bound_tool(LeastConstraint& problem, std::span<const double> v,
                  const ArmInertia::Vector& acceleration, const ArmInertia::Vector& walls,
                  const ToolSpeed& tool) noexcept;
  // [m/s] Velocity of the tool after the horizon; `now` receives that of now.
  [[nodiscard]] Vec3 then(const ToolSpeed& tool, std::span<const double> v,
                          const ArmInertia::Vector& acceleration, Vec3& now) const noexcept;
  // [rad/s] Excess of a joint over its limit after the horizon; 0: none.
  [[nodiscard]] double excess(Eigen::Index joint, double v, double acceleration) const noexcept {
    const double then = v + horizon_ * acceleration;
    if (then > up_.coeff(joint)) return then - up_.coeff(joint);
    return std::min(0.0, then + down_.coeff(joint));
  }
  // Of the ends of the range of a joint.
  struct End {
    double limit = 0.0;    // [rad/s] of the joint
    double effort = 0.0;   // [N m] over `mass_uncertainty`
    double late = 0.0;     // [rad] way until a torque acts, at the limit
    double braking = 0.0;  // [rad/(kg m^2)] way of braking from the limit, for its inertia
  };

  const ArmModel& model_;
  std::vector<End> ends_;
  double horizon_;                // [s]
  ArmInertia::Vector driven_;     // [rad/s^2] by the torques asked for, less friction
  ArmInertia::Vector friction_;   // [rad/s^2] of this, that of friction
  ArmInertia::Vector down_, up_;  // [rad/s] limits of this tick towards the ends of the ranges
};

}  // namespace repel
