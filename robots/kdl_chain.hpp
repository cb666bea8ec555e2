/// @file
/// Converts an ArmModel to an Orocos KDL chain, in the frame of its base.
#pragma once

#include <kdl/chain.hpp>
#include <string>

#include <repel/base/setup_error.hpp>
#include <repel/world/arm.hpp>

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

inline Pose from_kdl(const KDL::Frame& X) {
  Pose result = Pose::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result(row, column) = X.M(row, column);
    result(row, 3) = X.p(row);
  }
  return result;
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

inline void require_usable(const ArmLink& link) {
  const bool finite = is_finite(link.X_PJ) && is_finite(link.p_LC) && link.I_C_L.allFinite() &&
                      link.mass - link.mass == 0.0;
  if (!finite) throw SetupError("link '" + link.name + "' holds a value that is not finite");
  const std::string axis_length = "length of the axis of joint '" + link.joint_name + "'";
  checked(axis_length, link.axis_J.norm(), 1.0 - 1e-9, 1.0 + 1e-9, "");
}

/// @throws SetupError if the arm has no link or a value is not finite
inline KDL::Chain chain_of(const ArmModel& arm) {
  if (arm.links.empty()) throw SetupError("arm '" + arm.name + "' has no link; allowed: 1 or more");
  if (!is_finite(arm.X_WB) || !is_finite(arm.X_LT) || !is_finite(arm.gravity_W)) {
    throw SetupError("arm '" + arm.name + "' has a base, tool or gravity that is not finite");
  }
  KDL::Chain chain;
  for (const ArmLink& link : arm.links) {
    require_usable(link);
    chain.addSegment(segment_of(link));
  }
  return chain;
}

}  // namespace repel::detail
