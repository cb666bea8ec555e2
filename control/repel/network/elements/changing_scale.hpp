// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The scale between a hand and the tool, changed while both move.
#pragma once

#include <cmath>

namespace repel::network {

/// Follows HandInput::scale as a first-order lag. A transformer by the same number for motions and
/// forces, constant within a tick, neither stores nor supplies energy, even if the number changes
/// in the next tick. So a change moves nothing, and a felt force fades to its new size.
class ChangingScale {
 public:
  static constexpr double time = 0.3;    ///< [s] in which 63 % of a change are made
  static constexpr double least = 1e-3;  ///< of a scale
  static constexpr double most = 1e3;    ///< of a scale

  /// @param period [s]
  void prepare(double period) noexcept { share_ = -std::expm1(-period / time); }
  /// NaN or out of range: ignored. The first value is taken over at once.
  void step(double wanted) noexcept;
  [[nodiscard]] double value() const noexcept { return value_; }  ///< in this tick

 private:
  double share_ = 1.0;
  double value_ = 1.0;
  bool begun_ = false;
};

}  // namespace repel::network
