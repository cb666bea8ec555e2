// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/arms/arm_bodies.hpp>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace repel {

Twist column_of(const Jacobian& J, Eigen::Index joint) noexcept {
  const double* c = J.data() + 6 * joint;
  return {{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
}

Twist twist_through(const Jacobian& J, std::span<const double> v) noexcept {
  Twist V;
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Twist column = column_of(J, static_cast<Eigen::Index>(i));
    V.linear += v[i] * column.linear;
    V.angular += v[i] * column.angular;
  }
  return V;
}

Twist bias_of(const Jacobian& J, std::span<const double> v) noexcept {
  Twist bias;
  Twist after;  // of the joints after this one
  for (std::size_t i = v.size(); i-- > 0;) {
    const Twist column = column_of(J, static_cast<Eigen::Index>(i));
    const Vec3 turn = v[i] * column.angular;
    bias.linear += turn.cross(Vec3(v[i] * column.linear + 2.0 * after.linear));
    bias.angular += turn.cross(after.angular);
    after.linear += v[i] * column.linear;
    after.angular += turn;
  }
  return bias;
}

std::vector<LinkBody> joined(World& world, BodyId tool, std::vector<LinkBody> links) {
  world.join(tool, tool);
  for (const LinkBody& link : links) world.join(link.body, tool);
  return links;
}

ArmBodies::ArmBodies(std::vector<LinkBody> links, int joints)
    : links_(std::move(links)),
      drawn_(Jacobian::Zero(6, joints)),
      jacobians_(links_.size(), drawn_) {}

bool ArmBodies::place(World& world, const ArmKinematics& kinematics,
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

void ArmBodies::gather(const PairForces& forces, BodyId tool, const Jacobian& of_tool,
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

const Jacobian* ArmBodies::jacobian_of(BodyId body) const noexcept {
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (links_[i].body == body) return &jacobians_[i];
  }
  return nullptr;
}

double ArmBodies::carried(const PairForces& forces) const noexcept {
  double sum = 0.0;
  for (const LinkBody& link : links_) sum += forces.carried[link.body.index];
  return sum;
}

}  // namespace repel
