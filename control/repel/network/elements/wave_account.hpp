// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The waves along a line in one direction: their sum and energy.
#pragma once

#include <repel/network/elements/port.hpp>

namespace repel::network {

/// Since the line began, in one direction. Waves are u = a / (2 sqrt(Z)), so that their square is a
/// power. The mean of the waves between two accounts has at most the energy between them.
struct WaveAccount {
  Vec<any_size> sum;    ///< of all waves, times their period [sqrt(J s)]
  double energy = 0.0;  ///< of all waves [J]

  /// Empties it, for waves of so many entries.
  void clear(int size) noexcept;
  /// Adds a wave that lasted for `period` [s].
  void add(const Vec<any_size>& wave, double period) noexcept;
  /// Outputs for `period` [s] the wave for the `missing` sum [sqrt(J s)], within `allowed` [J]:
  /// returns that wave [sqrt(W)], added to this account.
  [[nodiscard]] Vec<any_size> draw(const Vec<any_size>& missing, double allowed,
                                   double period) noexcept;
};

/// The impedance Z of a line with its waves: diagonal, one entry for each direction of the port.
class LineImpedance {
 public:
  LineImpedance() = default;
  /// @param linear [N s/m] @param angular [N m s/rad] of the last three of a tool port
  LineImpedance(Space space, int size, double linear, double angular);

  /// Number of entries of its port.
  [[nodiscard]] int size() const noexcept { return static_cast<int>(impedance_.size()); }
  /// [N s/m], [N m s/rad] of each direction.
  [[nodiscard]] const Vec<any_size>& diagonal() const noexcept { return impedance_; }
  /// The wave into the line of an end in that state [sqrt(W)].
  [[nodiscard]] Vec<any_size> wave_of(const PortState<any_size>& state) const noexcept;
  /// The effort offset b at the end receiving a wave, with its sign inverted: b = -2 sqrt(Z) u.
  [[nodiscard]] Vec<any_size> offset_of(const Vec<any_size>& wave) const noexcept;

 private:
  Vec<any_size> impedance_, root_, to_wave_;  // diagonals: Z, sqrt(Z), 1 / (2 sqrt(Z))
};

}  // namespace repel::network
