// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The principle of least constraint: torques within their limits that keep some rates above their
/// bounds and change the acceleration of an arm as little as possible.
#pragma once

#include <algorithm>
#include <cmath>
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
  LeastConstraint(std::size_t joints, std::size_t most_rows) : rows_(most_rows) {
    asked_.setZero(static_cast<Eigen::Index>(joints));
    change_ = asked_;
  }

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
  [[nodiscard]] Row* add(const Vector& h, double rate) noexcept {
    if (used_ == rows_.size()) return nullptr;
    Row& row = rows_[used_++];
    row.h = row.moved = h;
    mass_.solve(row.moved);
    row.rate = rate;
    row.force = row.mobility = 0.0;
    for (Eigen::Index i = 0; i < h.size(); ++i) row.mobility += h.coeff(i) * row.moved.coeff(i);
    return &row;
  }
  /// The rows added since `begin`.
  [[nodiscard]] std::span<const Row> rows() const noexcept { return std::span(rows_).first(used_); }

  /// @param asked [N m], may be beyond the limits @param weight [N m] the part of it that carries
  /// the weight; the spans must stay valid for the calls below
  /// @return false if nothing has to be changed. Cost: up to 60 sweeps over the rows
  [[nodiscard]] bool solve(std::span<const double> asked, std::span<const double> weight,
                           std::span<const double> lower, std::span<const double> upper) noexcept {
    weight_ = weight;
    lower_ = lower;
    upper_ = upper;
    for (std::size_t i = 0; i < asked.size(); ++i) asked_.coeffRef(index(i)) = asked[i];
    change_.setZero(asked_.size());
    bool any = false;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      double largest = 0.0;  // [m/s] correction in this sweep
      for (std::size_t k = 0; k < used_; ++k) {
        Row& row = rows_[k];
        const double missing = row.least_rate - rate_after(row);
        if (row.force == 0.0 && !(missing > 0.0)) continue;
        largest = std::max(largest, correct(row, missing));
        any = true;
      }
      if (largest < tolerance) break;
    }
    return any;
  }

  /// [N m] tau of a joint.
  [[nodiscard]] double torque(std::size_t joint) const noexcept {
    return std::clamp(wanted(joint), lower_[joint], upper_[joint]);
  }
  /// [N m] The same without the limits.
  [[nodiscard]] double wanted(std::size_t joint) const noexcept {
    return asked_.coeff(index(joint)) + change_.coeff(index(joint));
  }
  /// [m/s] The rate after the step.
  [[nodiscard]] double rate_after(const Row& row) const noexcept {
    double gained = 0.0;
    for (std::size_t i = 0; i < weight_.size(); ++i) {
      gained += row.moved.coeff(index(i)) * (torque(i) - weight_[i]);
    }
    return row.rate + step_ * gained;
  }
  /// The share of the forces f that the limits let act, 0 to 1.
  [[nodiscard]] double share() const noexcept { return share_within(lower_, upper_, 1.0); }
  /// The share of the forces f that limits of +-`most` [N m] would let act, 0 to 1.
  [[nodiscard]] double share(std::span<const double> most) const noexcept {
    return share_within(most, most, -1.0);
  }

 private:
  static constexpr int sweeps = 60;
  static constexpr double tolerance = 1e-6;  // [m/s]

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  // @param sign of `lower` as it is given
  [[nodiscard]] double share_within(std::span<const double> lower, std::span<const double> upper,
                                    double sign) const noexcept {
    double all = 0.0;
    double applied = 0.0;
    for (std::size_t i = 0; i < weight_.size(); ++i) {
      const double change = change_.coeff(index(i));
      const double least = sign * lower[i];
      const double before = std::clamp(asked_.coeff(index(i)), least, upper[i]);
      all += change * change;
      applied += change * (std::clamp(wanted(i), least, upper[i]) - before);
    }
    return all > 0.0 ? std::clamp(applied / all, 0.0, 1.0) : 0.0;
  }

  // Returns by how much the rate changes [m/s].
  double correct(Row& row, double missing) noexcept {
    const double per_newton = step_ * row.mobility;
    const double force = std::clamp(row.force + missing / per_newton, 0.0, most_force(row));
    const double more = force - row.force;
    row.force = force;
    for (Eigen::Index i = 0; i < change_.size(); ++i) {
      change_.coeffRef(i) += more * row.h.coeff(i);
    }
    return std::abs(more) * per_newton;
  }

  // [N] More does nothing: it would bring all joints to their limits, with what the others push.
  [[nodiscard]] double most_force(const Row& row) const noexcept {
    double most = 0.0;
    for (std::size_t i = 0; i < weight_.size(); ++i) {
      const double h = row.h.coeff(index(i));
      if (std::abs(h) < 1e-9) continue;
      const double others = asked_.coeff(index(i)) + change_.coeff(index(i)) - row.force * h;
      most = std::max(most, (h > 0.0 ? upper_[i] - others : others - lower_[i]) / std::abs(h));
    }
    return most;
  }

  network::dense::Factored mass_;
  double step_ = 0.0;  // [s]
  std::vector<Row> rows_;
  std::size_t used_ = 0;
  Vector asked_, change_;
  std::span<const double> weight_, lower_, upper_;  // of the last `solve`
};

}  // namespace repel
