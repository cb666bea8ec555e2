// SPDX-License-Identifier: BSD-3-Clause
#include <repel/network/elements/signals.hpp>

namespace repel::network {

bool HandInput::is_finite() const noexcept {
  return repel::is_finite(ball) && repel::is_finite(direction_W) && repel::is_finite(turning_W) &&
         lever_rate - lever_rate == 0.0;
}

const HandInput& Signals::of(Hand which) const noexcept {
  return which == Hand::first ? hand : second;
}

Vec<any_size> Signals::tool_flow() const noexcept {
  return dense::product<Vec<any_size>>(jacobian, rates);
}

Vec<any_size> Signals::mean_tool_flow() const noexcept {
  return dense::product<Vec<any_size>>(jacobian, mean_rates);
}

}  // namespace repel::network
