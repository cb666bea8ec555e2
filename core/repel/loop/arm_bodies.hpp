/// @file
/// The links of the arm as bodies of the world: where they are, and what pushes them, as torques.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <repel/base/spatial.hpp>
#include <repel/network/port.hpp>
#include <repel/schedule/pair_forces.hpp>
#include <repel/world/arm.hpp>
#include <repel/world/world.hpp>

namespace repel {

/// Six rows, linear then angular, world axes; a column for each joint.
using Jacobian = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// What moves with the joint rates `v` [rad/s] or [m/s] through `J`.
[[nodiscard]] inline Twist twist_through(const Jacobian& J, std::span<const double> v) noexcept {
  Twist V;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const auto column = J.col(static_cast<Eigen::Index>(i));
    V.linear += v[i] * column.head<3>();
    V.angular += v[i] * column.tail<3>();
  }
  return V;
}

/// A body of the world that moves with a link of the arm, its frame that of the link.
struct LinkBody {
  BodyId body;
  int link = 0;  ///< index in ArmModel::links
};

/// Moves the bodies of the links with the arm and gathers what pushes them. Memory is taken at
/// construction. Cost: that of a Jacobian for each body.
class ArmBodies {
 public:
  ArmBodies(std::vector<LinkBody> links, int joints)
      : links_(std::move(links)),
        drawn_(Jacobian::Zero(6, joints)),
        jacobians_(links_.size(), drawn_) {}

  [[nodiscard]] std::span<const LinkBody> bodies() const noexcept { return links_; }

  /// Places every body where `kinematics` is, moving with the joint rates `v`. False when a pose is
  /// not sound: that body stays where it was.
  template <ArmKinematics Kinematics>
  [[nodiscard]] bool place(World& world, const Kinematics& kinematics,
                           std::span<const double> v) noexcept {
    bool sound = true;
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Pose& X_WL = kinematics.X_WL(links_[i].link);
      kinematics.jacobian(links_[i].link, X_WL.translation(), drawn_);
      if (world.place(links_[i].body, X_WL, twist_through(drawn_, v))) {
        jacobians_[i].swap(drawn_);
      } else {
        sound = false;
      }
    }
    return sound;
  }

  /// The torques [N m] or forces [N] on the joints, sum of J' F over the bodies, F the wrench on a
  /// body about the origin of its link: the work of all the forces is theirs at the joints.
  void gather(const PairForces& forces, network::Vec<network::any_size>& torques) const noexcept {
    torques.setZero(drawn_.cols());
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Wrench& F = forces.on_body[links_[i].body.index];
      for (int joint = 0; joint <= links_[i].link; ++joint) {  // those beyond do not move it
        const auto column = jacobians_[i].col(joint);
        torques(joint) += column.head<3>().dot(F.force) + column.tail<3>().dot(F.torque);
      }
    }
  }

  /// What the bodies that push the links give by their own motion [W].
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
