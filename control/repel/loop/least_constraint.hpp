// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The principle of least constraint: torques within their limits that keep some rates above their
/// bounds and change the acceleration of an arm as little as possible.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <repel/loop/arm_inertia.hpp>
#include <repel/network/elements/dense.hpp>

namespace repel {

/// Finds the torques tau that minimize (tau - asked)' M^-1 (tau - asked), subject to
///
///     h_k' (v + step M^-1 (tau - weight)) >= least_k      lower <= tau <= upper
///
/// (C. F. Gauss 1829). By their duals f_k >= 0, tau = asked + sum h_k f_k clamped to the limits: as
/// if bodies without friction pushed with the forces f_k. Projected Gauss-Seidel; where the limits
/// leave no solution, the result is what they allow. Allocates at construction only.
class LeastConstraint {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// One bound.
  struct Row {
    Vector h;                 ///< [m] torques of 1 N along the direction of the rate
    Vector moved;             ///< M^-1 h, set by `add`
    double rate = 0.0;        ///< [m/s] without any net torque
    double least_rate = 0.0;  ///< [m/s]
    double mobility = 0.0;    ///< [1/kg] h' M^-1 h, set by `add`
    double force = 0.0;       ///< [N] f, found by `solve`
  };

  /// Allocates for so many joints and rows.
  LeastConstraint(std::size_t joints, std::size_t most_rows);

  /// Begins a problem. @param mass M, with what else brakes in proportion to the rates
  /// @param step [s] @return false if M is not positive definite
  template <class Entry>
  [[nodiscard]] bool begin(Eigen::Index joints, const Entry& mass, double step) noexcept {
    used_ = 0;
    step_ = step;
    return mass_.factor(joints, mass);
  }
  /// x = M^-1 x.
  void solve_mass(Vector& x) const noexcept { mass_.solve(x); }

  /// @return the row, whose `least_rate` may still be set; null: there is no room
  [[nodiscard]] Row* add(const Vector& h, double rate) noexcept;
  /// The rows added since `begin`.
  [[nodiscard]] std::span<const Row> rows() const noexcept { return std::span(rows_).first(used_); }

  /// @param asked [N m], may be beyond the limits @param weight [N m] the part of it that carries
  /// the weight; the spans must stay valid for the calls below
  /// @return false if nothing has to be changed. Cost: up to 60 sweeps over the rows
  [[nodiscard]] bool solve(std::span<const double> asked, std::span<const double> weight,
                           std::span<const double> lower, std::span<const double> upper) noexcept;

  /// [N m] tau of a joint.
  [[nodiscard]] double torque(std::size_t joint) const noexcept;
  /// [N m] The same without the limits.
  [[nodiscard]] double wanted(std::size_t joint) const noexcept;
  /// [m/s] The rate after the step.
  [[nodiscard]] double rate_after(const Row& row) const noexcept;
  /// The share of the forces f that the limits let act, 0 to 1.
  [[nodiscard]] double share() const noexcept { return share_within(lower_, upper_, 1.0); }
  /// The share of the forces f that limits of +-`most` [N m] would let act, 0 to 1.
  [[nodiscard]] double share(std::span<const double> most) const noexcept;

 private:
  static constexpr int sweeps = 60;
  static constexpr double tolerance = 1e-6;  // [m/s]

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  // @param sign of `lower` as it is given
  [[nodiscard]] double share_within(std::span<const double> lower, std::span<const double> upper,
                                    double sign) const noexcept;

  // Returns by how much the rate changes [m/s].
  double correct(Row& row, double missing) noexcept;

  // [N] More does nothing: it would bring all joints to their limits, with what the others push.
  [[nodiscard]] double most_force(const Row& row) const noexcept;

  network::dense::Factored mass_;
  double step_ = 0.0;  // [s]
  std::vector<Row> rows_;
  std::size_t used_ = 0;
  Vector asked_, change_;
  std::span<const double> weight_, lower_, upper_;  // of the last `solve`
};

}  // namespace repel
