// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The leverage of the operator: by how much a push at the tool outweighs a force on a link, and
/// force laws that allow for it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/cell/description.hpp>
#include <repel/cell/workspace.hpp>
#include <repel/loop/arm_bodies.hpp>
#include <repel/reduction/shape.hpp>

namespace repel {

/// The greatest leverage that counts: a part so close to a joint is hardly moved by it.
inline constexpr double most_leverage = 10.0;

/// The law as it acts at a part over which the tool has this `leverage` [1], 1 or more. A law given
/// at the tool has its forces, its damping and so its stiffness multiplied by it, which leaves the
/// ratio of damping to stiffness as it was; one given at the part is returned unchanged.
[[nodiscard]] inline ForceLaw at_part(ForceLaw law, double leverage) noexcept {
  if (law.given_at == GivenAt::part) return law;
  law.surface_force *= leverage;
  law.damping *= leverage;
  law.ceiling *= leverage;
  return law;
}

namespace detail {

/// Calls `visit(n, Q)` with unit directions n perpendicular to the unit vector `axis` and the
/// points Q [m] of the core of the shape that are the farthest along them. @param first one of the
/// directions, perpendicular to `axis`
template <class Visit>
void for_each_side(const Shape& shape, const Pose& X_WP, const Vec3& axis, const Vec3& first,
                   const Visit& visit) {
  constexpr int sides = 24;
  // Two directions about each: one alone has no single farthest point on a flat side.
  constexpr double tilt = 1e-3;  // [rad]
  const Vec3 second = axis.cross(first);
  for (int side = 0; side < sides; ++side) {
    for (const double aside : {tilt, -tilt}) {
      const double turn = side * 2.0 * std::numbers::pi / sides + aside;
      const Vec3 n = std::cos(turn) * first + std::sin(turn) * second;
      const Vec<double> d = rotate_transposed(X_WP, Vec<double>(n[0], n[1], n[2]));
      visit(n, X_WP * to_vec3(shape.level(0).core.support(d).p));
    }
  }
}

/// A unit vector perpendicular to the unit vector `axis`, along `wish` as far as possible.
[[nodiscard]] inline Vec3 perpendicular(const Vec3& axis, const Vec3& wish) noexcept {
  const Vec3 across = wish - dot(axis, wish) * axis;
  if (across.norm() > 1e-9) return across / across.norm();
  int least = 0;
  axis.cwiseAbs().minCoeff(&least);
  const Vec3 other = axis.cross(Vec3(Vec3::Unit(least)));
  return other / other.norm();
}

}  // namespace detail

/// The lever of a shape about a joint [m]: the greatest torque [N m] about the axis of the joint by
/// which a force of 1 N can push against the surface of the shape, across the axis. 1 for a joint
/// that slides. Too small by up to 4 percent: directions 15 degrees apart are tried.
/// @param column twist of the joint at 1 rad/s or 1 m/s, at the point `p_WC` [m]
[[nodiscard]] inline double lever_of(const Shape& shape, const Pose& X_WP, const Twist& column,
                                     const Vec3& p_WC) {
  const double turns = column.angular.norm();
  if (!(turns > 0.5)) return column.linear.norm();
  const Vec3 axis = column.angular / turns;
  const auto speed = [&](const Vec3& p_WQ) -> Vec3 {
    return column.linear + column.angular.cross(Vec3(p_WQ - p_WC));
  };
  double lever = 0.0;
  const Vec3 first = detail::perpendicular(axis, speed(X_WP.translation()));
  detail::for_each_side(shape, X_WP, axis, first, [&](const Vec3& n, const Vec3& p_WQ) {
    lever = std::max(lever, dot(n, speed(p_WQ)));
  });
  return lever;
}

/// The distance [m] from the axis of a joint to the farthest point of the shape; infinite for a
/// joint that slides. Parameters and accuracy as above.
[[nodiscard]] inline double farthest_from_axis(const Shape& shape, const Pose& X_WP,
                                               const Twist& column, const Vec3& p_WC) {
  const double turns = column.angular.norm();
  if (!(turns > 0.5)) return std::numeric_limits<double>::infinity();
  const Vec3 axis = column.angular / turns;
  // From the axis to C: what its speed is, turned back by a right angle.
  const Vec3 p_AC = column.linear.cross(axis);
  double farthest = 0.0;
  const Vec3 first = detail::perpendicular(axis, p_AC + X_WP.translation() - p_WC);
  detail::for_each_side(shape, X_WP, axis, first, [&](const Vec3& /*n*/, const Vec3& p_WQ) {
    const Vec3 p_AQ = p_AC + p_WQ - p_WC;
    farthest = std::max(farthest, (p_AQ - dot(axis, p_AQ) * axis).norm());
  });
  return farthest + shape.level(0).depth;
}

/// The levers of the tool and of the link parts of an arm about its joints, the greatest over poses
/// spread evenly over the ranges of the joints.
class ArmLevers {
 public:
  static constexpr int poses = 256;  ///< in which an arm is looked at

