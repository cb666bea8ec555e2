// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <franka/control_types.h> of libfranka: every command that a callback may return.
/// All of them are there, though the adapter returns torques alone: with fewer, a call would
/// compile here that is ambiguous there.
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <stdexcept>

namespace franka {

enum class ControllerMode { kJointImpedance, kCartesianImpedance };
enum class RealtimeConfig { kEnforce, kIgnore };

struct Finishable {
  bool motion_finished = false;
};

namespace stand_in {

template <std::size_t size>
std::array<double, size> numbers(std::initializer_list<double> list) {
  if (list.size() != size) throw std::invalid_argument("invalid number of elements");
  std::array<double, size> all{};
  std::copy(list.begin(), list.end(), all.begin());
  return all;
}

}  // namespace stand_in

class Torques : public Finishable {
 public:
  Torques(const std::array<double, 7>& torques) noexcept : tau_J(torques) {}
  Torques(std::initializer_list<double> torques) : tau_J(stand_in::numbers<7>(torques)) {}
  std::array<double, 7> tau_J{};  // [N m] without gravity and friction
};

class JointPositions : public Finishable {
 public:
  JointPositions(const std::array<double, 7>& positions) noexcept : q(positions) {}
  JointPositions(std::initializer_list<double> positions) : q(stand_in::numbers<7>(positions)) {}
  std::array<double, 7> q{};  // [rad]
};

class JointVelocities : public Finishable {
 public:
  JointVelocities(const std::array<double, 7>& velocities) noexcept : dq(velocities) {}
  JointVelocities(std::initializer_list<double> rates) : dq(stand_in::numbers<7>(rates)) {}
  std::array<double, 7> dq{};  // [rad/s]
};

class CartesianPose : public Finishable {
 public:
  CartesianPose(const std::array<double, 16>& pose) noexcept : O_T_EE(pose) {}
  CartesianPose(const std::array<double, 16>& pose, const std::array<double, 2>& at) noexcept
      : O_T_EE(pose), elbow(at) {}
  CartesianPose(std::initializer_list<double> pose) : O_T_EE(stand_in::numbers<16>(pose)) {}
  CartesianPose(std::initializer_list<double> pose, std::initializer_list<double> at)
      : O_T_EE(stand_in::numbers<16>(pose)), elbow(stand_in::numbers<2>(at)) {}
  std::array<double, 16> O_T_EE{};  // column-major [m]
  std::array<double, 2> elbow{};
};

class CartesianVelocities : public Finishable {
 public:
  CartesianVelocities(const std::array<double, 6>& twist) noexcept : O_dP_EE(twist) {}
  CartesianVelocities(const std::array<double, 6>& twist, const std::array<double, 2>& at) noexcept
      : O_dP_EE(twist), elbow(at) {}
  CartesianVelocities(std::initializer_list<double> twist) : O_dP_EE(stand_in::numbers<6>(twist)) {}
  CartesianVelocities(std::initializer_list<double> twist, std::initializer_list<double> at)
      : O_dP_EE(stand_in::numbers<6>(twist)), elbow(stand_in::numbers<2>(at)) {}
  std::array<double, 6> O_dP_EE{};  // [m/s], [rad/s]
  std::array<double, 2> elbow{};
};

namespace stand_in {

template <class Command>
Command finished(Command command) noexcept {
  command.motion_finished = true;
  return command;
}

}  // namespace stand_in

// Five functions as there, not one template: what converts to several commands is ambiguous.
inline Torques MotionFinished(Torques command) noexcept {
  return stand_in::finished(command);
}
inline JointPositions MotionFinished(JointPositions command) noexcept {
  return stand_in::finished(command);
}
inline JointVelocities MotionFinished(JointVelocities command) noexcept {
  return stand_in::finished(command);
}
inline CartesianPose MotionFinished(CartesianPose command) noexcept {
  return stand_in::finished(command);
}
inline CartesianVelocities MotionFinished(CartesianVelocities command) noexcept {
  return stand_in::finished(command);
}

}  // namespace franka
