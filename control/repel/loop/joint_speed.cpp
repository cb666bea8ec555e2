// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/joint_speed.hpp>

#include <algorithm>
#include <cmath>

namespace repel {

double within_speed(double asked, double v, double limit) noexcept {
  constexpr double fade = 0.2;
  if (!(limit > 0.0) || std::isinf(limit) || !(asked * v > 0.0)) return asked;
  return asked * std::clamp((limit - std::abs(v)) / (fade * limit), 0.0, 1.0);
}

}  // namespace repel
