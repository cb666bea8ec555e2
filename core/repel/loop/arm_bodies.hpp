// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The links of the arm as bodies of the world: their poses, and the forces on them as joint
/// torques.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/network/elements/port.hpp>
#include <repel/schedule/pair_forces.hpp>
#include <repel/world/arm_kinematics.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// Column `joint` of `J`: the twist at a rate of 1 of that joint.
[[nodiscard]] inline Twist column_of(const Jacobian& J, Eigen::Index joint) noexcept {
  const double* c = J.data() + 6 * joint;
  return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
}

/// J v, the twist at the joint rates `v` [rad/s] or [m/s].
[[nodiscard]] inline Twist twist_through(const Jacobian& J, std::span<const double> v) noexcept {
  Twist V;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Twist column = column_of(J, static_cast<Eigen::Index>(i));
    V.linear += v[i] * column.linear;
    V.angular += v[i] * column.angular;
  }
  return V;
}

/// Makes the tool and the links one arm of the world. @return `links`
[[nodiscard]] inline std::vector<LinkBody> joined(World& world, BodyId tool,
                                                  std::vector<LinkBody> links) {
  world.join(tool, tool);
  for (const LinkBody& link : links) world.join(link.body, tool);
  return links;
}

/// Moves the link bodies with the arm and collects the forces on them. Allocates at construction
/// only. Cost: one Jacobian for each body.
class ArmBodies {
 public:
  /// The links that have bodies, of an arm of so many joints.
  ArmBodies(std::vector<LinkBody> links, int joints)
      : links_(std::move(links)),
        drawn_(Jacobian::Zero(6, joints)),
        jacobians_(links_.size(), drawn_) {}

  /// The links that have bodies.
  [[nodiscard]] std::span<const LinkBody> bodies() const noexcept { return links_; }

  /// Places every body at its pose from `kinematics`, moving with the joint rates `v`. False when a
  /// pose is invalid: that body stays where it was.
  [[nodiscard]] bool place(World& world, const ArmKinematics& kinematics,
                           std::span<const double> v) noexcept {
    bool sound = true;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Pose X_WL = kinematics.X_WL(links_[i].link);
      kinematics.jacobian(links_[i].link, origin(X_WL), drawn_);
      if (world.place(links_[i].body, X_WL, twist_through(drawn_, v))) {
        jacobians_[i].swap(drawn_);
      } else {
        sound = false;
      }
    }
    return sound;
  }

  /// The torques [N m] or forces [N] on the joints, sum of J' F over the bodies, F the wrench on a
  /// body about the origin of its link: they do the same work as all the forces. With those on the
  /// `tool` from links of the arm itself, `of_tool` the Jacobian of its frame: what a pair does to
  /// both its bodies belongs to one energy account.
  void gather(const PairForces& forces, BodyId tool, const Jacobian& of_tool,
              network::Vec<network::any_size>& torques) const noexcept {
    torques.setZero(drawn_.cols());
    for (Eigen::Index joint = 0; forces.has_own && joint < torques.size(); ++joint) {
      torques.coeffRef(joint) += power(forces.from_own[tool.index], column_of(of_tool, joint));
    }
    for (std::size_t i = 0; i < links_.size(); ++i) {
      Wrench F = forces.on_body[links_[i].body.index];
      if (forces.has_own) F += forces.from_own[links_[i].body.index];
      for (int joint = 0; joint <= links_[i].link; ++joint) {  // joints beyond do not move it
        torques.coeffRef(joint) += power(F, column_of(jacobians_[i], joint));
      }
    }
  }

  /// The body is one of them.
  [[nodiscard]] bool has(BodyId body) const noexcept {
    for (const LinkBody& link : links_) {
      if (link.body == body) return true;
    }
    return false;
  }

  /// Adds to `torques` [N m] those of the wrench `F` on `body`; nothing if it is not on the arm.
  void add_torques(BodyId body, const Wrench& F,
                   network::Vec<network::any_size>& torques) const noexcept {
    for (std::size_t i = 0; i < links_.size(); ++i) {
      if (links_[i].body != body) continue;
      for (int joint = 0; joint <= links_[i].link; ++joint) {
        torques.coeffRef(joint) += power(F, column_of(jacobians_[i], joint));
      }
    }
  }

  /// Power that the bodies which push the links deliver by their own motion [W].
  [[nodiscard]] double carried(const PairForces& forces) const noexcept {
    double sum = 0.0;
    for (const LinkBody& link : links_) sum += forces.carried[link.body.index];
    return sum;
  }

 private:
  std::vector<LinkBody> links_;
  Jacobian drawn_;
  std::vector<Jacobian> jacobians_;  // of the origin of each link
};

}  // namespace repel
