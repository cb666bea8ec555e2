// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The principle of least constraint: torques within their limits, keeping rates above their bounds
/// at the least change of acceleration.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/network/elements/dense.hpp>

namespace repel {

/// Finds the torques tau that minimize (tau - asked)' M^-1 (tau - asked), subject to
///
///     h_k' (v + step M^-1 (tau - weight)) >= least_k      lower <= tau <= upper
///
/// (C. F. Gauss 1829). The duals f_k >= 0 act like forces of frictionless bodies, and like stops at
/// the torque limits. A dual active set (D. Goldfarb, A. Idnani 1983): the most violated bound is
/// added until none is left, so the result is exact after about one step for each active bound.
///
/// Each bound of a rate gives way by a share of its mobility. If the limits leave no solution, the
/// bounds are missed by the least sum of squares, each over its share: the softest first. Allocates
/// at construction only.
class LeastConstraint {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  static constexpr double firm = 1e-7;  ///< gives way to nothing but the limits
  static constexpr double soft = 1e-5;  ///< gives way to firm bounds

  /// One bound.
  struct Row {
    Vector h;                 ///< [m] torques of 1 N along the direction of the rate
    Vector moved;             ///< M^-1 h, set by `add`
    double rate = 0.0;        ///< [m/s] without any net torque
    double least_rate = 0.0;  ///< [m/s]
    double mobility = 0.0;    ///< [1/kg] h' M^-1 h, set by `add`
    double give = firm;       ///< share of the mobility
    std::uint32_t tag = 0;    ///< of who added it
    double force = 0.0;       ///< [N] f, found by `solve`
  };

  /// Allocates for so many joints and rows.
  LeastConstraint(std::size_t joints, std::size_t most_rows);

  /// Begins a problem. @param mass M, with other braking in proportion to the rates
  /// @param step [s] @return false if M is not positive definite
  template <class Entry>
  [[nodiscard]] bool begin(Eigen::Index joints, const Entry& mass, double step) noexcept {
    used_ = 0;
    has_inverse_ = false;
    step_ = step;
    for (Eigen::Index i = 0; i < joints * joints; ++i) M_.data()[i] = mass(i);
    return mass_.factor(joints, mass);
  }
  /// Takes the torques asked for: after `begin`, before `solve`. The spans must stay valid.
  /// @param asked [N m], may be beyond the limits @param weight [N m] the part of it carrying the
  /// weight
  void ask(std::span<const double> asked, std::span<const double> weight) noexcept;
  /// [N m] Torques asked for beyond the weight.
  [[nodiscard]] double asked(std::size_t joint) const noexcept {
    return asked_.coeff(index(joint)) - weight_[joint];
  }
  /// [rad/s^2] With the torques asked for.
  [[nodiscard]] const Vector& asked_acceleration() const noexcept { return freely_; }
  [[nodiscard]] double step() const noexcept { return step_; }  ///< [s]

  /// M, in factors.
  [[nodiscard]] const network::dense::Factored& mass() const noexcept { return mass_; }

  /// @return the row (its `least_rate` may still be set); null: overflow
  [[nodiscard]] Row* add(const Vector& h, double rate) noexcept;
  /// The rows added since `begin`.
  [[nodiscard]] std::span<const Row> rows() const noexcept { return std::span(rows_).first(used_); }

  /// The spans must stay valid for the calls below.
  /// @return false if nothing has to be changed. Cost: for each active bound, a look at all rows
  /// and the solution of a triangular system
  [[nodiscard]] bool solve(std::span<const double> lower, std::span<const double> upper) noexcept;

  /// [rad/s^2] With tau, before rounding and missed bounds.
  [[nodiscard]] const Vector& acceleration() const noexcept { return acceleration_; }
  /// [N m] tau of a joint.
  [[nodiscard]] double torque(std::size_t joint) const noexcept;
  /// [m/s] The rate after the step.
  [[nodiscard]] double rate_after(const Row& row) const noexcept;
  /// [m/s] The residual of the firm bounds: the largest shortfall of a rate below its bound. Beyond
  /// rounding only if the limits leave no solution, or the steps did not suffice.
  [[nodiscard]] double missed() const noexcept;
  /// Share of the forces f within the limits, 0 to 1.
  [[nodiscard]] double share() const noexcept;
  /// Share of the forces f within limits of +-`most` [N m], 0 to 1.
  [[nodiscard]] double share(std::span<const double> most) const noexcept;

 private:
  static constexpr std::size_t most_active = 32;
  static constexpr int most_steps = 64;
  static constexpr double tolerance = 1e-9;  // [m/s], and of the range of a torque

  /// An active bound: of a row, or the limit of a joint.
  struct Active {
    std::size_t index = 0;  // of the row or joint
    double side = 0.0;      // 0: a row, 1: the lower limit, -1: the upper one
    double missing = 0.0;   // [m/s^2] or [N m] violation by `asked`
    double force = 0.0;     // its dual
  };

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  // M^-1, where there is a row.
  void invert() noexcept;
  // The most violated bound, weighed by the cost of its removal; false: none.
  [[nodiscard]] bool find_worst(Active& worst) const noexcept;
  // Scalar product of the gradients of two bounds by the norm of M^-1.
  [[nodiscard]] double product(const Active& x, const Active& y) const noexcept;
  // Adds a row to the Cholesky factor of these products. False where it depends on the others.
  [[nodiscard]] bool append(const Active& bound) noexcept;
  void drop(std::size_t k) noexcept;
  // Solves for the duals of the active bounds, and drops bounds of negative duals.
  void settle() noexcept;
  // Torques and accelerations of the duals.
  void apply() noexcept;

  ArmInertia::Matrix M_;
  network::dense::Factored mass_;
  ArmInertia::Matrix inverse_;  // M^-1
  bool has_inverse_ = false;
  double step_ = 0.0;  // [s]
  std::vector<Row> rows_;
  std::size_t used_ = 0;
  std::array<Active, most_active> active_{};
  std::size_t count_ = 0;
  std::array<std::array<double, most_active>, most_active> L_{};
  Vector asked_, freely_;                           // [N m], [rad/s^2] by what is asked
  Vector torques_, acceleration_;                   // [N m], [rad/s^2]
  Vector change_;                                   // [N m] by the forces f alone
  Vector net_;                                      // [N m] tau less the weight
  std::span<const double> weight_, lower_, upper_;  // of the last `solve`
};

}  // namespace repel
