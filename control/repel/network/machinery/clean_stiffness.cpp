// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/machinery/clean_stiffness.hpp>

namespace repel::network {

double CleanStiffness::limit() const noexcept {
  const double left = device_damping - (wall_damping < 0.0 ? -wall_damping : wall_damping);
  return left > 0.0 ? left / (0.5 * period + delay) : 0.0;
}

double CleanStiffness::needed_damping(double stiffness) const noexcept {
  return stiffness * (0.5 * period + delay) + (wall_damping < 0.0 ? -wall_damping : wall_damping);
}

}  // namespace repel::network
