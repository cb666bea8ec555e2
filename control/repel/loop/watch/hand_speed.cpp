// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/hand_speed.hpp>

#include <algorithm>
#include <cmath>

#include <repel/network/elements/changing_scale.hpp>
#include <repel/network/modules/multiplex.hpp>

namespace repel::detail {

double length_of(const Vec3& v) noexcept {
  const double most = largest_entry(v);
  if (!(most > 0.0)) return most;
  const double inverse = 1.0 / most;
  const double x = v.coeff(0) * inverse, y = v.coeff(1) * inverse, z = v.coeff(2) * inverse;
  return most * std::sqrt(x * x + y * y + z * z);
}

}  // namespace repel::detail

namespace repel {

bool rest_unless_finite(network::HandInput& hand, const network::HandInput& last) noexcept {
  if (hand.is_finite()) return true;
  hand.rest();
  hand.direction_W = last.direction_W;
  hand.turning_W = last.turning_W;
  return false;
}

bool cut_to_speed(network::HandInput& hand, double limit, double scale) noexcept {
  const double ball = detail::length_of(hand.ball.linear);
  if (ball > limit) hand.ball.linear = hand.ball.linear * (limit / ball);
  const double length = detail::length_of(hand.direction_W);
  if (length > 1.0 + 1e-9) {
    hand.direction_W = hand.direction_W / length;
    hand.turning_W = hand.turning_W / length;  // the same screw
  }
  const bool has_scale =
      hand.scale >= network::ChangingScale::least && hand.scale <= network::ChangingScale::most;
  if (!has_scale) hand.scale = 1.0;
  const double most = limit / (scale * hand.scale);
  const bool is_fast = ball > limit || std::abs(hand.lever_rate) > most;
  hand.lever_rate = std::clamp(hand.lever_rate, -most, most);
  return is_fast;
}

LeverScales lever_scales(const network::Network& network) noexcept {
  LeverScales scales;
  for (const network::Node& node : network.nodes()) {
    const auto* lever = node.module.as<network::Multiplex>();
    if (lever == nullptr) continue;
    const bool is_first = lever->hand() == network::Hand::first;
    (is_first ? scales.first : scales.second) = lever->velocity_scale();
  }
  return scales;
}

bool cut_to_speed(network::Signals& signals, double limit, const LeverScales& scales) noexcept {
  const bool is_cut = cut_to_speed(signals.hand, limit, scales.first);
  return cut_to_speed(signals.second, limit, scales.second) || is_cut;
}

}  // namespace repel
