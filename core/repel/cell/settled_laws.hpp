// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a cell adds to the laws of its walls: damping for its rate and delays, and how far ahead
/// hard walls are watched.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <repel/cell/description.hpp>
#include <repel/loop/gain_check.hpp>
#include <repel/network/machinery/prediction.hpp>

namespace repel {

/// [ticks] The delay of the slowest drive.
[[nodiscard]] inline double longest_delay(const CellDescription& cell) noexcept {
  double delay = 0.0;
  for (const ArmDescription& arm : cell.arms) delay = std::max(delay, arm.options.drive_delay);
  return delay;
}

/// [s] The part of the delay of the slowest drive that a faster tick does not shorten.
[[nodiscard]] inline double longest_response(const CellDescription& cell) noexcept {
  const auto is_faster = [](const ArmDescription& a, const ArmDescription& b) {
    return a.options.drive_delay < b.options.drive_delay;
  };
  const auto slowest = std::max_element(cell.arms.begin(), cell.arms.end(), is_faster);
  return slowest == cell.arms.end() ? 0.0 : slowest->response;
}

/// [ticks] How late the force of a wall acts: as late as the slowest drive, and a tick more where
/// the coprocessor works beside.
[[nodiscard]] inline double wall_delay(const CellDescription& cell) noexcept {
  const CoprocessorOptions& coprocessor = cell.coprocessor;
  const bool is_beside = coprocessor.mode == CoprocessorMode::beside && coprocessor.threads > 0;
  return longest_delay(cell) + (is_beside ? 1.0 : 0.0);
}

/// The distance [m], up to 1 m, in which arms and moving obstacles stop that approach each other
/// at half as much again as the tools may be driven at: with 2 m/s^2, which most arms are capable
/// of, after their slew time and the delay of the slowest drive. What comes faster is braked later,
/// as hard as the efforts allow.
[[nodiscard]] inline double stopping_distance(const CellDescription& cell) noexcept {
  constexpr double deceleration = 2.0;  // [m/s^2]
  constexpr double surplus = 1.5;
  double speed = 0.0;
  double reaction = 0.0;
  for (const ArmDescription& arm : cell.arms) {
    speed += surplus * arm.options.tool_speed;
    reaction = std::max(reaction, arm.options.torques.slew_time);
  }
  double moving = 0.0;
  for (const ObstacleDescription& obstacle : cell.obstacles) {
    if (obstacle.motion) moving = std::max(moving, obstacle.motion->top_speed());
  }
  speed += moving;
  reaction += (network::Prediction::horizon(longest_delay(cell)) + 2.0) / cell.rate_hz;
  return std::min(1.0, speed * reaction + 0.5 * speed * speed / deceleration);
}

/// Raises the damping of each law where it may rise, and where a wall is stable but for the tick by
/// which answers are older beside; and `watched` of hard walls to the stopping distance. Not for
/// the tick.
/// @return one sentence for each damping that was raised beyond what it was given
inline std::vector<std::string> settle_laws(CellDescription& cell) {
  std::vector<std::string> raised;
  const double period = 1.0 / cell.rate_hz;
  const auto settle = [&](ForceLaw& law) {
    if (law.hold == HoldKind::hard) law.watched = std::max(law.watched, stopping_distance(cell));
    law = settled(law, period, wall_delay(cell));
    const double needed = gain_rounding * wall_ticks(wall_delay(cell)) * period * law.stiffness();
    const double most = stable_stiffness(law.damping, period, longest_delay(cell));
    const bool would_be_stable = law.stiffness() <= gain_rounding * most;
    if (!would_be_stable || law.damping >= needed) return;
    std::string said = "beside, forces are one tick late: the damping of walls of " +
                       to_text(law.stiffness(), 4) + " N/m is " + to_text_above(needed, 4) +
                       " N s/m, not " + to_text(law.damping);
    law.damping = needed;
    if (wall_delay(cell) == longest_delay(cell)) return;  // raised by rounding alone
    if (std::find(raised.begin(), raised.end(), said) == raised.end()) {
      raised.push_back(std::move(said));
    }
  };
  for (ArmDescription& arm : cell.arms) {
    settle(arm.law);
    if (arm.self_law) settle(*arm.self_law);
  }
  for (ObstacleDescription& obstacle : cell.obstacles) settle(obstacle.law);
  for (LooseDescription& loose : cell.loose) settle(loose.law);
  return raised;
}

}  // namespace repel
