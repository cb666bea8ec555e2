// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/least_constraint.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace repel {

LeastConstraint::LeastConstraint(std::size_t joints, std::size_t most_rows) : rows_(most_rows) {
  const auto n = static_cast<Eigen::Index>(joints);
  M_.setZero(n, n);
  asked_.setZero(n);
  freely_ = torques_ = acceleration_ = change_ = net_ = asked_;
}

LeastConstraint::Row* LeastConstraint::add(const Vector& h, double rate) noexcept {
  if (used_ == rows_.size()) return nullptr;
  if (!has_inverse_) invert();
  Row& row = rows_[used_++];
  row.h = h;
  row.moved = network::dense::product<Vector>(inverse_, h);
  row.rate = rate;
  row.force = row.mobility = 0.0;
  row.give = firm;
  row.tag = 0;
  for (Eigen::Index i = 0; i < h.size(); ++i) row.mobility += h.coeff(i) * row.moved.coeff(i);
  return &row;
}

void LeastConstraint::invert() noexcept {
  const Eigen::Index n = M_.rows();
  inverse_.resize(n, n);
  Vector column;
  for (Eigen::Index k = 0; k < n; ++k) {
    column.setZero(n);
    column.coeffRef(k) = 1.0;
    mass_.solve(column);
    for (Eigen::Index i = 0; i < n; ++i) inverse_.coeffRef(i, k) = column.coeff(i);
  }
  has_inverse_ = true;
}

void LeastConstraint::ask(std::span<const double> asked, std::span<const double> weight) noexcept {
  weight_ = weight;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    asked_.coeffRef(index(i)) = asked[i];
    freely_.coeffRef(index(i)) = asked[i] - weight[i];
  }
  mass_.solve(freely_);
}

bool LeastConstraint::solve(std::span<const double> lower, std::span<const double> upper) noexcept {
  lower_ = lower;
  upper_ = upper;
  count_ = 0;
  apply();
  Active worst;
  for (int step = 0; step < most_steps && find_worst(worst); ++step) {
    if (!append(worst)) break;
    settle();
    apply();
  }
  for (std::size_t k = 0; k < used_; ++k) rows_[k].force = 0.0;
  for (std::size_t k = 0; k < count_; ++k) {
    if (active_[k].side == 0.0) rows_[active_[k].index].force = active_[k].force;
  }
  for (std::size_t i = 0; i < weight_.size(); ++i) net_.coeffRef(index(i)) = torque(i) - weight_[i];
  return count_ > 0;
}

double LeastConstraint::torque(std::size_t joint) const noexcept {
  return std::clamp(torques_.coeff(index(joint)), lower_[joint], upper_[joint]);
}

double LeastConstraint::rate_after(const Row& row) const noexcept {
  double gained = 0.0;
  for (Eigen::Index i = 0; i < net_.size(); ++i) gained += row.moved.coeff(i) * net_.coeff(i);
  return row.rate + step_ * gained;
}

double LeastConstraint::missed() const noexcept {
  double most = 0.0;
  for (const Row& row : rows()) {
    if (row.give <= firm) most = std::max(most, row.least_rate - rate_after(row));
  }
  return most;
}

double LeastConstraint::share() const noexcept {
  double all = 0.0;
  double applied = 0.0;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    const double change = change_.coeff(index(i));
    all += change * change;
    applied += change * (torque(i) - std::clamp(asked_.coeff(index(i)), lower_[i], upper_[i]));
  }
  return all > 0.0 ? std::clamp(applied / all, 0.0, 1.0) : 0.0;
}

double LeastConstraint::share(std::span<const double> most) const noexcept {
  double all = 0.0;
  double applied = 0.0;
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    const double change = change_.coeff(index(i));
    const double asked = asked_.coeff(index(i));
    all += change * change;
    applied += change * (std::clamp(asked + change, -most[i], most[i]) -
                         std::clamp(asked, -most[i], most[i]));
  }
  return all > 0.0 ? std::clamp(applied / all, 0.0, 1.0) : 0.0;
}

bool LeastConstraint::find_worst(Active& worst) const noexcept {
  double largest = 0.0;
  const auto consider = [&](std::size_t i, double side, double violation, double norm) {
    for (std::size_t k = 0; k < count_; ++k) {
      if (active_[k].index == i && active_[k].side == side) return;
    }
    if (violation * violation <= largest * norm) return;
    largest = violation * violation / norm;
    worst = {.index = i, .side = side};
  };
  for (std::size_t k = 0; k < used_; ++k) {
    const Row& row = rows_[k];
    double after = row.rate;
    for (Eigen::Index i = 0; i < row.h.size(); ++i) {
      after += step_ * row.h.coeff(i) * acceleration_.coeff(i);
    }
    const double violation = row.least_rate - after;
    if (violation > tolerance) consider(k, 0.0, violation / step_, row.mobility);
  }
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    const double torque = torques_.coeff(index(i));
    const double norm = M_.coeff(index(i), index(i));
    const double slack = tolerance * (upper_[i] - lower_[i]);
    if (lower_[i] - torque > slack) consider(i, 1.0, lower_[i] - torque, norm);
    if (torque - upper_[i] > slack) consider(i, -1.0, torque - upper_[i], norm);
  }
  if (largest == 0.0) return false;
  const std::size_t i = worst.index;
  if (worst.side == 0.0) {
    worst.missing = (rows_[i].least_rate - rows_[i].rate) / step_;
    for (Eigen::Index k = 0; k < freely_.size(); ++k) {
      worst.missing -= rows_[i].h.coeff(k) * freely_.coeff(k);
    }
  } else {
    const double limit = worst.side > 0.0 ? lower_[i] : upper_[i];
    worst.missing = worst.side * (limit - asked_.coeff(index(i)));
  }
  return true;
}

