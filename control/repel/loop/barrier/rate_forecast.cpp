// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/rate_forecast.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace repel {

RateForecast::RateForecast(const ArmModel& model, double period, double delay, double step)
    : model_(model), period_(period), delay_(delay), step_(step) {
  gain_.setZero(static_cast<Eigen::Index>(model.links.size()));
  disturbance_ = rates_ = change_ = doubt_ = gain_;
  const auto ticks = static_cast<std::size_t>(std::ceil(delay));
  sent_.assign(ticks + 1, gain_);
  predicted_.assign(ticks, gain_);
}

void RateForecast::observe(std::span<const double> v, const ArmInertia& inertia) noexcept {
  for (std::size_t i = 0; i < v.size(); ++i) {
    change_.coeffRef(index(i)) = v[i] - rates_.coeff(index(i));
    rates_.coeffRef(index(i)) = v[i];
  }
  const Vector momentum = network::dense::product<Vector>(inertia.matrix(), change_);
  const double share = period_ / (period_ + memory + 5.0 * delay_ * period_);
  const Vector& acted = sent_[oldest_sent_];
  for (Eigen::Index i = 0; i < momentum.size(); ++i) {
    const auto joint = static_cast<std::size_t>(i);
    const double friction = model_.links[joint].viscous_friction * v[joint];
    const double seen = momentum.coeff(i) / period_ - acted.coeff(i) + friction;
    disturbance_.coeffRef(i) += share * (seen - disturbance_.coeff(i));
  }
}

void RateForecast::note_sent(const Vector& net) noexcept {
  sent_[oldest_sent_] = net;
  oldest_sent_ = (oldest_sent_ + 1) % sent_.size();
}

void RateForecast::predict(std::span<const double> v, const ArmInertia& inertia,
                           const network::dense::Factored& mass) noexcept {
  inertia.momenta(v, gain_);
  // Newest first; the oldest has acted, but for its rest where the delay is no whole number.
  double left = delay_;  // [ticks]
  for (std::size_t k = 1; left > 0.0; ++k, left -= 1.0) {
    const Vector& sent = sent_[(oldest_sent_ + sent_.size() - k) % sent_.size()];
    const double time = std::min(left, 1.0) * period_;
    for (Eigen::Index i = 0; i < gain_.size(); ++i) gain_.coeffRef(i) += time * sent.coeff(i);
  }
  Vector pushed = disturbance_;
  for (Eigen::Index i = 0; i < gain_.size(); ++i) {
    gain_.coeffRef(i) += delay_ * period_ * disturbance_.coeff(i);
    pushed.coeffRef(i) = step_ * disturbance_.coeff(i);
  }
  mass.solve(gain_);
  if (!predicted_.empty()) compare(v, gain_);
  mass.solve(pushed);
  for (std::size_t i = 0; i < v.size(); ++i) {
    gain_.coeffRef(index(i)) += pushed.coeff(index(i)) - v[i];
  }
}

double RateForecast::least_gain(const Vector& h) const noexcept {
  double gained = 0.0;
  for (Eigen::Index i = 0; i < h.size(); ++i) {
    gained += h.coeff(i) * gain_.coeff(i) - std::abs(h.coeff(i)) * doubt_.coeff(i);
  }
  return gained;
}

void RateForecast::compare(std::span<const double> v, const Vector& predicted) noexcept {
  const bool is_known = predictions_ >= predicted_.size();
  const double since = std::ceil(delay_) - delay_;  // [ticks] the time that was predicted for
  // What made the error goes on for the tick in which the torques act.
  const double scale = (delay_ + 1.0) / delay_;
  const double kept = std::exp(-period_ / std::max(doubted_for, 2.0 * delay_ * period_));
  Vector& before = predicted_[oldest_predicted_];
  for (Eigen::Index i = 0; i < doubt_.size(); ++i) {
    const double then = v[static_cast<std::size_t>(i)] - since * change_.coeff(i);
    const double missed = is_known ? scale * std::abs(then - before.coeff(i)) : 0.0;
    doubt_.coeffRef(i) = std::max(kept * doubt_.coeff(i), missed);
  }
  before = predicted;
  oldest_predicted_ = (oldest_predicted_ + 1) % predicted_.size();
  ++predictions_;
}

}  // namespace repel
