/// @file
/// The sum of the forces of contacts.
#pragma once

#include <vector>

#include <repel/schedule/contact_lanes.hpp>

namespace repel::detail {

/// Adds up lane by lane while the groups are of the same two bodies, and only then across the
/// lanes.
class LaneWrench {
 public:
  /// @param on_body [N, N m] by BodyId, about each body's origin: takes what is complete
  void add(const ContactGroup& group, const Motion& motion, std::vector<Wrench>& on_body) noexcept {
    if (!group.is_one_meeting()) return add_each(group, motion, on_body);
    if (a_ != group.body_a(0) || b_ != group.body_b(0)) {
      hand_over(motion, on_body);
      a_ = group.body_a(0);
      b_ = group.body_b(0);
    }
    force_W_ = force_W_ + group.force();
    torque_W_ = torque_W_ + group.torque();
  }

  /// The rest of the sum.
  void hand_over(const Motion& motion, std::vector<Wrench>& on_body) noexcept {
    if (!a_.valid()) return;
    act(a_, b_, {sum_of(force_W_), sum_of(torque_W_)}, motion, on_body);
    force_W_ = LaneVec{};
    torque_W_ = LaneVec{};
    a_ = {};
  }

 private:
  static void add_each(const ContactGroup& group, const Motion& motion,
                       std::vector<Wrench>& on_body) noexcept {
    for (int k = 0; k < lane_count; ++k) {
      act(group.body_a(k), group.body_b(k), {group.force().at(k), group.torque().at(k)}, motion,
          on_body);
    }
  }

  /// @param F_A_W on A about the origin of A; B feels the opposite
  static void act(BodyId a, BodyId b, const Wrench& F_A_W, const Motion& motion,
                  std::vector<Wrench>& on_body) noexcept {
    const Vec3 p_AB_W =
        motion.bodies[b.index].X_WB.translation() - motion.bodies[a.index].X_WB.translation();
    on_body[a.index] += F_A_W;
    on_body[b.index] += -1.0 * moved_to(F_A_W, p_AB_W);
  }

  [[nodiscard]] static Vec3 sum_of(const LaneVec& v) noexcept {
    Vec3 sum = v.at(0);
    for (int k = 1; k < lane_count; ++k) sum += v.at(k);
    return sum;
  }

  BodyId a_, b_;
  LaneVec force_W_{}, torque_W_{};  ///< [N, N m] on A about its origin
};

}  // namespace repel::detail
