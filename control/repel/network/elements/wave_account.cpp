// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/wave_account.hpp>

#include <algorithm>
#include <cmath>

namespace repel::network {

void WaveAccount::clear(int size) noexcept {
  sum.setZero(size);
  energy = 0.0;
}

void WaveAccount::add(const Vec<any_size>& wave, double period) noexcept {
  for (Eigen::Index i = 0; i < sum.size(); ++i) sum.coeffRef(i) += period * wave.coeff(i);
  energy += period * wave.squaredNorm();
}

Vec<any_size> WaveAccount::draw(const Vec<any_size>& missing, double allowed,
                                double period) noexcept {
  Vec<any_size> wave = missing / period;
  const double wanted = period * wave.squaredNorm();
  allowed = std::max(0.0, allowed);
  if (wanted > allowed) wave *= std::sqrt(allowed / wanted);
  for (Eigen::Index i = 0; i < sum.size(); ++i) sum.coeffRef(i) += period * wave.coeff(i);
  energy += std::min(wanted, allowed);
  return wave;
}

LineImpedance::LineImpedance(Space space, int size, double linear, double angular) {
  impedance_.setConstant(size, linear);
  for (int i = space == Space::tool ? size - 3 : size; i < size; ++i) {
    impedance_.coeffRef(i) = angular;
  }
  root_.resize(size);
  to_wave_.resize(size);
  for (int i = 0; i < size; ++i) {
    root_.coeffRef(i) = std::sqrt(impedance_.coeff(i));
    to_wave_.coeffRef(i) = 0.5 * (1.0 / root_.coeff(i));
  }
}

Vec<any_size> LineImpedance::wave_of(const PortState<any_size>& state) const noexcept {
  return product(to_wave_, state.effort + product(impedance_, state.flow));
}

Vec<any_size> LineImpedance::offset_of(const Vec<any_size>& wave) const noexcept {
  return -2.0 * product(root_, wave);
}

}  // namespace repel::network
