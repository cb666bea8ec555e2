/// @file
/// Keeps the tool within the speed it may have.
#pragma once

#include <algorithm>
#include <cmath>

#include <repel/network/signals.hpp>

namespace repel {

/// What is left of what drives the tool, and how much the arm brakes, at a speed.
struct SpeedShare {
  double drive = 1.0;  ///< 1 up to the limit, 0 from 1.2 times it
  double brake = 0.0;  ///< 0 up to 1.2 times the limit, 1 from 1.5 times it
};

/// @param speed of the tool [m/s]; `limit` [m/s] at which the operator may lead it, above 0
[[nodiscard]] inline SpeedShare speed_share(double speed, double limit) noexcept {
  const double part = speed / limit;
  return {std::clamp(1.0 - (part - 1.0) / 0.2, 0.0, 1.0), std::clamp((part - 1.2) / 0.3, 0.0, 1.0)};
}

/// No hand leads faster than the tool may be: cuts what it does to that. The way of the lever is at
/// most of length one. True when something was cut.
/// @param scale of the lever [m/rad], above 0
[[nodiscard]] inline bool cut_to_speed(network::HandInput& hand, double limit,
                                       double scale) noexcept {
  const double ball = hand.ball.linear.stableNorm();
  if (ball > limit) hand.ball.linear *= limit / ball;
  const double length = hand.direction_W.stableNorm();
  if (length > 1.0 + 1e-9) hand.direction_W /= length;
  const double most = limit / scale;
  const bool is_fast = ball > limit || std::abs(hand.lever_rate) > most;
  hand.lever_rate = std::clamp(hand.lever_rate, -most, most);
  return is_fast;
}

}  // namespace repel
