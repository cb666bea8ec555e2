// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What has passed along a line in one direction: the sum of the waves and their energy.
#pragma once

#include <algorithm>
#include <cmath>

#include <repel/network/elements/port.hpp>

namespace repel::network {

/// Since the line began, in one direction. Waves are u = a / (2 sqrt(Z)), so that their square is a
/// power. The mean of the waves between two accounts has at most the energy between them.
struct WaveAccount {
  Vec<any_size> sum;    ///< of all waves, times their period [sqrt(J s)]
  double energy = 0.0;  ///< of all waves [J]

  /// Empties it, for waves of so many entries.
  void clear(int size) noexcept {
    sum.setZero(size);
    energy = 0.0;
  }
  /// Adds a wave that lasted for `period` [s].
  void add(const Vec<any_size>& wave, double period) noexcept {
    for (Eigen::Index i = 0; i < sum.size(); ++i) sum.coeffRef(i) += period * wave.coeff(i);
    energy += period * wave.squaredNorm();
  }
  /// Outputs for `period` [s] the wave that makes up `missing` [sqrt(J s)], as far as `allowed` [J]
  /// goes: returns that wave [sqrt(W)], which is added to this account.
  [[nodiscard]] Vec<any_size> draw(const Vec<any_size>& missing, double allowed,
                                   double period) noexcept {
    Vec<any_size> wave = missing / period;
    const double wanted = period * wave.squaredNorm();
    allowed = std::max(0.0, allowed);
    if (wanted > allowed) wave *= std::sqrt(allowed / wanted);
    for (Eigen::Index i = 0; i < sum.size(); ++i) sum.coeffRef(i) += period * wave.coeff(i);
    energy += std::min(wanted, allowed);
    return wave;
  }
};

/// The impedance Z of a line with its waves: diagonal, one entry for each direction of the port.
class LineImpedance {
 public:
  LineImpedance() = default;
  /// @param linear [N s/m] @param angular [N m s/rad] of the last three of a tool port
  LineImpedance(Space space, int size, double linear, double angular) {
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

  /// Number of entries of its port.
  [[nodiscard]] int size() const noexcept { return static_cast<int>(impedance_.size()); }
  /// [N s/m], [N m s/rad] of each direction.
  [[nodiscard]] const Vec<any_size>& diagonal() const noexcept { return impedance_; }
  /// The wave into the line of an end in that state [sqrt(W)].
  [[nodiscard]] Vec<any_size> wave_of(const PortState<any_size>& state) const noexcept {
    return product(to_wave_, state.effort + product(impedance_, state.flow));
  }
  /// The effort offset b of an end at which a wave of the other end comes out, with its sign
  /// inverted: b = -2 sqrt(Z) u.
  [[nodiscard]] Vec<any_size> offset_of(const Vec<any_size>& wave) const noexcept {
    return -2.0 * product(root_, wave);
  }

 private:
  Vec<any_size> impedance_, root_, to_wave_;  // diagonals: Z, sqrt(Z), 1 / (2 sqrt(Z))
};

}  // namespace repel::network
