// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The force law of several pairs at once, in SIMD lanes.
#pragma once

#include <repel/base/lanes.hpp>
#include <repel/force/law.hpp>

namespace repel::detail {

/// The laws of pairs that are not passable, one lane each.
struct LawLanes : LawFormula<Lanes> {
  LawLanes() noexcept : LawFormula<Lanes>{} {}

  void set(int k, const ForceLaw& law) noexcept {
    const LawFormula<double> one = law.formula();
    range[k] = one.range;
    surface_force[k] = one.surface_force;
    damping[k] = one.damping;
    ceiling[k] = one.ceiling;
  }
};

}  // namespace repel::detail
