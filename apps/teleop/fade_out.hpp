/// @file
/// How a run ends that is asked to stop.
#pragma once

#include <algorithm>
#include <atomic>
#include <span>

#include <repel/loop/record.hpp>

namespace repel::teleop {

/// Lets a run go on, without its operators, until the fail-safe has faded the forces of all arms.
class FadeOut {
 public:
  /// [s] of scene time after which it ends whatever the forces are; one tick at least.
  static constexpr double longest = 0.5;

  /// @param stop begins it
  /// @param at_once ends the run without it; null: never
  FadeOut(const std::atomic<bool>& stop, const std::atomic<bool>* at_once, double period) noexcept
      : stop_(stop), at_once_(at_once), period_(period) {}

  /// Asked before each tick: true when it is not to be made.
  /// @param last what the arms did in the tick before; empty before the first
  [[nodiscard]] bool is_over(std::span<const TickRecord* const> last) noexcept {
    if (!stop_) return false;
    const bool is_last = has_begun_ && left_ <= 0.0;
    left_ = has_begun_ ? left_ - period_ : longest - period_;
    has_begun_ = true;
    const auto is_faded = [](const TickRecord* record) { return record->gain == 0.0; };
    return is_last || (at_once_ != nullptr && *at_once_) ||
           std::all_of(last.begin(), last.end(), is_faded);
  }

  /// The operators are to let go.
  [[nodiscard]] bool has_begun() const noexcept { return has_begun_; }

 private:
  const std::atomic<bool>& stop_;
  const std::atomic<bool>* at_once_;
  double period_;      ///< [s]
  double left_ = 0.0;  ///< [s] of scene time
  bool has_begun_ = false;
};

}  // namespace repel::teleop
