// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Ends a run safely after a request to stop.
#pragma once

#include <algorithm>
#include <atomic>
#include <span>

#include <repel/loop/record.hpp>

namespace repel::runs {

/// Continues a run with its operators at rest until the fail-safe has faded the forces of all arms.
class FadeOut {
 public:
  /// [s] of scene time until the run ends at any forces; at least one tick.
  static constexpr double longest = 0.5;

  /// @param stop request that starts the fade-out
  /// @param at_once request to end the run without it; null: never
  FadeOut(const std::atomic<bool>& stop, const std::atomic<bool>* at_once, double period) noexcept
      : stop_(stop), at_once_(at_once), period_(period) {}

  /// To be called before each tick; true if that tick must not run.
  /// @param last records of the arms in the tick before; empty before the first
  [[nodiscard]] bool is_over(std::span<const TickRecord* const> last) noexcept {
    if (!stop_) return false;
    const bool is_last = has_begun_ && left_ <= 0.0;
    left_ = has_begun_ ? left_ - period_ : longest - period_;
    has_begun_ = true;
    const auto is_faded = [](const TickRecord* record) { return record->gain == 0.0; };
    return is_last || (at_once_ != nullptr && *at_once_) ||
           std::all_of(last.begin(), last.end(), is_faded);
  }

  /// The operators must be at rest from now on.
  [[nodiscard]] bool has_begun() const noexcept { return has_begun_; }

 private:
  const std::atomic<bool>& stop_;
  const std::atomic<bool>* at_once_;
  double period_;      ///< [s]
  double left_ = 0.0;  ///< [s] of scene time
  bool has_begun_ = false;
};

}  // namespace repel::runs
