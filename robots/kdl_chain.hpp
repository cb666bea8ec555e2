// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Converts an ArmModel to an Orocos KDL chain, in the frame of its base.
#pragma once

#include <kdl/chain.hpp>

#include <repel/world/arm.hpp>
#include <repel/world/kinematics.hpp>

namespace repel::detail {

inline KDL::Vector to_kdl(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

inline KDL::Frame to_kdl(const Pose& X) {
  const Mat3 R = X.linear();
  return {KDL::Rotation(R(0, 0), R(0, 1), R(0, 2),  //
                        R(1, 0), R(1, 1), R(1, 2),  //
                        R(2, 0), R(2, 1), R(2, 2)),
          to_kdl(X.translation())};
}

inline KDL::RigidBodyInertia inertia_of(const ArmLink& link) {
  const Mat3& I = link.I_C_L;
  return KDL::RigidBodyInertia(
      link.mass, to_kdl(link.p_LC),
      KDL::RotationalInertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)));
}

inline KDL::Segment segment_of(const ArmLink& link) {
  const auto type = link.type == JointType::revolute ? KDL::Joint::RotAxis : KDL::Joint::TransAxis;
  const KDL::Frame X_PJ = to_kdl(link.X_PJ);
  const KDL::Joint joint(link.joint_name, X_PJ.p, X_PJ.M * to_kdl(link.axis_J), type);
  return KDL::Segment(link.name, joint, X_PJ, inertia_of(link));
}

/// @throws SetupError if the arm has no link or a value is not finite
inline KDL::Chain chain_of(const ArmModel& arm) {
  require_usable(arm);
  KDL::Chain chain;
  for (const ArmLink& link : arm.links) chain.addSegment(segment_of(link));
  return chain;
}

}  // namespace repel::detail
