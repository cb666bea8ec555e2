// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The limits of the maker's arms, from the pages that it publishes of its control interface:
/// frankarobotics.github.io/docs/robot_specifications.html, source of 4 May 2026.
#pragma once

#include <array>
#include <cstddef>

#include <repel/world/arm.hpp>

namespace adapters {

/// Of the joints of one arm, base outward.
struct FrankaLimits {
  std::array<double, 7> lower;   ///< [rad]
  std::array<double, 7> upper;   ///< [rad]
  std::array<double, 7> rate;    ///< [rad/s]
  std::array<double, 7> torque;  ///< [N m]
  double torque_rate;            ///< [N m/s] of each joint; the robot aborts above it
};

/// The first arm (FER, "Panda").
inline constexpr FrankaLimits fer{
    .lower = {-2.8973, -1.7628, -2.8973, -3.0718, -2.8973, -0.0175, -2.8973},
    .upper = {2.8973, 1.7628, 2.8973, -0.0698, 2.8973, 3.7525, 2.8973},
    .rate = {2.175, 2.175, 2.175, 2.175, 2.61, 2.61, 2.61},
    .torque = {87.0, 87.0, 87.0, 87.0, 12.0, 12.0, 12.0},
    .torque_rate = 1000.0};

/// Franka Research 3. Its rates hold in the middle of the range: they fall towards the ends.
inline constexpr FrankaLimits fr3{
    .lower = {-2.9007, -1.8361, -2.9007, -3.0770, -2.8763, 0.4398, -3.0508},
    .upper = {2.9007, 1.8361, 2.9007, -0.1169, 2.8763, 4.6216, 3.0508},
    .rate = {2.62, 2.62, 2.62, 2.62, 5.26, 4.18, 5.26},
    .torque = fer.torque,
    .torque_rate = fer.torque_rate};

/// Franka Research 3 in the range that its maker suggests for rates that do not depend on the
/// position. This is the one for repel, which knows no others.
inline constexpr FrankaLimits fr3_rectangular{
    .lower = {-2.3476, -1.5454, -2.4937, -2.7714, -2.5100, 0.7773, -2.7045},
    .upper = {2.3476, 1.5454, 2.4937, -0.4226, 2.5100, 4.2841, 2.7045},
    .rate = {2.0, 1.0, 1.5, 1.25, 3.0, 1.5, 3.0},
    .torque = fr3.torque,
    .torque_rate = fr3.torque_rate};

/// Puts the limits into the seven links of a model.
inline void limit(repel::ArmModel& arm, const FrankaLimits& limits) {
  for (std::size_t i = 0; i < 7; ++i) {
    repel::ArmLink& link = arm.links.at(i);
    link.lower = limits.lower[i];
    link.upper = limits.upper[i];
    link.velocity_limit = limits.rate[i];
    link.effort_limit = limits.torque[i];
  }
}

}  // namespace adapters
