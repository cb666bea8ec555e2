/// @file
/// The force law of several pairs at once.
#pragma once

#include <repel/base/lanes.hpp>
#include <repel/force/law.hpp>

namespace repel::detail {

/// The laws of pairs that are not passable, a lane for each.
struct LawLanes {
  Lanes range{};          ///< [m]
  Lanes surface_force{};  ///< [N]
  Lanes damping{};        ///< [N s/m]
  Lanes ceiling{};        ///< [N]

  void set(int k, const ForceLaw& law) noexcept {
    range[k] = law.range;
    surface_force[k] = law.surface_force;
    damping[k] = law.damping;
    ceiling[k] = law.ceiling;
  }

  /// `ForceLaw::operator()` in each lane: the size of the force [N].
  /// @param distance [m] signed
  /// @param rate [m/s] its rate of change
  [[nodiscard]] Lanes operator()(const Lanes& distance, const Lanes& rate) const noexcept {
    const Lanes none{};
    const Lanes share = distance / range;
    const Lanes inward = 1.0 - share;
    const Lanes spring =
        distance > 0.0 ? surface_force * inward * inward : surface_force * (1.0 - 2.0 * share);
    const Lanes damper = damping * smaller(larger(inward, none), none + 1.0);
    const Lanes size = smaller(larger(spring - damper * rate, none), ceiling);
    return distance < range ? size : none;
  }
};

}  // namespace repel::detail
