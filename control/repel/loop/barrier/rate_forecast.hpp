// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How an arm will move when the torques of this tick begin to act, if they change nothing.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <repel/loop/arms/arm_inertia.hpp>
#include <repel/network/elements/dense.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// The joint rates of an arm with a late drive, predicted by the pending torques, viscous friction
/// and a disturbance. The disturbance is the low-passed difference of the change of momentum and
/// the torques and viscous friction acting so far.
///
/// A prediction is compared with the later reading. The low-pass is slow on an arm of another mass,
/// or with dry friction, so the largest recent error counts as doubt of the rates. Without it, a
/// late arm predicted to stop crept into walls by millimetres.
///
/// Allocates at construction only. Cost: one product and two solutions with the mass matrix.
class RateForecast {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param period [s] @param delay [ticks] of the drive @param step [s] the disturbance goes on
  /// after that
  RateForecast(const ArmModel& model, double period, double delay, double step);

  /// To be called in every tick: updates the disturbance by the reading. @param v [rad/s]
  void observe(std::span<const double> v, const ArmInertia& inertia) noexcept;
  /// To be called in every tick, with the torques sent less those of the weight [N m].
  void note_sent(const Vector& net) noexcept;
  /// Predicts. @param mass M and the viscous friction over delay and step, by an implicit rule
  void predict(std::span<const double> v, const ArmInertia& inertia,
               const network::dense::Factored& mass) noexcept;
  /// The next prediction is not compared with one before.
  void forget() noexcept { predictions_ = 0; }

  /// [m/s] The change of the rate h v, at least.
  [[nodiscard]] double least_gain(const Vector& h) const noexcept;
  /// [rad/s] Possible error of the predicted rate of a joint.
  [[nodiscard]] double doubt(std::size_t joint) const noexcept {
    return doubt_.coeff(index(joint));
  }

 private:
  static constexpr double memory = 0.02;      // [s] of the disturbance
  static constexpr double doubted_for = 0.1;  // [s]

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  // Compares v with the prediction for now, and stores the new prediction.
  void compare(std::span<const double> v, const Vector& predicted) noexcept;

  const ArmModel& model_;
  double period_;                  // [s]
  double delay_;                   // [ticks]
  double step_;                    // [s]
  std::vector<Vector> sent_;       // [N m] ring of the pending torques
  std::vector<Vector> predicted_;  // [rad/s] ring of the pending predictions
  std::size_t oldest_sent_ = 0, oldest_predicted_ = 0;
  std::size_t predictions_ = 0;  // in succession
  Vector disturbance_;           // [N m]
  Vector rates_, change_;        // [rad/s] at the last tick, and since the one before
  Vector gain_, doubt_;          // [rad/s]
};

}  // namespace repel
