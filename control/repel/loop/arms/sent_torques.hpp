// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The net torques that may have acted on the joints since the last reading.
#pragma once

#include <cstddef>
#include <vector>

#include <repel/loop/arms/arm_inertia.hpp>

namespace repel {

/// A ring of the net torques sent, as long as the delay of the drive. Torques [N m], or forces [N]
/// for a prismatic joint. Allocates at construction only.
class SentTorques {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param delay [ticks] from a torque to its effect, beyond its being held for one tick
  SentTorques(std::size_t joints, double delay);

  /// To be called once a tick. @param share of `net` that acts, 0 with brakes on
  void add(const Vector& net, double share = 1.0) noexcept;

  /// The torque acting between the last two readings, at the delay told.
  [[nodiscard]] double acted(std::size_t joint) const noexcept;
  /// Lower bound over all delays up to the one told; 0 where the sign changed.
  [[nodiscard]] double surely(std::size_t joint) const noexcept;
  /// Upper bound of its magnitude.
  [[nodiscard]] double at_most(std::size_t joint) const noexcept;

 private:
  [[nodiscard]] double ago(std::size_t ticks, std::size_t joint) const noexcept;

  double delay_;  // [ticks]
  std::vector<Vector> ring_;
  std::size_t newest_ = 0;
};

}  // namespace repel
