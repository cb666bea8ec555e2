// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/least_constraint.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace repel {

LeastConstraint::LeastConstraint(std::size_t joints, std::size_t most_rows) : rows_(most_rows) {
  asked_.setZero(static_cast<Eigen::Index>(joints));
  change_ = asked_;
}

LeastConstraint::Row* LeastConstraint::add(const Vector& h, double rate) noexcept {
  if (used_ == rows_.size()) return nullptr;
  Row& row = rows_[used_++];
  row.h = row.moved = h;
  mass_.solve(row.moved);
  row.rate = rate;
  row.force = row.mobility = 0.0;
  for (Eigen::Index i = 0; i < h.size(); ++i) row.mobility += h.coeff(i) * row.moved.coeff(i);
  return &row;
}

bool LeastConstraint::solve(std::span<const double> asked, std::span<const double> weight,
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

double LeastConstraint::torque(std::size_t joint) const noexcept {
  return std::clamp(wanted(joint), lower_[joint], upper_[joint]);
}

double LeastConstraint::wanted(std::size_t joint) const noexcept {
  return asked_.coeff(index(joint)) + change_.coeff(index(joint));
}

double LeastConstraint::rate_after(const Row& row) const noexcept {
  double gained = 0.0;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    gained += row.moved.coeff(index(i)) * (torque(i) - weight_[i]);
  }
  return row.rate + step_ * gained;
}

double LeastConstraint::share(std::span<const double> most) const noexcept {
  return share_within(most, most, -1.0);
}

double LeastConstraint::share_within(std::span<const double> lower, std::span<const double> upper,
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

double LeastConstraint::correct(Row& row, double missing) noexcept {
  const double per_newton = step_ * row.mobility;
  const double force = std::clamp(row.force + missing / per_newton, 0.0, most_force(row));
  const double more = force - row.force;
  row.force = force;
  for (Eigen::Index i = 0; i < change_.size(); ++i) {
    change_.coeffRef(i) += more * row.h.coeff(i);
  }
  return std::abs(more) * per_newton;
}

double LeastConstraint::most_force(const Row& row) const noexcept {
  double most = 0.0;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    const double h = row.h.coeff(index(i));
    if (std::abs(h) < 1e-9) continue;
    const double others = asked_.coeff(index(i)) + change_.coeff(index(i)) - row.force * h;
    most = std::max(most, (h > 0.0 ? upper_[i] - others : others - lower_[i]) / std::abs(h));
  }
  return most;
}

}  // namespace repel
