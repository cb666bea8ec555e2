// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// PUMA_JOINTS: the robot at the end of the network, for any arm.
#pragma once

#include <repel/network/elements/equivalent.hpp>
#include <repel/network/elements/signals.hpp>

namespace repel::network {

/// The flow of a motor joint for the network: the measured rate, corrected so that its trapezoidal
/// integral tracks the measured position. Springs that integrate it do not drift away from the arm,
/// whatever the quality of the rate.
class MeasuredFlow {
 public:
  /// [s] in which a position error is corrected, at any tick rate.
  static constexpr double trim_time = 0.0225;

  /// At zero and at rest. @param joints their number, up to `most_joints`.
  explicit MeasuredFlow(int joints)
      : position_(Vec<any_size>::Zero(joints)),
        mean_(position_),
        integral_(position_),
        flow_(position_) {}

  /// Resets to rest at `q` [rad].
  void reset(const Vec<any_size>& q) noexcept {
    position_ = integral_ = q;
    flow_.setZero();
    mean_.setZero();
  }
  /// Advances by one `period` [s] of the network and `elapsed` [s] by the clock (0: one period);
  /// `q` [rad], `rate` [rad/s] measured, finite.
  void step(const Vec<any_size>& q, const Vec<any_size>& rate, double period,
            double elapsed = 0.0) noexcept {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      double& flow = flow_.coeffRef(i);
      double& integral = integral_.coeffRef(i);
      mean_.coeffRef(i) = (q.coeff(i) - position_.coeff(i)) / (elapsed > 0.0 ? elapsed : period);
      const double error = q.coeff(i) - integral - 0.5 * period * (flow + rate.coeff(i));
      integral += 0.5 * period * flow;
      flow = rate.coeff(i) + error * 2.0 / (trim_time + period);
      integral += 0.5 * period * flow;
    }
    position_ = q;
  }
  [[nodiscard]] const Vec<any_size>& flow() const noexcept { return flow_; }  ///< [rad/s]
  /// Mean rate over the last period [rad/s].
  [[nodiscard]] const Vec<any_size>& mean() const noexcept { return mean_; }

 private:
  Vec<any_size> position_, mean_, integral_, flow_;
};

/// A one-port that imposes its flow: the joint rates are measured, the network returns torques. It
/// is the only unmatched element of its network, at the root. The zero-order hold of the torque
/// while the arm moves on is not part of the network: the energy that it gives the arm,
///
///     sum T tau(k) . (mean flow of the period after k - flow at k)
///
/// is observed and reported as `sampling_energy`.
class PumaJoints {
 public:
  /// The arm is an energy source: it may return more energy than it absorbed.
  static constexpr Traits traits{.left = Space::joints, .measures_flow = true, .passive = false};

  /// @throws SetupError when there is no joint or there are too many
  explicit PumaJoints(int joints)
      : flow_(Vec<any_size>::Zero(
            static_cast<int>(checked("number of joints", joints, 1, most_joints, "")))),
        effort_(flow_) {}

  /// Number of joints.
  [[nodiscard]] int size() const noexcept { return static_cast<int>(flow_.size()); }

  /// Takes the measured rates, and notes what sampling has added in the period before.
  void read(const Signals& signals) noexcept {
    const double gained = signals.period * effort_.dot(signals.mean_rates - flow_) +
                          (signals.since_last() - signals.period) * effort_.dot(signals.mean_rates);
    if (gained - gained == 0.0) sampling_energy_ += gained;  // finite: a fault does not spoil it
    flow_ = signals.rates;
  }
  /// The measured rates, whatever the effort.
  void equivalent(Equivalent<any_size>& shown) const noexcept {
    shown.form = Form::admittance;
    shown.matrix.setZero(flow_.size(), flow_.size());
    shown.offset = flow_;
  }
  /// Takes the torques.
  void incident(const PortState<any_size>& state) noexcept { effort_ = state.effort; }

  /// Torques on the joints [N m].
  [[nodiscard]] const Vec<any_size>& torques() const noexcept { return effort_; }
  [[nodiscard]] double sampling_energy() const noexcept { return sampling_energy_; }  ///< [J]

 private:
  Vec<any_size> flow_;    // [rad/s]
  Vec<any_size> effort_;  // [N m]
  double sampling_energy_ = 0.0;
};

}  // namespace repel::network
