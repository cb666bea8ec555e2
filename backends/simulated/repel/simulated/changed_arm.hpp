// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Arms that are a little different from their model: with another inertia, or with a payload. To
/// simulate an arm that its controller does not know exactly.
#pragma once

#include <repel/base/types.hpp>
#include <repel/simulated/built_alike.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// A point mass that is fixed to the tool frame.
struct Payload {
  static constexpr double heaviest = 100.0;  ///< [kg]
  static constexpr double furthest = 10.0;   ///< [m] from the tool frame, along each axis

  double mass = 0.0;   ///< [kg] 0 to `heaviest`; 0: none
  Vec3 p_TC{0, 0, 0};  ///< [m] in the tool frame
};

/// Range of the factor of `with_inertia`.
inline constexpr double least_inertia_factor = 0.3;
inline constexpr double most_inertia_factor = 3.0;  ///< the greatest

/// The arm with masses, inertias of links and inertias of rotors `factor` times as large, and
/// gravity divided by `factor`, so that every link keeps its weight: the same torques hold it, and
/// accelerate it 1 / `factor` times as much. Friction, brakes and limits stay.
/// @throws SetupError if `factor` is not within `least_inertia_factor` to `most_inertia_factor`
[[nodiscard]] ArmModel with_inertia(ArmModel model, double factor);

/// The arm with `payload` in its last link: mass, centre of mass and inertia are those of both, by
/// the parallel-axis theorem. Friction, brakes and limits stay.
/// @throws SetupError if mass or position are out of range, or the arm has no link
[[nodiscard]] ArmModel with_payload(ArmModel model, const Payload& payload);

}  // namespace repel
