// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/barrier/barrier_rows.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

namespace repel {

BarrierRows::BarrierRows(const ArmModel& model, double margin)
    : model_(model), margin_(margin), rows_(most + 1) {
  zero_.setZero(static_cast<Eigen::Index>(model.links.size()));
}

void BarrierRows::gather(std::span<const HardContact> contacts, BodyId tool,
                         const Jacobian& jacobian, const ArmBodies& links,
                         std::span<const double> q, std::span<const double> v,
                         std::span<const double> untold, double soon) noexcept {
  clear();
  side_a_ = side_b_ = {};
  soon_ = soon;
  for (const HardContact& contact : contacts) add(contact, tool, jacobian, links, v, untold);
  for (std::size_t joint = 0; joint < q.size() && used_ > 0; ++joint) {
    add_joint(joint, q[joint], v[joint], untold[joint]);
  }
}

std::span<const BarrierRow> BarrierRows::all() const noexcept {
  return std::span(rows_).first(used_);
}

void BarrierRows::add(const HardContact& contact, BodyId tool, const Jacobian& jacobian,
                      const ArmBodies& links, std::span<const double> v,
                      std::span<const double> untold) noexcept {
  BarrierRow& row = begin_row();
  row.bending = contact.bending;
  const auto of = [&](BodyId body) { return body == tool ? &jacobian : links.jacobian_of(body); };
  const bool has_a = add_side(side_a_, of(contact.a), contact.on_a, v, row);
  const bool has_b = add_side(side_b_, of(contact.b), contact.on_b, v, row);
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
  keep();
}

bool BarrierRows::add_side(Side& side, const Jacobian* jacobian, const Wrench& F,
                           std::span<const double> v, BarrierRow& row) noexcept {
  if (jacobian == nullptr) return false;
  if (side.jacobian != jacobian) side = {jacobian, bias_of(*jacobian, v)};
  for (Eigen::Index i = 0; i < row.h.size(); ++i) {
    row.h.coeffRef(i) += power(F, column_of(*jacobian, i));
  }
  row.bending += power(F, side.bias);
  return true;
}

void BarrierRows::add_joint(std::size_t joint, double q, double v, double untold) noexcept {
  const ArmLink& link = model_.links[joint];
  for (const double side : {1.0, -1.0}) {
    const double rate = side * v + std::min(0.0, side * untold);
    const double gap = (side > 0.0 ? q - link.lower : link.upper - q) - margin_of_ranges;
    const auto begin = [&]() -> BarrierRow& {
      BarrierRow& row = begin_row();
      row.h.coeffRef(index(joint)) = side;
      row.rate = rate;
      return row;
    };
    if (link.lower < link.upper && gap < 1.0) {
      begin().gap = gap;
      keep();
    }
    const double top_speed = most_of_speed * link.velocity_limit;
    if (link.velocity_limit > 0.0 && -rate > 0.5 * top_speed) {
      begin().top_speed = top_speed;
      keep();
    }
  }
}

BarrierRow& BarrierRows::begin_row() noexcept {
  BarrierRow& row = rows_[used_];
  row.h = zero_;
  row.pair = {};
  row.gap = row.rate = row.others = row.bending = row.top_speed = 0.0;
  row.is_shared = false;
  return row;
}

void BarrierRows::keep() noexcept {
  if (used_ < most) {
    ++used_;
    return;
  }
  ++left_out_;
  const BarrierRow& row = rows_[most];
  const auto soonest = [this](const BarrierRow& r) {
    return r.gap + soon_ * std::min(r.rate, 0.0);
  };
  const auto last = std::max_element(
      rows_.begin(), rows_.begin() + most,
      [&](const BarrierRow& x, const BarrierRow& y) { return soonest(x) < soonest(y); });
  if (soonest(row) < soonest(*last)) *last = row;
}

}  // namespace repel