double LeastConstraint::product(const Active& x, const Active& y) const noexcept {
  if (x.side != 0.0 && y.side != 0.0) {
    return x.side * y.side * M_.coeff(index(x.index), index(y.index));
  }
  if (x.side != 0.0) return product(y, x);
  const Row& row = rows_[x.index];
  if (y.side != 0.0) return y.side * row.h.coeff(index(y.index));
  double sum = x.index == y.index ? row.give * row.mobility : 0.0;
  for (Eigen::Index i = 0; i < row.h.size(); ++i) {
    sum += row.h.coeff(i) * rows_[y.index].moved.coeff(i);
  }
  return sum;
}

bool LeastConstraint::append(const Active& bound) noexcept {
  if (count_ == most_active) return false;
  std::array<double, most_active>& row = L_[count_];
  const double norm = product(bound, bound);
  double left = norm;
  for (std::size_t k = 0; k < count_; ++k) {
    double sum = product(bound, active_[k]);
    for (std::size_t m = 0; m < k; ++m) sum -= row[m] * L_[k][m];
    row[k] = sum / L_[k][k];
    left -= row[k] * row[k];
  }
  if (!(left > 1e-12 * norm)) return false;
  row[count_] = std::sqrt(left);
  active_[count_++] = bound;
  return true;
}

void LeastConstraint::drop(std::size_t k) noexcept {
  const std::size_t all = count_;
  count_ = k;
  for (std::size_t next = k + 1; next < all; ++next) {
    const Active bound = active_[next];
    (void)append(bound);
  }
}

void LeastConstraint::settle() noexcept {
  std::array<double, most_active> wanted{};
  while (count_ > 0) {
    for (std::size_t k = 0; k < count_; ++k) {
      double sum = active_[k].missing;
      for (std::size_t m = 0; m < k; ++m) sum -= L_[k][m] * wanted[m];
      wanted[k] = sum / L_[k][k];
    }
    for (std::size_t k = count_; k-- > 0;) {
      double sum = wanted[k];
      for (std::size_t m = k + 1; m < count_; ++m) sum -= L_[m][k] * wanted[m];
      wanted[k] = sum / L_[k][k];
    }
    double way = 1.0;  // to the wanted duals, until one would pull
    std::size_t first = count_;
    for (std::size_t k = 0; k < count_; ++k) {
      if (wanted[k] > 0.0) continue;
      const double force = active_[k].force;
      const double until = force > 0.0 ? force / (force - wanted[k]) : 0.0;
      if (first < count_ && until >= way) continue;
      way = until;
      first = k;
    }
    for (std::size_t k = 0; k < count_; ++k) {
      active_[k].force += way * (wanted[k] - active_[k].force);
    }
    if (first == count_) return;
    drop(first);
  }
}

void LeastConstraint::apply() noexcept {
  torques_ = asked_;
  acceleration_ = freely_;
  change_.setZero(asked_.size());
  for (std::size_t k = 0; k < count_; ++k) {
    const Active& bound = active_[k];
    if (bound.side == 0.0) {
      const Row& row = rows_[bound.index];
      for (Eigen::Index i = 0; i < change_.size(); ++i) {
        change_.coeffRef(i) += bound.force * row.h.coeff(i);
        torques_.coeffRef(i) += bound.force * row.h.coeff(i);
        acceleration_.coeffRef(i) += bound.force * row.moved.coeff(i);
      }
      continue;
    }
    const double pushed = bound.side * bound.force;
    for (Eigen::Index i = 0; i < change_.size(); ++i) {
      torques_.coeffRef(i) += pushed * M_.coeff(i, index(bound.index));
    }
    acceleration_.coeffRef(index(bound.index)) += pushed;
  }
  for (std::size_t k = 0; k < count_; ++k) {  // without rounding
    const Active& bound = active_[k];
    if (bound.side == 0.0) continue;
    const std::span<const double> limits = bound.side > 0.0 ? lower_ : upper_;
    torques_.coeffRef(index(bound.index)) = limits[bound.index];
  }
}

}  // namespace repel
