/// @file
/// Keeps joints within the speed they are made for.
#pragma once

#include <algorithm>
#include <cmath>

namespace repel {

/// What is given of a torque `asked` [N m] of a joint that moves at `v` [rad/s] and may move at
/// `limit` (0 or infinite: none is known): all of it while it brakes; where it drives, less and
/// less over the last fifth below the limit, and nothing beyond. It only ever takes power away, so
/// what was passive stays so. A joint can still be carried past its limit by the motion of the
/// others.
[[nodiscard]] inline double within_speed(double asked, double v, double limit) noexcept {
  constexpr double fade = 0.2;
  if (!(limit > 0.0) || std::isinf(limit) || !(asked * v > 0.0)) return asked;
  return asked * std::clamp((limit - std::abs(v)) / (fade * limit), 0.0, 1.0);
}

}  // namespace repel
