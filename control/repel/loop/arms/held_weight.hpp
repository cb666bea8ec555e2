// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The weight of held parts, at the joints of the arm.
#pragma once

#include <span>

#include <repel/base/types.hpp>
#include <repel/world/arm_kinematics.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// Which masses of held parts count.
enum class Masses {
  known,  ///< to the controller
  all,
};

/// Adds the weight of the parts held by the tool (World::weigh) to the gravity torques [N m] of an
/// arm. As a part becomes part of the tool, so does its weight. Its inertia is left out.
/// @param J of the frame of the `tool` @param gravity_W [m/s^2]
void add_held_weight(const World& world, BodyId tool, const Jacobian& J, const Vec3& gravity_W,
                     Masses masses, std::span<double> torques) noexcept;

}  // namespace repel
