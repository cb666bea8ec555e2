// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The net torques that may have acted on the joints since the last reading.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <repel/loop/arm_inertia.hpp>

namespace repel {

/// A ring of the net torques that were sent, as long as the delay of the drive. Torques [N m], or
/// forces [N] for a prismatic joint. Allocates at construction only.
class SentTorques {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param delay [ticks] from a torque to its effect, beyond its being held for one tick
  SentTorques(std::size_t joints, double delay)
      : delay_(delay), ring_(static_cast<std::size_t>(std::ceil(delay)) + 1) {
    for (Vector& sent : ring_) sent.setZero(static_cast<Eigen::Index>(joints));
  }

  /// To be called once a tick. @param share of `net` that acts, 0 with brakes on
  void add(const Vector& net, double share = 1.0) noexcept {
    newest_ = (newest_ + 1) % ring_.size();
    ring_[newest_] = share * net;
  }

  /// What acted between the last two readings, with the delay as told.
  [[nodiscard]] double acted(std::size_t joint) const noexcept {
    const auto whole = static_cast<std::size_t>(delay_);
    const double rest = delay_ - static_cast<double>(whole);
    const double later = ago(whole, joint);
    return rest > 0.0 ? later + rest * (ago(whole + 1, joint) - later) : later;
  }
  /// The least that acted whatever the delay, up to the one told; 0 where the sign changed.
  [[nodiscard]] double surely(std::size_t joint) const noexcept {
    double least = ago(0, joint);
    for (std::size_t k = 1; k < ring_.size(); ++k) {
      const double sent = ago(k, joint);
      if (!(least * sent > 0.0)) return 0.0;
      if (std::abs(sent) < std::abs(least)) least = sent;
    }
    return least;
  }
  /// The largest that may have acted, absolute.
  [[nodiscard]] double at_most(std::size_t joint) const noexcept {
    double most = 0.0;
    for (std::size_t k = 0; k < ring_.size(); ++k) most = std::max(most, std::abs(ago(k, joint)));
    return most;
  }

 private:
  [[nodiscard]] double ago(std::size_t ticks, std::size_t joint) const noexcept {
    const Vector& sent = ring_[(newest_ + ring_.size() - ticks) % ring_.size()];
    return sent.coeff(static_cast<Eigen::Index>(joint));
  }

  double delay_;  // [ticks]
  std::vector<Vector> ring_;
  std::size_t newest_ = 0;
};

}  // namespace repel
