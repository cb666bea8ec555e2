/// @file
/// The energy ledger of one module, and what its passivity controller has done.
#pragma once

#include <algorithm>
#include <cmath>

namespace repel::network {

/// Energy that went into a module through its ports and from its own source, since the start. A
/// passive module never gives more than that: `energy` stays at zero or above.
struct Ledger {
  double energy = 0.0;    ///< [J] into it, sum of T f.v over its ports, with what was supplied
  double least = 0.0;     ///< [J] the lowest `energy` has been
  double passed = 0.0;    ///< [J] sum of T |f.v| over its ports
  double supplied = 0.0;  ///< [J] by a source of its own: the hand at a lever, a force ball

  /// One tick more.
  /// @param in [J] through all ports; `moved` [J] the same without sign; `from_source` [J]
  void add(double in, double moved, double from_source) noexcept {
    supplied += from_source;
    energy += in + from_source;
    least = std::min(least, energy);
    passed += moved;
  }

  /// The lowest ledger as a part of what passed; 0 for a module that never was below zero. Where
  /// next to nothing passes, as against a rigid end, it is all rounding: a millijoule counts at
  /// least.
  [[nodiscard]] double deficit() const noexcept {
    return std::max(0.0, -least) / std::max(passed, 1e-3);
  }
};

/// What a passivity controller has done.
struct PassivityReport {
  double dissipated = 0.0;  ///< [J] withheld or damped away since the start
  double owed = 0.0;        ///< [J] given too much by sampling and not yet taken back
};

}  // namespace repel::network
