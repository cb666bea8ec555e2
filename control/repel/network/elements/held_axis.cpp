// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/held_axis.hpp>

#include <algorithm>
#include <cmath>

namespace repel::network {

HeldAxis::HeldAxis(const HeldAxisGains& gains, double period) noexcept
    : period_(period),
      limit_(gains.limit),
      mass_resistance_(2.0 * gains.inertia / period),
      spring_resistance_(0.5 * gains.hand_stiffness * period),
      hand_resistance_(spring_resistance_ + gains.hand_damping),
      resistance_(mass_resistance_ + gains.friction + hand_resistance_) {}

void HeldAxis::move(double hand_rate, bool at_rest) noexcept {
  hand_rate_ = hand_rate;
  if (at_rest) mass_wave_ = spring_wave_ = rate_ = 0.0;
}

double HeldAxis::reflected() const noexcept {
  return -mass_wave_ + spring_wave_ - hand_resistance_ * hand_rate_;
}

void HeldAxis::incident(double a) noexcept {
  const double b = reflected();
  saturated_ = std::abs(a + b) > 2.0 * limit_;
  double overpowered = 0.0;  // [W]
  if (saturated_) {
    const double taken = 2.0 * std::copysign(limit_, a + b) - b;
    overpowered = std::max(0.0, (taken * taken - a * a) / (4.0 * resistance_));
    a = taken;
  }
  const double rate = (a - b) / (2.0 * resistance_);
  const double relative = rate - hand_rate_;
  grip_ = spring_wave_ + hand_resistance_ * relative;
  supplied_ = overpowered - grip_ * hand_rate_;
  mass_wave_ = -mass_wave_ + 2.0 * mass_resistance_ * rate;
  spring_wave_ += 2.0 * spring_resistance_ * relative;
  position_ += 0.5 * period_ * (rate + rate_);
  rate_ = rate;
  felt_ = 0.5 * (a + b);
}

double HeldAxis::device_damping(double late) const noexcept {
  const double by_spring = 2.0 * spring_resistance_ * (1.0 + late / period_);
  const double by_damper = hand_resistance_ - spring_resistance_;
  return by_spring == 0.0 ? by_damper : by_damper + by_spring * by_spring / (4.0 * by_damper);
}

double HeldAxis::best_grip_damping(double late) const noexcept {
  return spring_resistance_ * (1.0 + late / period_);
}

}  // namespace repel::network
