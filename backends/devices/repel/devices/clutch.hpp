// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The clutch: decides when the motion of a device counts.
#pragma once

namespace repel::devices {

/// Function of the clutch button.
enum class ClutchPolicy {
  always,  ///< engaged without a button
  hold,    ///< engaged while the button is down
  toggle,  ///< engaged by one press, released by the next
};

/// The clutch between hand and tool. It starts released, unless the policy is `always`.
class Clutch {
 public:
  /// Released, unless the policy is `always`.
  explicit Clutch(ClutchPolicy policy = ClutchPolicy::always) noexcept : policy_(policy) {}

  /// Reports that the button is down or up. Repeating the same state has no effect.
  void set(bool down) noexcept {
    if (down && !down_) toggled_ = !toggled_;
    down_ = down;
  }
  /// Back to the initial state, after a fault during which button events may have been missed.
  void reset() noexcept { down_ = toggled_ = false; }

  /// The hand moves the tool.
  [[nodiscard]] bool engaged() const noexcept {
    if (policy_ == ClutchPolicy::hold) return down_;
    return policy_ == ClutchPolicy::always || toggled_;
  }

 private:
  ClutchPolicy policy_;
  bool down_ = false;
  bool toggled_ = false;
};

}  // namespace repel::devices
