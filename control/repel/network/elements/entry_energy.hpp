// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The energy to switch a spring on.
#pragma once

namespace repel::network {

/// Raises the gain of a potential no faster than its energy is available: first spare energy, taken
/// from motion and not stored, then an amount of its own. That amount is small, refilled slowly,
/// and counts as supplied.
class EntryEnergy {
 public:
  /// [s] in which all of it is there again.
  static constexpr double refill = 10.0;

  /// @param most [J] of its own
  explicit EntryEnergy(double most) noexcept : most_(most), left_(most) {}

  /// Begins a tick of `period` [s]. @param spare [J] taken by the element and not stored
  void begin(double spare, double period) noexcept;

  /// Returns `gain`, raised by at most `step` towards `target`, within the available energy.
  /// @param energy [J] of the potential at a gain of 1
  [[nodiscard]] double raised(double gain, double target, double step, double energy) noexcept;

  [[nodiscard]] double spent() const noexcept { return spent_; }  ///< [J] of its own in this tick
  [[nodiscard]] double left() const noexcept { return left_; }    ///< [J] of its own

 private:
  double most_;
  double left_;
  double spare_ = 0.0;
  double spent_ = 0.0;
};

}  // namespace repel::network
