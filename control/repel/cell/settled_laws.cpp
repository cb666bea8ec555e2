// SPDX-License-Identifier: BSD-3-Clause
#include <repel/cell/settled_laws.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <repel/loop/gain_check.hpp>
#include <repel/network/machinery/prediction.hpp>

namespace repel {

double longest_delay(const CellDescription& cell) noexcept {
  double delay = 0.0;
  for (const ArmDescription& arm : cell.arms) delay = std::max(delay, arm.options.drive_delay);
  return delay;
}

double longest_response(const CellDescription& cell) noexcept {
  const auto is_faster = [](const ArmDescription& a, const ArmDescription& b) {
    return a.options.drive_delay < b.options.drive_delay;
  };
  const auto slowest = std::max_element(cell.arms.begin(), cell.arms.end(), is_faster);
  return slowest == cell.arms.end() ? 0.0 : slowest->response;
}

double wall_delay(const CellDescription& cell) noexcept {
  const CoprocessorOptions& coprocessor = cell.coprocessor;
  const bool is_beside = coprocessor.mode == CoprocessorMode::beside && coprocessor.threads > 0;
  return longest_delay(cell) + (is_beside ? 1.0 : 0.0);
}

double stopping_distance(const CellDescription& cell) noexcept {
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

std::vector<std::string> settle_laws(CellDescription& cell) {
  std::vector<std::string> raised;
  const double period = 1.0 / cell.rate_hz;
  const auto settle = [&](ForceLaw& law) {
    if (law.hold == HoldKind::hard) law.watched = std::max(law.watched, stopping_distance(cell));
    law = settled(law, period, wall_delay(cell));
    const double needed = gain_rounding * wall_ticks(wall_delay(cell)) * period * law.stiffness();
    const double most = stable_stiffness(law.steepest_damping(), period, longest_delay(cell));
    const bool would_be_stable = law.stiffness() <= gain_rounding * most;
    if (!would_be_stable || law.steepest_damping() >= needed) return;
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
