// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/active_contacts.hpp>

#include <algorithm>
#include <cstddef>
#include <span>

#include <repel/loop/gain_check.hpp>

namespace repel {

ActiveContacts::ActiveContacts(const World& world, std::size_t capacity,
                               std::span<const BodyId> moved)
    : world_(&world), is_moved_(static_cast<std::size_t>(world.body_count()), 0) {
  for (const BodyId body : moved) is_moved_[static_cast<std::size_t>(body.index)] = 1;
  contacts_.resize(capacity);
}

void ActiveContacts::collect(const Coprocessor& coprocessor) noexcept {
  count_ = 0;
  coprocessor.for_each_near([&](const NearPair& near) {
    if (near.force > 0.0 && count_ < contacts_.size()) add(near);
  });
  // Sums must not depend on how the pairs are shared out to threads.
  std::sort(contacts_.begin(), contacts_.begin() + static_cast<std::ptrdiff_t>(count_),
            [](const auto& x, const auto& y) { return x.pair.index < y.pair.index; });
}

std::span<const ActiveContact> ActiveContacts::all() const noexcept {
  return std::span(contacts_).first(count_);
}

void ActiveContacts::add(const NearPair& near) noexcept {
  const Pair& pair = world_->pair(near.pair);
  const Motion& motion = world_->motion();
  const BodyId of_a = world_->part(pair.a).body;
  const BodyId of_b = world_->part(pair.b).body;
  const BodyId a = carrier_of(motion, of_a);
  const BodyId b = carrier_of(motion, of_b);
  const int moved = is_moved(a) + is_moved(b);
  if (moved == 0) return;
  const Vec3& n = near.separation.extraction_W;
  const auto about = [&](BodyId body, const Vec3& force) {
    const Vec3 arm = near.separation.p_WA - origin(motion.bodies[body.index].X_WB);
    return wrench_of_force(force, arm);
  };
  const double damping =
      share_between(motion.bodies[of_a.index], motion.bodies[of_b.index]).now *
      (pair.law.passable ? pair.law.damping : pair.law.formula().damper(near.separation.distance));
  // Where two arms meet, each is solved by itself: twice the damping covers the motion of the
  // other.
  double turning = 0.0;
  if (near.has_patch) {
    const double width =
        std::min(world_->part(pair.a).shape.reach(), world_->part(pair.b).shape.reach());
    turning = near.force * width / pair.law.tilt;
  }
  contacts_[count_++] = {near.pair, a, b, about(a, n), about(b, -n), moved * damping, turning};
}

int ActiveContacts::is_moved(BodyId body) const noexcept {
  return is_moved_[static_cast<std::size_t>(body.index)];
}

void gather_damping(std::span<const ActiveContact> contacts, BodyId tool, const Jacobian& jacobian,
                    const ArmBodies& links, network::Mat<network::any_size>& damping) noexcept {
  const Eigen::Index joints = contacts.empty() ? 0 : jacobian.cols();
  damping.setZero(joints, joints);
  network::Vec<network::any_size> h(joints);
  const auto add = [&](BodyId body, const Wrench& F) {
    const Jacobian* J = body == tool ? &jacobian : links.jacobian_of(body);
    for (Eigen::Index i = 0; J != nullptr && i < joints; ++i) {
      h.coeffRef(i) += power(F, column_of(*J, i));
    }
  };
  for (const ActiveContact& contact : contacts) {
    h.setZero(joints);
    add(contact.a, contact.on_a);
    add(contact.b, contact.on_b);
    for (Eigen::Index k = 0; k < joints; ++k) {
      const double share = contact.damping * h.coeff(k);
      for (Eigen::Index i = 0; i < joints; ++i) damping.coeffRef(i, k) += share * h.coeff(i);
    }
  }
}

Wrench damp_turning(std::span<const ActiveContact> contacts, BodyId tool, const Jacobian& jacobian,
                    const Vec3& w, const TurnedArm& arm,
                    network::Mat<network::any_size>& damping) noexcept {
  if (contacts.empty()) return {};
  constexpr double calm = 0.25;  // K T^2 / I; a sampled spring alone rings from 4 on
  const double step = wall_ticks(arm.drive_delay) * arm.period;
  const double square = arm.period * arm.period;
  Wrench F;
  double most = 0.0;  // [1/(kg m^2)] mobility about any axis
  network::Vec<network::any_size> h(jacobian.cols());
  for (Eigen::Index i = 0; i < h.size(); ++i) {
    most += squared_norm(column_of(jacobian, i).angular) / arm.mass.coeff(i, i);
  }
  for (const ActiveContact& contact : contacts) {
    if (!(contact.turning * square * most > calm)) continue;
    if (contact.a != tool && contact.b != tool) continue;
    const Vec3 first = perpendicular_to(contact.on_a.force);
    for (const Vec3& axis : {first, Vec3(contact.on_a.force.cross(first))}) {
      double mobility = 0.0;  // [1/(kg m^2)]
      for (Eigen::Index i = 0; i < h.size(); ++i) {
        h.coeffRef(i) = dot(axis, column_of(jacobian, i).angular);
        mobility += h.coeff(i) * h.coeff(i) / arm.mass.coeff(i, i);
      }
      const double ringing = contact.turning * square * mobility;
      const double c = step * contact.turning * std::clamp(ringing / calm - 1.0, 0.0, 1.0);
      if (!(c > 0.0)) continue;
      F.torque += -c * dot(axis, w) * axis;
      for (Eigen::Index k = 0; k < h.size(); ++k) {
        for (Eigen::Index i = 0; i < h.size(); ++i) {
          damping.coeffRef(i, k) += c * h.coeff(i) * h.coeff(k);
        }
      }
    }
  }
  return F;
}

}  // namespace repel
