// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/watch/stop_control.hpp>

namespace repel {

Stop StopControl::step(bool lost, bool never_known, bool tripped, double elapsed) noexcept {
  lost_for_ = lost ? lost_for_ + elapsed : 0.0;
  // Latched until the operator's force is restored.
  brakes_ = tripped && (brakes_ || never_known || lost_for_ > predicted_);
  if (!tripped) return Stop::running;
  if (never_known || lost_for_ > options_.released) return Stop::released;
  return lost || brakes_ ? Stop::braking : Stop::holding;
}

}  // namespace repel
