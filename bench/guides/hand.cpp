// SPDX-License-Identifier: BSD-3-Clause
#include "hand.hpp"

#include <cmath>
#include <numbers>

namespace repel::guides {

namespace {
constexpr double drift_time = 0.5;  // [s] of each low pass
}

Unrest::Unrest(const HandOptions& options, std::uint64_t seed) : options_(options), random_(seed) {
  std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
  std::uniform_real_distribution<double> frequency(8.0, 12.0);
  for (std::size_t i = 0; i < phases_.size(); ++i) {
    phases_[i] = phase(random_);
    rates_[i] = 2.0 * std::numbers::pi * frequency(random_);
  }
  for (int settling = 0; settling < 2000; ++settling) {
    for (Drift& drift : drifts_) (void)drifted(drift, 0.01);
  }
}

// The first low pass has unit variance; with the same time constant in series half of it is left.
double Unrest::drifted(Drift& drift, double period) {
  const double kept = std::exp(-period / drift_time);
  drift.first = kept * drift.first + std::sqrt(1.0 - kept * kept) * normal_(random_);
  drift.second += (1.0 - kept) * (drift.first - drift.second);
  return std::numbers::sqrt2 * drift.second;
}

void Unrest::step(double period) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    wander_[axis] = options_.wander * drifted(drifts_[i], period);
    turning_[axis] = options_.turning * drifted(drifts_[i + 3], period);
    double sum = 0.0;
    for (std::size_t tone = 3 * i; tone < 3 * i + 3; ++tone) {
      phases_[tone] += rates_[tone] * period;
      sum += std::sin(phases_[tone]);
    }
    tremor_[axis] = options_.tremor * std::sqrt(2.0 / 3.0) * sum;
  }
}

Hand::Hand(const HandOptions& options, std::uint64_t seed)
    : options_(options), unrest_(options, seed) {}

Twist Hand::step(const Sight& sight, double period) {
  seen_.push_back(sight);
  const auto late = static_cast<std::size_t>(std::lround(options_.reaction / period));
  while (seen_.size() > late + 1) seen_.pop_front();
  const Sight& acted = seen_.front();
  const Vec3 before = unrest_.wander() + unrest_.tremor();
  const Vec3 turned = unrest_.turning();
  unrest_.step(period);
  const Vec3 after = unrest_.wander() + unrest_.tremor();
  const double share = norm(acted.error_W) / options_.care;
  const double speed = options_.speed / (1.0 + share * share);
  return {speed * acted.ahead_W + options_.correction * acted.error_W + (after - before) / period,
          options_.correction * acted.tilt_W + (unrest_.turning() - turned) / period};
}

}  // namespace repel::guides
