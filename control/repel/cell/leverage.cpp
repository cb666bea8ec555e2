// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/leverage.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include <repel/cell/workspace.hpp>
#include <repel/loop/arms/arm_bodies.hpp>

namespace repel {

ForceLaw at_part(ForceLaw law, double leverage) noexcept {
  if (law.given_at == GivenAt::part) return law;
  law.surface_force *= leverage;
  law.damping *= leverage;
  law.ceiling *= leverage;
  return law;
}

}  // namespace repel

namespace repel::detail {

Vec3 perpendicular(const Vec3& axis, const Vec3& wish) noexcept {
  const Vec3 across = wish - dot(axis, wish) * axis;
  if (across.norm() > 1e-9) return across / across.norm();
  int least = 0;
  axis.cwiseAbs().minCoeff(&least);
  const Vec3 other = axis.cross(Vec3(Vec3::Unit(least)));
  return other / other.norm();
}

}  // namespace repel::detail

namespace repel {

double lever_of(const Shape& shape, const Pose& X_WP, const Twist& column, const Vec3& p_WC) {
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

double farthest_from_axis(const Shape& shape, const Pose& X_WP, const Twist& column,
                          const Vec3& p_WC) {
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

ArmLevers::ArmLevers(const ArmDescription& arm) {
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

double ArmLevers::leverage(int part, int from, double meets) const {
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

double ArmLevers::between(int part, int other) const {
  const auto link_of = [&](int index) {
    const int link = links_[static_cast<std::size_t>(index)];
    return link == ArmPart::on_tool ? static_cast<int>(tool_.size()) : link;
  };
  const bool is_outer = link_of(part) > link_of(other);
  return leverage(is_outer ? part : other, link_of(is_outer ? other : part) + 1);
}

double ArmLevers::meeting(const Shape& shape, const Pose& X_WP) const {
  return farthest_from_axis(shape, X_WP, first_, p_WT_);
}

void ArmLevers::add(const ArmDescription& arm, Jacobian& J) {
  const std::size_t joints = tool_.size();
  for (std::size_t part = 0; part < links_.size(); ++part) {
    const int link = links_[part];
    if (link == ArmPart::on_tool) continue;
    const Pose X_WL = arm.kinematics->X_WL(link);
    const Pose X_WP = composed(X_WL, arm.parts[part].X_FP);
    arm.kinematics->jacobian(link, X_WL.translation(), J);
    for (int joint = 0; joint <= link; ++joint) {
      double& greatest = parts_[part * joints + static_cast<std::size_t>(joint)];
      greatest = std::max(
          greatest, lever_of(arm.parts[part].shape, X_WP, column_of(J, joint), X_WL.translation()));
    }
  }
  arm.kinematics->tool_jacobian(J);
  for (std::size_t joint = 0; joint < joints; ++joint) {
    const Twist column = column_of(J, static_cast<Eigen::Index>(joint));
    tool_[joint] = std::max(tool_[joint], column.linear.norm());
  }
}

}  // namespace repel
