// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The energy ledger of one module.
#pragma once

namespace repel::network {

/// Energy that entered a module through its ports and from its own source, since the start. For a
/// passive module `energy` never becomes negative.
struct Ledger {
  double energy = 0.0;    ///< [J] net into it: sum of T f.v over its ports, plus `supplied`
  double least = 0.0;     ///< [J] minimum of `energy`
  double passed = 0.0;    ///< [J] sum of T |f.v| over its ports
  double supplied = 0.0;  ///< [J] from its own source: the hand at a lever, a force ball

  /// Adds one tick.
  /// @param in [J] net through all ports; `moved` [J] sum of the magnitudes; `from_source` [J]
  void add(double in, double moved, double from_source) noexcept;

  /// Greatest energy deficit relative to the energy passed; 0 if `energy` was never negative. The
  /// energy passed counts as at least one millijoule: at a rigid end almost nothing passes, and the
  /// deficit is only rounding.
  [[nodiscard]] double deficit() const noexcept;
};

}  // namespace repel::network
