/// @file
/// Which stop a tick is in, and whether the brakes of the arm are asked for.
#pragma once

#include <algorithm>

#include <repel/base/status.hpp>

namespace repel {

struct StopOptions {
  double predicted = 0.02;  ///< [s], and no less than three ticks, for which a motion that cannot
                            ///< be seen is braked by prediction before the brakes are asked for
  double released = 0.5;    ///< [s] after which an arm that cannot be seen is released
};

/// From what is not trusted to what is done about it.
class StopControl {
 public:
  StopControl(double period, const StopOptions& options) noexcept
      : options_(options), predicted_(std::max(options.predicted, 3.0 * period)) {}

  /// The stop of this tick.
  /// @param lost where the arm is cannot be told in this tick; `never_known`: and never could
  /// @param tripped the fail-safe has not let the operator's force back; `elapsed` [s]
  [[nodiscard]] Stop step(bool lost, bool never_known, bool tripped, double elapsed) noexcept {
    lost_for_ = lost ? lost_for_ + elapsed : 0.0;
    // Once engaged the brakes stay until the operator comes back.
    brakes_ = tripped && (brakes_ || never_known || lost_for_ > predicted_);
    if (!tripped) return Stop::running;
    if (never_known || lost_for_ > options_.released) return Stop::released;
    return lost || brakes_ ? Stop::braking : Stop::holding;
  }

  /// "Engage brakes."
  [[nodiscard]] bool brakes() const noexcept { return brakes_; }

 private:
  StopOptions options_;
  double predicted_;
  double lost_for_ = 0.0;  // [s]
  bool brakes_ = false;
};

}  // namespace repel
