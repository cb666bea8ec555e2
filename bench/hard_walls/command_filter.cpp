// SPDX-License-Identifier: BSD-3-Clause
#include "command_filter.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <repel/cell/layout.hpp>

namespace repel::hard_walls {

CommandFilter::CommandFilter(Way way, CellDescription description)
    : way_(way), cell_(std::move(description)) {
  std::vector<BodyId> tools;
  for (std::size_t i = 0; i < cell_.arms(); ++i) tools.push_back(cell_.layout(i).tool);
  contacts_.emplace(cell_.world(), tools);
}

void CommandFilter::sense(std::span<const ArmReadings> readings, std::chrono::nanoseconds now) {
  cell_.sense(readings, now);
  contacts_->collect(cell_.coprocessor(), 0.2);
  (void)cell_.act({});
}

void CommandFilter::filter(std::size_t arm, Twist& V) const {
  const BodyId tool = cell_.layout(arm).tool;
  double share = 1.0;
  for (int sweep = 0; sweep < 10; ++sweep) {
    for (const HardContact& contact : contacts_->all()) {
      if (contact.a != tool && contact.b != tool) continue;
      const Wrench& on_tool = contact.a == tool ? contact.on_a : contact.on_b;
      const double rate = power(on_tool, V);
      const double missing = -allowed(contact.gap) - rate;
      if (missing <= 0.0) continue;
      if (way_ == Way::stopping_distance) {
        share = std::min(share, allowed(contact.gap) / -rate);
        continue;
      }
      // The smallest change, where 1 rad counts as 0.1 m.
      const double turn = 100.0;
      const double per = squared_norm(on_tool.force) + turn * squared_norm(on_tool.torque);
      V.linear += missing / per * on_tool.force;
      V.angular += missing / per * turn * on_tool.torque;
    }
  }
  V = share * V;
}

double CommandFilter::allowed(double gap) const {
  const double d = std::max(0.0, gap - 2e-3);
  switch (way_) {
    case Way::velocity_damper:  // Faverjon, Tournassoud 1987, from 50 mm on
      return d < 0.05 ? 0.5 * d / 0.05 : 1e9;
    case Way::barrier_function:  // Ames et al. 2017, dd/dt >= -gamma d with gamma = 5 / s
      return 5.0 * d;
    default:  // speed and separation: it stops at 2 m/s^2 after 50 ms
      return std::sqrt(0.01 + 4.0 * d) - 0.1;
  }
}

}  // namespace repel::hard_walls
