// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Keeps the rates of a hand within the speed limit of the tool.
#pragma once

#include <repel/base/types.hpp>
#include <repel/network/elements/signals.hpp>
#include <repel/network/network.hpp>

namespace repel {

namespace detail {

/// Of a vector; its squares may overflow.
[[nodiscard]] double length_of(const Vec3& v) noexcept;

}  // namespace detail

/// Puts a hand with non-finite numbers to rest; it keeps the `last` direction of its lever. True if
/// it was finite.
[[nodiscard]] bool rest_unless_finite(network::HandInput& hand,
                                      const network::HandInput& last) noexcept;

/// Clamps the operator's rates to the speed limit of the tool and the lever direction to length
/// one, with its turning; an invalid scale becomes 1. True if a rate was clamped.
/// @param scale of the lever [m/rad], above 0
[[nodiscard]] bool cut_to_speed(network::HandInput& hand, double limit, double scale) noexcept;

/// [m/rad] Tool motion per motion of the lever of a hand; 1 without a lever.
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
