// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Checks whether walls are too stiff for the tick rate.
#pragma once

#include <string>
#include <vector>

#include <repel/network/machinery/clean_stiffness.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/arm_kinematics.hpp>
#include <repel/world/world.hpp>

namespace repel {

namespace detail {

/// The greatest eigenvalue of a symmetric matrix, in closed form (Smith, Communications of the ACM
/// 4(4), 1961): Eigen's solver costs every source that includes a cell half a second to compile.
[[nodiscard]] double greatest_eigenvalue(const double (&A)[3][3]) noexcept;

}  // namespace detail

/// The least viscous damping [N s/m] of the joints of an arm against motion of its tool, over all
/// directions: 1 / the greatest eigenvalue of J_v D^-1 J_v'. 0 when a joint that can move the tool
/// has none. Not for the tick.
/// @param J 6 x n, linear rows first, at the tool
[[nodiscard]] double device_damping(const ArmModel& model, const Jacobian& J) noexcept;

/// B / (T K) [ticks] from which on a sampled spring K with a damping B of its own cannot make an
/// arm oscillate, whatever the mass behind it: 0.5 + 2 d for a drive delayed by d [ticks]. The
/// damping is solved together with the mass of the arm (network/machinery/prediction.hpp) and may
/// be as large as one likes; the spring acts by the position measured, half a tick late on average
/// and d ticks more. Springs in parallel keep it if each does.
[[nodiscard]] constexpr double wall_ticks(double drive_delay) noexcept {
  return 0.5 + 2.0 * drive_delay;
}

/// The largest stable stiffness [N/m] or [N m/rad] for a damping [N s/m] or [N m s/rad]: B /
/// (wall_ticks T). @param period [s] @param drive_delay d [ticks]
[[nodiscard]] constexpr double stable_stiffness(double damping, double period,
                                                double drive_delay) noexcept {
  return damping / (wall_ticks(drive_delay) * period);
}

/// By which damping is raised beyond what is needed: scaled to a part, stiffness and damping round
/// differently.
inline constexpr double gain_rounding = 1.0 + 1e-9;

/// The law with its damping raised, where it may rise, to what is stable for a tick of `period` [s]
/// and a drive delayed by `drive_delay` [ticks].
[[nodiscard]] ForceLaw settled(ForceLaw law, double period, double drive_delay) noexcept;

/// [Hz] Greatest rate of a cell.
inline constexpr double greatest_rate = 1e5;

/// The longest period [s] at which the spring of a wall is stable; 0 or below: none is short
/// enough.
/// @param response [s] the part of the delay that a shorter period does not shorten
[[nodiscard]] double longest_period(const ForceLaw& law, double period, double drive_delay,
                                    double response) noexcept;

/// Empty when the spring of a wall is stable; else one sentence with all numbers and what would do.
/// Who does what it says is not refused again. @param response as of `longest_period`
[[nodiscard]] std::string complaint(const ForceLaw& law, double period, double drive_delay,
                                    double response = 0.0);

/// Checks every law of the world for a tick of `period` [s] and arms whose drives are late by
/// `drive_delay` [ticks]. Walls that `device_damping` [N s/m] alone makes passive pass as well
/// (network/machinery/clean_stiffness.hpp). Returns one sentence with the numbers for each pair of
/// bodies whose wall is too stiff, equal sentences once; empty when there is none. Not for the
/// tick.
/// @param response [s] the part of the delay that a shorter period does not shorten
/// @throws SetupError with the first of them when `check` is `error`
std::vector<std::string> check_gains(const World& world, double period, double drive_delay,
                                     double device_damping, network::GainCheck check,
                                     double response = 0.0);

}  // namespace repel
