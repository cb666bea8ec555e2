// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The command of the driver at the controls, for each tick.
#pragma once

#include <repel/base/spatial.hpp>
#include <repel/network/operator.hpp>
#include <repel/visual/controls.hpp>

namespace repel::visual {

/// Reads the posts of a driver. Of the thread of the tick: no function here allocates, waits, makes
/// a system call or throws.
class PageCommand {
 public:
  /// [s] Timeouts of the driver: without a post for `rest_after` its rates count as zero; after
  /// `silent_after` a page is reported silent, and the fail-safe fades the forces. A driver posts
  /// at least ten times a second.
  static constexpr double rest_after = 0.1;
  static constexpr double silent_after = 0.25;  ///< [s], as `rest_after`

  /// @param controls must outlive this object
  explicit PageCommand(Controls& controls) noexcept : controls_(&controls) {}

  /// Takes the newest post; once a tick. @param period [s] since the last tick
  void hear(double period) noexcept {
    unheard_ = controls_->input.take() ? 0.0 : unheard_ + period;
  }

  /// Who drives, by the newest post.
  [[nodiscard]] Driver driver() const noexcept { return controls_->input.newest().driver; }

  /// Writes the newest post over the last command of its driver. Absent switches and a direction of
  /// NaN leave theirs as they were.
  /// @param R_WT axes of the tool, to which rates may refer
  void write(const Mat3& R_WT, network::Command& command) const noexcept {
    const DriverInput& input = controls_->input.newest();
    // Rates in tool axes are rotated to the world in every tick.
    command.hand.ball = input.in_tool ? rotated(R_WT, input.rates) : input.rates;
    command.second.ball = input.second_in_tool ? rotated(R_WT, input.second) : input.second;
    command.hand.lever_rate = input.lever_rate;
    command.second.lever_rate = 0.0;
    switch_over(input, command);
    command.sound = is_finite(input.rates) && is_finite(input.second) &&
                    is_finite(input.direction_W) && input.lever_rate - input.lever_rate == 0.0;
    if (command.sound) {
      command.hand.direction_W = input.direction_W;
      command.hand.turning_W = Vec3::Zero();
    }
    if (!command.sound || unheard_ > rest_after) {
      command.hand.ball = command.second.ball = {};
      command.hand.lever_rate = 0.0;
    }
    command.silent_for = input.driver == Driver::page && unheard_ > silent_after ? unheard_ : 0.0;
  }

 private:
  static void switch_over(const DriverInput& input, network::Command& command) noexcept {
    if (input.scale > 0.0) command.hand.scale = command.second.scale = input.scale;
    if (input.guides != network::as_before) command.hand.guides = input.guides;
    if (input.guide_strength >= 0.0) command.hand.guide_strength = input.guide_strength;
    if (input.compliant != network::as_before) command.hand.compliant = input.compliant;
  }

  Controls* controls_;
  double unheard_ = 0.0;  ///< [s] since the last post
};

}  // namespace repel::visual
