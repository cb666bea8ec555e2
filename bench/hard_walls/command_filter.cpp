// SPDX-License-Identifier: BSD-3-Clause
#include "command_filter.hpp"

#include <algorithm>
#include <cmath>

namespace repel::hard_walls {
namespace {

// [m/s] at a gap [m]
double allowed(Way way, double gap) {
  const double d = std::max(0.0, gap - 2e-3);
  switch (way) {
    case Way::velocity_damper:  // Faverjon, Tournassoud 1987, from 50 mm on
      return d < 0.05 ? 0.5 * d / 0.05 : 1e9;
    case Way::barrier_function:  // Ames et al. 2017, dd/dt >= -gamma d with gamma = 5 / s
      return 5.0 * d;
    default:  // speed and separation: it stops at 2 m/s^2 after 50 ms
      return std::sqrt(0.01 + 4.0 * d) - 0.1;
  }
}

}  // namespace

void filter_command(Way way, std::span<const HardContact> gaps, BodyId tool, Twist& V) {
  double share = 1.0;
  for (int sweep = 0; sweep < 10; ++sweep) {
    for (const HardContact& contact : gaps) {
      if (contact.a != tool && contact.b != tool) continue;
      const Wrench& on_tool = contact.a == tool ? contact.on_a : contact.on_b;
      const double rate = power(on_tool, V);
      const double missing = -allowed(way, contact.gap) - rate;
      if (missing <= 0.0) continue;
      if (way == Way::stopping_distance) {
        share = std::min(share, allowed(way, contact.gap) / -rate);
        continue;
      }
      // The least change of the twist, 1 rad/s weighted as 0.1 m/s.
      const double turn = 100.0;
      const double per = squared_norm(on_tool.force) + turn * squared_norm(on_tool.torque);
      V.linear += missing / per * on_tool.force;
      V.angular += missing / per * turn * on_tool.torque;
    }
  }
  V = share * V;
}

}  // namespace repel::hard_walls
