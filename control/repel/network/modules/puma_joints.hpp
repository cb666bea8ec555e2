// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// PUMA_JOINTS: the robot at the end of the network, for any arm.
#pragma once

#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// The flow of a motor joint for the network: the measured rate, corrected so that its trapezoidal
/// integral tracks the measured position. Springs integrating it do not drift away from the arm,
/// even at poor rates.
class MeasuredFlow {
 public:
  /// [s] in which a position error is corrected, at any tick rate.
  static constexpr double trim_time = 0.0225;

  /// At zero and at rest. @param joints their number, up to `most_joints`.
  explicit MeasuredFlow(int joints);

  /// Resets to rest at `q` [rad].
  void reset(const Vec<any_size>& q) noexcept;
  /// Advances by one `period` [s] of the network and `elapsed` [s] by the clock (0: one period);
  /// `q` [rad], `rate` [rad/s] measured, finite.
  void step(const Vec<any_size>& q, const Vec<any_size>& rate, double period,
            double elapsed = 0.0) noexcept;
  [[nodiscard]] const Vec<any_size>& flow() const noexcept { return flow_; }  ///< [rad/s]
  /// Mean rate over the last period [rad/s].
  [[nodiscard]] const Vec<any_size>& mean() const noexcept { return mean_; }

 private:
  Vec<any_size> position_, mean_, integral_, flow_;
};

/// A one-port that imposes its flow: the joint rates are measured, the network returns torques. It
/// is the only unmatched element of its network, at the root. The zero-order hold of the torque is
/// not part of the network: the energy it gives to the moving arm,
///
///     sum T tau(k) . (mean flow of the period after k - flow at k)
///
/// is observed and reported as `sampling_energy`. Here tau is the part of the torques sent.
class PumaJoints {
 public:
  /// The arm is an energy source: it may return more energy than it absorbed.
  static constexpr Traits traits{.left = Space::joints, .measures_flow = true, .passive = false};

  /// @throws SetupError when there is no joint or there are too many
  explicit PumaJoints(int joints);

  /// Number of joints.
  [[nodiscard]] int size() const noexcept { return static_cast<int>(flow_.size()); }

  /// Takes the measured rates, and accounts for the sampling energy of the period before.
  void read(const Signals& signals) noexcept;
  /// The measured rates, whatever the effort.
  void equivalent(Equivalent<any_size>& shown) const noexcept;
  /// Takes the torques.
  void incident(const PortState<any_size>& state) noexcept { effort_ = state.effort; }

  /// Torques on the joints [N m].
  [[nodiscard]] const Vec<any_size>& torques() const noexcept { return effort_; }
  [[nodiscard]] double sampling_energy() const noexcept { return sampling_energy_; }  ///< [J]

 private:
  // Torque held back moved nothing.
  void limit_to(const Vec<any_size>& sent) noexcept;

  Vec<any_size> flow_;    // [rad/s]
  Vec<any_size> effort_;  // [N m]
  double sampling_energy_ = 0.0;
};

}  // namespace repel::network
