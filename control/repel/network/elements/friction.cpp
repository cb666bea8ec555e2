// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/friction.hpp>

#include <algorithm>

namespace repel::network {

double FrictionCompensation::operator()(double dry_friction, double asked, double period) noexcept {
  if (!(dry_friction > 0.0) || asked - asked != 0.0) return part = 0.0;
  const double target = std::clamp(asked / dry_friction, -1.0, 1.0) / (1.0 - share);
  part = std::clamp(part + period / (time + period) * (target - part), -1.0, 1.0);
  return share * dry_friction * part;
}

}  // namespace repel::network
