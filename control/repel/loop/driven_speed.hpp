// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How much of an operator's torques keeps the tool within its speed limit.
#pragma once

#include <repel/loop/arm_inertia.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel {

/// The greatest share s of the torques with which the tool is no faster after the horizon h than
/// its limit, |J (v + s h M^-1 tau)| <= limit; where it is faster already, 0 for torques that drive
/// it on and 1 for others. 1 where the mass is not known. SpeedShare acts on the speed that the
/// tool has, and a force that is far beyond what it needs passes that by within a tick. Cost: one
/// inversion.
/// @param v [rad/s] of the joints @param torques [N m] @param horizon [s] @param limit [m/s]
[[nodiscard]] double share_within(const network::Jacobian& jacobian, const ArmInertia::Vector& v,
                                  const ArmInertia::Vector& torques, const ArmInertia& inertia,
                                  double horizon, double limit) noexcept;

}  // namespace repel
