// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// PUMA_KIN: from tool space to joint space, for any arm.
#pragma once

#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// The lossless transformer v = J qdot, tau = J' f, with the same Jacobian both ways in one tick.
/// Poses come from forward kinematics and are never integrated from v.
///
/// At a singularity J loses a direction, for effort and flow alike: the tool cannot be moved along
/// it and no torque answers a force along it. Nothing is inverted, so no value grows without bound.
class PumaKin {
 public:
  /// A tool on the left, joints on the right.
  static constexpr Traits traits{.left = Space::tool, .right = Space::joints, .keeps_flow = true};

  /// On which side the robot is.
  void face(Side root) noexcept { root_ = root; }
  /// Takes the Jacobian of this tick.
  void read(const Signals& signals) noexcept { jacobian_ = signals.jacobian; }

  /// What is behind, through the Jacobian. False where it cannot be formed.
  [[nodiscard]] bool reflected(const Equivalent<any_size>& behind,
                               Equivalent<any_size>& shown) const noexcept;
  /// State behind, through the Jacobian.
  void incident(const PortState<any_size>& at_root, const Equivalent<any_size>& behind,
                PortState<any_size>& at_leaf) const noexcept;

 private:
  Side root_ = Side::right;
  decltype(Signals::jacobian) jacobian_;
};

}  // namespace repel::network
