// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The gaps of one arm that must not close: of its hard contacts, and to the ends of its joints.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <repel/loop/arm_bodies.hpp>
#include <repel/loop/arm_inertia.hpp>
#include <repel/loop/hard_contacts.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// One gap of an arm, or the speed of a joint, as a row of the constraints on its motion.
struct BarrierRow {
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  PairId pair;             ///< invalid: of a joint
  Vector h;                ///< [m] torques on the joints of 1 N that opens the gap
  double gap = 0.0;        ///< [m], [rad] less its margin
  double rate = 0.0;       ///< [m/s] of the gap, positive on retreat
  double others = 0.0;     ///< [m/s] the part of it that is not of this arm
  double top_speed = 0.0;  ///< [rad/s] of a joint, in place of what a gap allows; 0: none
  bool is_shared = false;  ///< another arm can close it too
};

/// Gathers the rows of an arm. Allocates at construction only; of more rows than it has room for,
/// those are kept that will close first.
class BarrierRows {
 public:
  static constexpr std::size_t most = 64;  ///< rows in one tick

  /// @param margin [m] by which the gaps of walls count as smaller
  BarrierRows(const ArmModel& model, double margin) : model_(model), margin_(margin), rows_(most) {
    zero_.setZero(static_cast<Eigen::Index>(model.links.size()));
  }

  /// @param q [rad] or [m] @param v [rad/s] or [m/s] of the joints, as told @param untold the rates
  /// by which they move faster (JointWatch::untold_rate); they count where they close a gap
  /// @param soon [s] rows compare by their gap after this time
  void gather(std::span<const HardContact> contacts, BodyId tool, const Jacobian& jacobian,
              const ArmBodies& links, std::span<const double> q, std::span<const double> v,
              std::span<const double> untold, double soon) noexcept {
    clear();
    soon_ = soon;
    for (const HardContact& contact : contacts) add(contact, tool, jacobian, links, v, untold);
    for (std::size_t joint = 0; joint < q.size(); ++joint) {
      add_joint(joint, q[joint], v[joint], untold[joint]);
    }
  }
  void clear() noexcept { used_ = 0; }  ///< forgets all rows

  /// The rows of this tick.
  [[nodiscard]] std::span<const BarrierRow> all() const noexcept {
    return std::span(rows_).first(used_);
  }

 private:
  static constexpr double margin_of_ranges = 1e-3;  // [rad], [m]
  static constexpr double most_of_speed = 1.3;      // of the speed limit of a joint

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  void add(const HardContact& contact, BodyId tool, const Jacobian& jacobian,
           const ArmBodies& links, std::span<const double> v,
           std::span<const double> untold) noexcept {
    BarrierRow row;
    row.h = zero_;
    const bool has_a = add_torques(contact.a, contact.on_a, tool, jacobian, links, row.h);
    const bool has_b = add_torques(contact.b, contact.on_b, tool, jacobian, links, row.h);
    if (!has_a && !has_b) return;
    double own = 0.0;
    double faster = 0.0;
    double largest = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      own += row.h.coeff(index(i)) * v[i];
      faster += row.h.coeff(index(i)) * untold[i];
      largest = std::max(largest, std::abs(row.h.coeff(index(i))));
    }
    if (!(largest > 1e-6)) return;  // no joint moves it
    row.pair = contact.pair;
    row.gap = contact.gap - margin_;
    row.rate = contact.rate + std::min(0.0, faster);
    row.others = contact.rate - own;
    row.is_shared = contact.is_between_arms;
    keep(row);
  }

  // False if the body is not of this arm.
  static bool add_torques(BodyId body, const Wrench& F, BodyId tool, const Jacobian& jacobian,
                          const ArmBodies& links, BarrierRow::Vector& h) noexcept {
    links.add_torques(body, F, h);
    for (Eigen::Index i = 0; body == tool && i < h.size(); ++i) {
      h.coeffRef(i) += power(F, column_of(jacobian, i));
    }
    return body == tool || links.has(body);
  }

  // What stops a joint at the end of its range, or at its greatest speed, would leave the others to
  // the wall.
  void add_joint(std::size_t joint, double q, double v, double untold) noexcept {
    const ArmLink& link = model_.links[joint];
    for (const double side : {1.0, -1.0}) {
      BarrierRow row;
      row.h = zero_;
      row.h.coeffRef(index(joint)) = side;
      row.rate = side * v + std::min(0.0, side * untold);
      row.gap = (side > 0.0 ? q - link.lower : link.upper - q) - margin_of_ranges;
      if (link.lower < link.upper && row.gap < 1.0) keep(row);
      row.gap = 0.0;
      row.top_speed = most_of_speed * link.velocity_limit;
      if (link.velocity_limit > 0.0 && -row.rate > 0.5 * row.top_speed) keep(row);
    }
  }

  void keep(const BarrierRow& row) noexcept {
    if (used_ < rows_.size()) {
      rows_[used_++] = row;
      return;
    }
    const auto soonest = [this](const BarrierRow& r) {
      return r.gap + soon_ * std::min(r.rate, 0.0);
    };
    const auto last = std::max_element(
        rows_.begin(), rows_.end(),
        [&](const BarrierRow& x, const BarrierRow& y) { return soonest(x) < soonest(y); });
    if (soonest(row) < soonest(*last)) *last = row;
  }

  const ArmModel& model_;
  double margin_;      // [m]
  double soon_ = 0.0;  // [s]
  BarrierRow::Vector zero_;
  std::vector<BarrierRow> rows_;
  std::size_t used_ = 0;
};

}  // namespace repel
