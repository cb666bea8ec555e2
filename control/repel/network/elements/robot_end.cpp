// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/robot_end.hpp>

#include <algorithm>
#include <cmath>

namespace repel::network {

RobotEnd RobotEnd::lightened(double g) const {
  RobotEnd lighter = *this;
  lighter.mass /= 1.0 + g;
  lighter.inertia /= 1.0 + g;
  lighter.joints *= 1.0 / (1.0 + g);
  return lighter;
}

Gains suited(const Gains& asked, double mass, double response, const Gains& usual,
             double most_damping) noexcept {
  Gains gains = asked;
  if (asked.stiffness == automatic) {
    const double B = response > 0.0 ? std::min(mass / response, most_damping) : 0.0;
    gains.stiffness = std::max(usual.stiffness, mass > 0.0 ? 0.25 * B * B / mass : 0.0);
  }
  if (asked.damping == automatic) {
    const double critical = 2.0 * std::sqrt(gains.stiffness * mass);
    gains.damping = std::max(usual.damping, std::min(critical, most_damping));
  }
  return gains;
}

}  // namespace repel::network
