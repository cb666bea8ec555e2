// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How light an arm can appear to its network.
#pragma once

#include <repel/cell/description.hpp>
#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/network/elements/robot_end.hpp>
#include <repel/network/network.hpp>

namespace repel {

namespace detail {

/// The greatest eigenvalue of three rows and columns of J M^-1 J', from `row` on: 1 / the least
/// mass or inertia over all directions.
[[nodiscard]] double mobility(const Jacobian& J, const ArmInertia::Matrix& inverse,
                              Eigen::Index row) noexcept;

}  // namespace detail

/// Contact forces on an arm commanded by rates or positions do not move its virtual inertia.
/// @throws SetupError if it has a force sensor all the same
void require_fitting_sensor(const ArmDescription& arm, const network::Network& network);

/// The least masses of an arm at its start and in 63 poses of its workspace, the same in every run,
/// divided by the uncertainty of its masses; and its response time. Leaves the kinematics at the
/// start. Set-up only. Cost: 64 mass matrices.
/// @param period [s]
[[nodiscard]] network::RobotEnd robot_end(const ArmDescription& arm, double period);

}  // namespace repel
