// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/modules/six_axes.hpp>

#include <cstddef>

#include <repel/base/setup_error.hpp>

namespace repel::network {

SixAxes::SixAxes(const SixAxesOptions& options) : options_(checked_fields(options)) {}

void SixAxes::prepare(double period) {
  detail::checked_period(period);
  const HeldAxisGains along{options_.mass, options_.friction, options_.hand_stiffness,
                            options_.hand_damping, options_.force_limit};
  const HeldAxisGains about{options_.inertia, options_.angular_friction,
                            options_.angular_hand_stiffness, options_.angular_hand_damping,
                            options_.torque_limit};
  for (std::size_t i = 0; i < 6; ++i) axes_[i] = HeldAxis(i < 3 ? along : about, period);
  scale_.prepare(period);
  show_resistance();
}

void SixAxes::read(const Signals& signals) noexcept {
  const HandInput& input = signals.of(options_.hand);
  scale_.step(input.scale);
  show_resistance();
  const Vec<any_size> hand = to_vec(input.ball);
  for (std::size_t i = 0; i < 6; ++i) {
    axes_[i].move(hand.coeff(static_cast<Eigen::Index>(i)), signals.at_rest);
  }
}

Vec<6> SixAxes::reflected() const noexcept {
  return all([&](const HeldAxis& axis) { return axis.reflected() / scale(); });
}

void SixAxes::incident(const Vec<6>& wave) noexcept {
  for (std::size_t i = 0; i < 6; ++i) {
    axes_[i].incident(scale() * wave.coeff(static_cast<Eigen::Index>(i)));
  }
}

Vec<6> SixAxes::position() const noexcept {
  return all([](const HeldAxis& axis) { return axis.position(); });
}

Vec<6> SixAxes::rate() const noexcept {
  return all([](const HeldAxis& axis) { return axis.rate(); });
}

Vec<6> SixAxes::felt() const noexcept {
  return all([](const HeldAxis& axis) { return axis.felt(); });
}

Vec<6> SixAxes::grip() const noexcept {
  return all([](const HeldAxis& axis) { return axis.grip(); });
}

Vec<6> SixAxes::device_damping(double late) const noexcept {
  return all([&](const HeldAxis& axis) { return axis.device_damping(late); });
}

Vec<6> SixAxes::best_grip_damping(double late) const noexcept {
  return all([&](const HeldAxis& axis) { return axis.best_grip_damping(late); });
}

double SixAxes::supplied() const noexcept {
  double sum = 0.0;
  for (const HeldAxis& axis : axes_) sum += axis.supplied();
  return sum;
}

bool SixAxes::saturated() const noexcept {
  bool any = false;
  for (const HeldAxis& axis : axes_) any = any || axis.saturated();
  return any;
}

void SixAxes::show_resistance() noexcept {
  const double s = scale();
  for (std::size_t i = 0; i < 6; ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    resistance_.coeffRef(at, at) = axes_[i].resistance() / (s * s);
  }
}

}  // namespace repel::network
