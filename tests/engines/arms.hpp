// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The simulated arms that are built, each with what differs in the facts they are tested for.
#pragma once

#include <gtest/gtest.h>

#include "simulated/arms.hpp"
#ifdef REPEL_TESTS_Bullet
#include <repel/bullet/arm.hpp>
#endif
#ifdef REPEL_TESTS_Ode
#include <repel/ode/arm.hpp>
#endif
#ifdef REPEL_TESTS_Mujoco
#include <repel/mujoco/arm.hpp>
#endif
#ifdef REPEL_TESTS_Robots
#include <repel/robots/dynamics.hpp>
#endif

namespace repel::simulated {

#ifdef REPEL_TESTS_Bullet
struct Bullet {
  using Arm = bullet::Arm;
  static ArmModel puma() { return puma560(); }
  static constexpr bool touches_hulls = true;
  static constexpr bool touches_cones = true;
  static constexpr double creep = 1e-8;   ///< [rad] at most in a second, while in balance
  static constexpr double braked = 1e-4;  ///< [rad/s^2] error of the acceleration under a brake
  static constexpr double strays = 5e-3;  ///< [rad] from the reference, with four sub-steps
};
#endif

#ifdef REPEL_TESTS_Ode
struct Ode {
  using Arm = ode::Arm;
  static ArmModel puma() { return heavy_puma(); }
  static constexpr bool touches_hulls = false;
  static constexpr bool touches_cones = false;
  static constexpr double creep = 1e-6;
  static constexpr double braked = 1e-3;
  static constexpr double strays = 1e-2;
};
#endif

#ifdef REPEL_TESTS_Mujoco
struct Mujoco {
  using Arm = mujoco::Arm;
  static ArmModel puma() { return puma560(); }
  static constexpr bool touches_hulls = true;
  static constexpr bool touches_cones = false;
  static constexpr double creep = 1e-8;
  static constexpr double braked = 1e-4;
  static constexpr double strays = 5e-3;
};
#endif

#ifdef REPEL_TESTS_Robots
/// The reference arm, which knows neither contacts nor stops.
struct Robots {
  using Arm = ReferenceArm;
  static ArmModel puma() { return heavy_puma(); }
  static constexpr double braked = 1e-4;
};
#endif

using EveryArm = testing::Types<REPEL_TESTS_ARMS>;
#ifdef REPEL_TESTS_ENGINES
using EveryEngine = testing::Types<REPEL_TESTS_ENGINES>;  ///< they touch, and have stops
#endif

}  // namespace repel::simulated
