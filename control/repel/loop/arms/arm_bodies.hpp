// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The links of the arm as bodies of the world: their poses, and the forces on them as joint
/// torques.
#pragma once

#include <span>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/network/elements/port.hpp>
#include <repel/pairs/forces_and_totals.hpp>
#include <repel/world/arm_kinematics.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// Column `joint` of `J`: the twist at a rate of 1 of that joint.
[[nodiscard]] Twist column_of(const Jacobian& J, Eigen::Index joint) noexcept;

/// J v, the twist at the joint rates `v` [rad/s] or [m/s].
[[nodiscard]] Twist twist_through(const Jacobian& J, std::span<const double> v) noexcept;

/// (dJ/dt) v, the acceleration at constant joint rates `v` [rad/s] or [m/s]: linear [m/s^2] of the
/// point that the linear rows of J are of, angular [rad/s^2]. From J alone: joint i turns or moves
/// the columns of all joints after it (H. Bruyninckx, J. De Schutter, "Symbolic differentiation of
/// the velocity mapping for a serial kinematic chain", 1996).
[[nodiscard]] Twist bias_of(const Jacobian& J, std::span<const double> v) noexcept;

/// Makes the tool and the links one arm of the world. @return `links`
[[nodiscard]] std::vector<LinkBody> joined(World& world, BodyId tool, std::vector<LinkBody> links);

/// Moves the link bodies with the arm and collects the forces on them. Allocates at construction
/// only. Cost: one Jacobian for each body.
class ArmBodies {
 public:
  /// The links that have bodies, of an arm of so many joints.
  ArmBodies(std::vector<LinkBody> links, int joints);

  /// The links that have bodies.
  [[nodiscard]] std::span<const LinkBody> bodies() const noexcept {
    return {links_.data(), links_.size()};
  }

  /// Places every body at its pose from `kinematics`, moving with the joint rates `v`. False for an
  /// invalid pose: that body is not moved.
  [[nodiscard]] bool place(World& world, const ArmKinematics& kinematics,
                           std::span<const double> v) noexcept;

  /// The torques [N m] or forces [N] on the joints, sum of J' F over the bodies, F the wrench on a
  /// body about the origin of its link: they do the same work as all the forces. With those on the
  /// `tool` from links of the arm itself, `of_tool` the Jacobian of its frame: what a pair does to
  /// both its bodies belongs to one energy account.
  void gather(const PairForces& forces, BodyId tool, const Jacobian& of_tool,
              network::Vec<network::any_size>& torques) const noexcept;

  /// Jacobian of the origin of the link with this body; null: none has it.
  [[nodiscard]] const Jacobian* jacobian_of(BodyId body) const noexcept;

  /// Power delivered to the links by the motion of the bodies pushing them [W].
  [[nodiscard]] double carried(const PairForces& forces) const noexcept;

 private:
  std::vector<LinkBody> links_;
  Jacobian drawn_;
  std::vector<Jacobian> jacobians_;  // of the origin of each link
};

}  // namespace repel
