// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The sum of the forces of lane groups.
#pragma once

#include <span>

#include <repel/pairs/forces_and_totals.hpp>
#include <repel/pairs/lane_group.hpp>

namespace repel::detail {

/// Sums the forces of lane groups into those of the bodies. Consecutive groups of the same two
/// bodies are summed lane by lane first, with a single horizontal sum at the end.
class LaneSum {
 public:
  LaneSum(const Motion& motion, PairForces& forces) noexcept : motion_(&motion), forces_(&forces) {}

  /// Adds the forces of the groups whose answers are of this tick.
  void add(std::span<const LaneGroup> groups) noexcept {
    for (std::size_t g = 0; g < groups.size();) {
      if (!groups[g].fresh()) {
        ++g;
      } else if (!groups[g].same_bodies()) {
        add_each(groups[g++]);
      } else {
        g += add_run(groups.subspan(g));
      }
    }
  }

 private:
  /// Adds the leading run of groups of the same two bodies and of this tick. Returns its length.
  std::size_t add_run(std::span<const LaneGroup> groups) noexcept {
    const BodyId a = groups[0].body_a(0);
    const BodyId b = groups[0].body_b(0);
    LaneVec force_W = groups[0].force();
    LaneVec torque_W = groups[0].torque();
    std::size_t g = 1;
    for (; g < groups.size() && groups[g].fresh() && groups[g].same_bodies() &&
           groups[g].body_a(0) == a && groups[g].body_b(0) == b;
         ++g) {
      force_W = force_W + groups[g].force();
      torque_W = torque_W + groups[g].torque();
    }
    push(a, b, sum_of(force_W), sum_of(torque_W));
    return g;
  }

  void add_each(const LaneGroup& group) noexcept {
    const auto force_W = group.force().each();
    const auto torque_W = group.torque().each();
    for (std::size_t k = 0; k < force_W.size(); ++k) {
      const auto lane = static_cast<int>(k);
      push(group.body_a(lane), group.body_b(lane), force_W[k], torque_W[k]);
    }
  }

  /// @param f_A_W,m_A_W [N, N m] on A about the origin of A; the opposite acts on B
  void push(BodyId a, BodyId b, const Vec<double>& f_A_W, const Vec<double>& m_A_W) noexcept {
    const Vec<double> p_BA_W = column<double>(motion_->bodies[a.index].X_WB, 3) -
                               column<double>(motion_->bodies[b.index].X_WB, 3);
    const Vec<double> m_B_W = m_A_W + cross(p_BA_W, f_A_W);
    const Vec3 f = to_vec3(f_A_W);
    forces_->push(a, b, {f, to_vec3(m_A_W)}, {-f, -to_vec3(m_B_W)}, *motion_);
  }

  [[nodiscard]] static Vec<double> sum_of(const LaneVec& v) noexcept {
    const auto each = v.each();
    Vec<double> sum = each[0];
    for (std::size_t k = 1; k < each.size(); ++k) sum = sum + each[k];
    return sum;
  }

  const Motion* motion_;
  PairForces* forces_;
};

}  // namespace repel::detail
