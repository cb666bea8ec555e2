// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The arm of the maker's URDF: kinematics, dynamics and convex parts, without the model library.
#pragma once

#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include <franka/robot_state.h>

#include <repel/base/setup_error.hpp>
#include <repel/cell/description.hpp>
#include <repel/robots/parts.hpp>
#include <repel/robots/urdf.hpp>
#include <repel/world/kinematics.hpp>

namespace adapters {

/// The URDF of the arm as text: from the robot, where libfranka can ask for it (from 0.14 on), else
/// from a file.
/// @throws repel::SetupError if the file cannot be read, franka::Exception if the robot fails
template <class Robot>
[[nodiscard]] std::string urdf_of(Robot& robot, const std::string& file) {
  if constexpr (requires { robot.getRobotModel(); }) {
    return robot.getRobotModel();
  } else {
    std::ifstream in(file);
    std::ostringstream text;
    if (!(text << in.rdbuf())) throw repel::SetupError("cannot be read", file);
    return text.str();
  }
}

namespace detail {

/// Adds a body to a link. @param p_LC centre of mass @param I_C_L about it [kg m^2]
inline void add(repel::ArmLink& link, double mass, const repel::Vec3& p_LC,
                const repel::Mat3& I_C_L) {
  if (mass <= 0.0) return;
  const double both = link.mass + mass;
  const repel::Vec3 apart = p_LC - link.p_LC;
  const repel::Mat3 steiner =
      apart.squaredNorm() * repel::Mat3::Identity() - apart * apart.transpose();
  link.I_C_L += I_C_L + link.mass * mass / both * steiner;
  link.p_LC += mass / both * apart;
  link.mass = both;
}

}  // namespace detail

/// What the URDF does not say.
struct UrdfArm {
  bool has_hand = false;       ///< it has the masses of the end effector: the load alone is added
  double rotor_inertia = 0.1;  ///< [kg m^2] of motor and gear, seen at each joint: a guess
};

/// The arm of a URDF whose tool link is the flange, with the end effector and the load that are set
/// in the robot. It needs no model library, and its ticks take no memory.
/// @param robot as load_arm or parse_arm read it @param state whose tool and load hold
[[nodiscard]] inline repel::ArmDescription arm_of(const repel::Robot& robot,
                                                  const franka::RobotState& state,
                                                  const UrdfArm& beside = {}) {
  const repel::Pose X_LF = robot.arm.X_LT;
  repel::ArmDescription arm;
  arm.model = robot.arm;
  arm.model.X_LT = X_LF * repel::Pose(Eigen::Map<const Eigen::Matrix4d>(state.F_T_EE.data()));
  const repel::Mat3 R_LF = X_LF.linear();
  const repel::Mat3 I(beside.has_hand ? state.I_load.data() : state.I_total.data());
  const repel::Vec3 p_FC(beside.has_hand ? state.F_x_Cload.data() : state.F_x_Ctotal.data());
  detail::add(arm.model.links.back(), beside.has_hand ? state.m_load : state.m_total, X_LF * p_FC,
              R_LF * I * R_LF.transpose());
  // The robot compensates its weight and its friction.
  arm.model.gravity_W.setZero();
  for (repel::ArmLink& link : arm.model.links) {
    link.rotor_inertia = beside.rotor_inertia;
    link.viscous_friction = link.coulomb_friction = 0.0;
  }
  arm.kinematics = std::make_unique<repel::Kinematics>(arm.model);
  for (const repel::RobotPart& part : robot.parts) {
    if (part.link < 0) continue;  // of the base, which does not move
    arm.parts.push_back({part.name, shape_of(part, {.levels = 1}), part.X_LP, part.link});
  }
  return arm;
}

}  // namespace adapters
