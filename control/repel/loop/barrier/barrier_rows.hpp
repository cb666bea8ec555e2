// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The gaps of one arm that must not close: of its hard contacts, and to the ends of its joints.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/loop/arms/arm_bodies.hpp>
#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/loop/barrier/hard_contacts.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// One gap of an arm, or the speed of a joint, as a row of the constraints on its motion.
struct BarrierRow {
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  PairId pair;             ///< invalid: of a joint
  Vector h;                ///< [m] torques on the joints of 1 N opening the gap
  double gap = 0.0;        ///< [m], [rad] less its margin
  double rate = 0.0;       ///< [m/s] of the gap, positive on retreat
  double others = 0.0;     ///< [m/s] the part of it from other bodies
  double bending = 0.0;    ///< [m/s^2] of the rate at constant joint rates
  double top_speed = 0.0;  ///< [rad/s] of a joint, in place of the bound of a gap; 0: none
  bool is_shared = false;  ///< another arm can close it too
};

/// Gathers the rows of an arm. Allocates at construction only; on overflow the rows closing first
/// are kept.
class BarrierRows {
 public:
  static constexpr std::size_t most = 64;  ///< rows in one tick

  /// @param margin [m] by which the gaps of walls count as smaller
  BarrierRows(const ArmModel& model, double margin);

  /// @param q [rad] or [m] @param v [rad/s] or [m/s] of the joints, as told @param untold their
  /// untold rates (JointWatch::untold_rate), counted if they close a gap
  /// @param soon [s] rows compare by their gap after this time
  void gather(std::span<const HardContact> contacts, BodyId tool, const Jacobian& jacobian,
              const ArmBodies& links, std::span<const double> q, std::span<const double> v,
              std::span<const double> untold, double soon) noexcept;
  void clear() noexcept { used_ = 0, left_out_ = 0; }  ///< forgets all rows

  /// Rows of this tick for which there was no room.
  [[nodiscard]] std::int32_t left_out() const noexcept { return left_out_; }
  /// The rows of this tick.
  [[nodiscard]] std::span<const BarrierRow> all() const noexcept;

 private:
  static constexpr double margin_of_ranges = 1e-3;  // [rad], [m]
  static constexpr double most_of_speed = 1.3;      // of the speed limit of a joint

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  void add(const HardContact& contact, BodyId tool, const Jacobian& jacobian,
           const ArmBodies& links, std::span<const double> v,
           std::span<const double> untold) noexcept;

  // The body of the last contact on one side: those of a pair come one after the other.
  struct Side {
    const Jacobian* jacobian = nullptr;
    Twist bias;  // bias_of(*jacobian, v)
  };

  // Adds the torques of the wrench `F` on a body. False if the body is not of this arm.
  static bool add_side(Side& side, const Jacobian* jacobian, const Wrench& F,
                       std::span<const double> v, BarrierRow& row) noexcept;

  // A joint at its stop or at its greatest speed transmits no torque, so its limit is a constraint
  // too.
  void add_joint(std::size_t joint, double q, double v, double untold) noexcept;

  // The row after those kept, without a gap.
  [[nodiscard]] BarrierRow& begin_row() noexcept;
  // Keeps it, or on overflow those closing first.
  void keep() noexcept;

  const ArmModel& model_;
  double margin_;      // [m]
  double soon_ = 0.0;  // [s]
  BarrierRow::Vector zero_;
  Side side_a_, side_b_;
  std::vector<BarrierRow> rows_;
  std::size_t used_ = 0;
  std::int32_t left_out_ = 0;
};

}  // namespace repel
