// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/remote/line_bounds.hpp>

#include <algorithm>
#include <cmath>

namespace repel::network {

WaveLimiter::WaveLimiter(const LineBounds& bounds, const LineImpedance& impedance, Space space)
    : bounds_(bounds), impedance_(impedance), space_(space) {
  reset();
}

void WaveLimiter::prepare(double period) noexcept {
  scale_.prepare(period);
  set_bounds();
}

void WaveLimiter::read(const Signals& signals) noexcept {
  scale_.step(signals.of(bounds_.hand).scale);
  set_bounds();
  jacobian_ = signals.jacobian;
  if (signals.at_rest) reset();
}

void WaveLimiter::note(const PortState<any_size>& state) noexcept {
  flow_ = state.flow;
  push_ = -state.effort;
  double all = 0.0;
  for (Eigen::Index i = 0; i < flow_.size(); ++i) all += flow_.coeff(i) + push_.coeff(i);
  if (all - all != 0.0) reset();
}

void WaveLimiter::cut_to_sound(Vec<any_size>& wave) const noexcept {
  for (const Group& group : groups_) {
    const double most = group.most_wave();
    const double length = length_of(wave, group);
    if (length > most) scale(wave, group, most / length);
  }
}

bool WaveLimiter::cut(Vec<any_size>& wave) const noexcept {
  const Vec<any_size> came = wave;
  cut_to_sound(wave);
  for (const Group& group : groups_) {
    for (Eigen::Index i = group.first; i < group.end; ++i) cut_to_force(wave.coeffRef(i), group, i);
    cut_to_speed(wave, group);
  }
  double less = 0.0;
  for (Eigen::Index i = 0; i < wave.size(); ++i) {
    less = std::max(less, std::abs(came.coeff(i) - wave.coeff(i)));
  }
  return less > 1e-9;
}

double WaveLimiter::Group::most_wave() const noexcept {
  const double entries = static_cast<double>(end - first);
  return (std::sqrt(entries) * force + Z * speed) / (2.0 * std::sqrt(Z));
}

void WaveLimiter::reset() noexcept {
  flow_.setZero(impedance_.size());
  push_.setZero(impedance_.size());
}

double WaveLimiter::length_of(const Vec<any_size>& v, const Group& group) noexcept {
  double square = 0.0;
  for (Eigen::Index i = group.first; i < group.end; ++i) square += v.coeff(i) * v.coeff(i);
  return std::sqrt(square);
}

void WaveLimiter::scale(Vec<any_size>& v, const Group& group, double share) noexcept {
  for (Eigen::Index i = group.first; i < group.end; ++i) v.coeffRef(i) *= share;
}

void WaveLimiter::set_bounds() noexcept {
  const double size = static_cast<double>(impedance_.size());
  const double a = bounds_.motion_scale * scale_.value();
  const double b = bounds_.force_scale * scale_.value();
  const auto all = static_cast<Eigen::Index>(size);
  const auto Z = [&](Eigen::Index i) { return i < all ? impedance_.diagonal().coeff(i) : 1.0; };
  const double force = std::min(bounds_.force, bounds_.hand_force / b);
  const double torque = std::min(bounds_.torque, bounds_.hand_torque / b);
  switch (space_) {
    case Space::tool:
      groups_[0] = {0, all - 3, Z(0), force, bounds_.speed};
      groups_[1] = {all - 3, all, Z(all - 1), torque, bounds_.turning};
      break;
    case Space::lever:
      groups_[0] = {0, all, Z(0), force * b, bounds_.speed / a};
      groups_[1] = {};
      break;
    default:
      groups_[0] = {0, all, Z(0), force, bounds_.turning};
      groups_[1] = {};
  }
  const double u = groups_[0].most_wave();
  const double w = groups_[1].most_wave();
  most_power_ = std::min(most_known, u * u + w * w);
}

void WaveLimiter::cut_to_force(double& u, const Group& group, Eigen::Index i) const noexcept {
  const double root = 2.0 * std::sqrt(group.Z);
  const double along = std::copysign(1.0, u) * flow_.coeff(i);
  const double most = std::max(0.0, group.force + group.Z * std::min(along, group.speed)) / root;
  u = std::clamp(u, -most, most);
}

void WaveLimiter::cut_to_speed(Vec<any_size>& wave, const Group& group) const noexcept {
  const double length = length_of(wave, group);
  if (!(length > 0.0)) return;
  double along = 0.0;  // [N] pushed already
  for (Eigen::Index i = group.first; i < group.end; ++i) {
    along += wave.coeff(i) / length * push_.coeff(i);
  }
  const double most = (std::max(0.0, along) + group.Z * speed_along(wave, length, group)) /
                      (2.0 * std::sqrt(group.Z));
  if (length > most) scale(wave, group, most / length);
}

double WaveLimiter::speed_along(const Vec<any_size>& wave, double length,
                                const Group& group) const noexcept {
  if (space_ != Space::joints || jacobian_.cols() != wave.size()) return group.speed;
  const Vec<any_size> tool = dense::product<Vec<any_size>>(jacobian_, wave);
  const double moved = three(tool, 0).norm() / length;  // [m] of the tool per [rad]
  return std::min(group.speed, bounds_.speed / std::max(moved, 1e-9));
}

}  // namespace repel::network