  ArmLevers() = default;
  /// Leaves the kinematics of the arm at its `start`. Nothing is computed for an arm without link
  /// parts. Cost: kinematics, and 48 support maps for each part and joint, in each of the poses:
  /// 20 ms for an arm of six joints.
  explicit ArmLevers(const ArmDescription& arm) {
    for (const ArmPart& part : arm.parts) links_.push_back(part.link);
    if (std::all_of(links_.begin(), links_.end(), [](int l) { return l == ArmPart::on_tool; })) {
      return;
    }
    const std::size_t joints = arm.model.links.size();
    tool_.assign(joints, 0.0);
    parts_.assign(links_.size() * joints, 0.0);
    std::vector<double> q = arm.start;
    Jacobian J(6, static_cast<Eigen::Index>(joints));
    add(arm, J);
    first_ = column_of(J, 0);
    p_WT_ = arm.kinematics->X_WT().translation();
    for (int pose = 0; pose < poses; ++pose) {
      detail::draw_pose(arm, pose, q);
      arm.kinematics->update(q);
      add(arm, J);
    }
    arm.kinematics->update(arm.start);
  }

  /// The leverage of the tool over a part [1], 1 to `most_leverage`: the greatest ratio of their
  /// levers over the joints from `from` on that move the part. So much greater than a force at the
  /// tool must a force at the part be to hold it, where it is pushed at its greatest lever.
  /// @param part index in ArmDescription::parts @param meets [m] bound of the lever about the first
  /// joint
  [[nodiscard]] double leverage(int part, int from = 0,
                                double meets = std::numeric_limits<double>::infinity()) const {
    const int link = links_[static_cast<std::size_t>(part)];
    double most = 1.0;
    for (int joint = from; joint <= link; ++joint) {
      const double tool = tool_[static_cast<std::size_t>(joint)];
      double lever =
          parts_[static_cast<std::size_t>(part) * tool_.size() + static_cast<std::size_t>(joint)];
      if (joint == 0) lever = std::min(lever, meets);
      // A part that is all but round about the joint is not moved into anything by it.
      if (lever > least_lever * tool) most = std::max(most, tool / lever);
    }
    return std::min(most, most_leverage);
  }

  /// The same of two parts of the arm: over the outer one, about the joints between them.
  [[nodiscard]] double between(int part, int other) const {
    const auto link_of = [&](int index) {
      const int link = links_[static_cast<std::size_t>(index)];
      return link == ArmPart::on_tool ? static_cast<int>(tool_.size()) : link;
    };
    const bool is_outer = link_of(part) > link_of(other);
    return leverage(is_outer ? part : other, link_of(is_outer ? other : part) + 1);
  }

  /// The bound above for parts that meet a shape fixed in the world: its farthest point from the
  /// axis of the first joint [m], which stands still.
  [[nodiscard]] double meeting(const Shape& shape, const Pose& X_WP) const {
    return farthest_from_axis(shape, X_WP, first_, p_WT_);
  }

 private:
  static constexpr double least_lever = 0.02;  // of that of the tool

  void add(const ArmDescription& arm, Jacobian& J) {
    const std::size_t joints = tool_.size();
    for (std::size_t part = 0; part < links_.size(); ++part) {
      const int link = links_[part];
      if (link == ArmPart::on_tool) continue;
      const Pose X_WL = arm.kinematics->X_WL(link);
      const Pose X_WP = composed(X_WL, arm.parts[part].X_FP);
      arm.kinematics->jacobian(link, X_WL.translation(), J);
      for (int joint = 0; joint <= link; ++joint) {
        double& greatest = parts_[part * joints + static_cast<std::size_t>(joint)];
        greatest = std::max(greatest, lever_of(arm.parts[part].shape, X_WP, column_of(J, joint),
                                               X_WL.translation()));
      }
    }
    arm.kinematics->tool_jacobian(J);
    for (std::size_t joint = 0; joint < joints; ++joint) {
      const Twist column = column_of(J, static_cast<Eigen::Index>(joint));
      tool_[joint] = std::max(tool_[joint], column.linear.norm());
    }
  }

  std::vector<int> links_;     // of each part
  std::vector<double> tool_;   // by joint
  std::vector<double> parts_;  // by part, then by joint
  Twist first_;                // of the first joint, at the start
  Vec3 p_WT_{0, 0, 0};         // [m] where `first_` is taken
};

}  // namespace repel
