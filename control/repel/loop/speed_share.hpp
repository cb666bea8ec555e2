// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Keeps the tool within its speed limit.
#pragma once

#include <repel/loop/arm_inertia.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/network.hpp>

namespace repel {

/// Shares of driving power and of braking at a tool speed.
struct SpeedShare {
  double drive = 1.0;  ///< 1 up to the limit, 0 from 1.2 times it
  double brake = 0.0;  ///< 0 up to 1.2 times the limit, 1 from 1.5 times it
};

/// @param speed of the tool [m/s]; `limit` [m/s] up to which the operator may drive it, above 0
[[nodiscard]] SpeedShare speed_share(double speed, double limit) noexcept;

/// The greatest share s of an operator's torques with which the tool is no faster after the horizon
/// h than its limit, |J (v + s h M^-1 tau)| <= limit; where it is faster already, 0 for torques
/// that drive it on and 1 for others. 1 where the mass is not known. `speed_share` acts on the
/// speed that the tool has, and a force that is far beyond what it needs passes that by within a
/// tick. Cost: one inversion.
/// @param v [rad/s] of the joints @param torques [N m] @param horizon [s] @param limit [m/s]
[[nodiscard]] double share_within(const network::Jacobian& jacobian, const ArmInertia::Vector& v,
                                  const ArmInertia::Vector& torques, const ArmInertia& inertia,
                                  double horizon, double limit) noexcept;

/// The share of their force with which walls give back what they have stored, on the way out: 1 up
/// to the limit, 0 from 1.2 times it, at the speed that the tool will then have.
/// @param growth by which the speed would grow within the time in which the arm follows its
/// torques, as a part of it, with the whole force; at less than half the limit it does not count
[[nodiscard]] double release_share(double speed, double limit, double growth) noexcept;

namespace detail {

/// Of a vector whose squares may be beyond the range of numbers.
[[nodiscard]] double length_of(const Vec3& v) noexcept;

}  // namespace detail

/// Puts a hand to rest whose numbers are not finite; it keeps the `last` direction of its lever.
/// True when it was finite.
[[nodiscard]] bool rest_unless_finite(network::HandInput& hand,
                                      const network::HandInput& last) noexcept;

/// Clamps the operator's rates to the speed limit of the tool and the lever direction to length
/// one, with its turning; a scale that is none becomes 1. True when a rate was clamped.
/// @param scale of the lever [m/rad], above 0
[[nodiscard]] bool cut_to_speed(network::HandInput& hand, double limit, double scale) noexcept;

/// [m/rad] Tool motion per motion of the lever that a hand holds; 1 where it holds none.
struct LeverScales {
  double first = 1.0;   ///< of the first hand
  double second = 1.0;  ///< of the second hand
};

/// The velocity scales of the levers of a network, by hand; 1 where there is none.
[[nodiscard]] LeverScales lever_scales(const network::Network& network) noexcept;

/// The same for both hands.
[[nodiscard]] bool cut_to_speed(network::Signals& signals, double limit,
                                const LeverScales& scales) noexcept;

}  // namespace repel
