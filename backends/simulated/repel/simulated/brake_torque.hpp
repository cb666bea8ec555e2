// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How much the brakes of an arm hold.
#pragma once

#include <repel/simulated/built_alike.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// The dry friction of the brake of a joint [N m] or [N]: ArmLink::brake_torque, or if that is
/// unknown 1.5 times the effort limit. If neither is known it is enough for the load of the
/// joint at its longest reach: twice its weight, plus what stops it from the speed limit, or from 3
/// rad/s or 1 m/s, within 0.25 s. Infinite where the reach is unbounded.
[[nodiscard]] double brake_torque(const ArmModel& model, int joint);

}  // namespace repel
