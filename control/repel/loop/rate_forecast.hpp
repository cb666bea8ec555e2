// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How an arm will move when the torques of this tick begin to act, if they change nothing.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <repel/loop/arm_inertia.hpp>
#include <repel/network/elements/dense.hpp>
#include <repel/world/arm.hpp>

namespace repel {

/// The joint rates of an arm with a late drive, predicted by the torques that were sent and
/// have not acted yet, by viscous friction, and by what else acted of late. What else acts is the
/// low-passed difference of the change of momentum and the torques and viscous friction that acted.
///
/// A prediction is compared with what comes true. An arm of another mass, or with dry friction, is
/// late to be known by a low-pass: by the largest recent error, the rates are in doubt. A late arm
/// that was predicted to stop while it went on crept into walls by millimetres.
///
/// Allocates at construction only. Cost: one product and two solutions with the mass matrix.
class RateForecast {
 public:
  using Vector = ArmInertia::Vector;  ///< one entry for each joint

  /// @param period [s] @param delay [ticks] of the drive @param step [s] for which what else acts
  /// goes on after that
  RateForecast(const ArmModel& model, double period, double delay, double step);

  /// To be called in every tick: looks at what became of the torques that acted. @param v [rad/s]
  void observe(std::span<const double> v, const ArmInertia& inertia) noexcept;
  /// To be called in every tick, with the torques that were sent less those of the weight [N m].
  void note_sent(const Vector& net) noexcept;
  /// Predicts. @param mass M and the viscous friction over delay and step, by an implicit rule
  void predict(std::span<const double> v, const ArmInertia& inertia,
               const network::dense::Factored& mass) noexcept;
  /// The next prediction is not compared with one before.
  void forget() noexcept { predictions_ = 0; }

  /// [m/s] The change of the rate h v, at least.
  [[nodiscard]] double least_gain(const Vector& h) const noexcept;
  /// [rad/s] By which the rate of a joint may be other than predicted.
  [[nodiscard]] double doubt(std::size_t joint) const noexcept {
    return doubt_.coeff(index(joint));
  }

 private:
  static constexpr double memory = 0.02;      // [s] of what else acts
  static constexpr double doubted_for = 0.1;  // [s]

  static Eigen::Index index(std::size_t i) noexcept { return static_cast<Eigen::Index>(i); }

  // Compares v with what was predicted for now, and keeps what is predicted for the time to come.
  void compare(std::span<const double> v, const Vector& predicted) noexcept;

  const ArmModel& model_;
  double period_;                  // [s]
  double delay_;                   // [ticks]
  double step_;                    // [s]
  std::vector<Vector> sent_;       // [N m] ring of what has not acted yet
  std::vector<Vector> predicted_;  // [rad/s] ring of the predictions that have not come true yet
  std::size_t oldest_sent_ = 0, oldest_predicted_ = 0;
  std::size_t predictions_ = 0;  // in succession
  Vector disturbance_;           // [N m] what else acts
  Vector rates_, change_;        // [rad/s] at the last tick, and since the one before
  Vector gain_, doubt_;          // [rad/s]
};

}  // namespace repel
