// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <franka/robot_state.h> of libfranka: what kinematics, dynamics and the loop read.
#pragma once

#include <array>

#include <franka/duration.h>

namespace franka {

enum class RobotMode {
  kOther,
  kIdle,
  kMove,
  kGuiding,
  kReflex,
  kUserStopped,
  kAutomaticErrorRecovery
};

struct RobotState {
  std::array<double, 16> O_T_EE{};  // by columns [m], like every matrix here
  std::array<double, 16> F_T_EE{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  std::array<double, 16> EE_T_K{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  double m_ee{};    // [kg] of the end effector
  double m_load{};  // [kg] told by setLoad
  std::array<double, 9> I_load{};
  std::array<double, 3> F_x_Cload{};
  double m_total{};                    // [kg] of both
  std::array<double, 9> I_total{};     // [kg m^2] about the centre of mass, axes of the flange
  std::array<double, 3> F_x_Ctotal{};  // [m] centre of mass from the flange
  std::array<double, 7> tau_J{};       // [N m] measured, with gravity
  std::array<double, 7> tau_J_d{};     // [N m] desired, without gravity
  std::array<double, 7> dtau_J{};      // [N m/s]
  std::array<double, 7> q{};           // [rad]
  std::array<double, 7> q_d{};         // [rad]
  std::array<double, 7> dq{};          // [rad/s]
  std::array<double, 7> dq_d{};        // [rad/s]
  std::array<double, 7> tau_ext_hat_filtered{};  // [N m]
  std::array<double, 6> O_F_ext_hat_K{};         // [N], [N m]
  double control_command_success_rate{};
  RobotMode robot_mode = RobotMode::kUserStopped;
  Duration time{};  // since the robot was switched on
};

}  // namespace franka
