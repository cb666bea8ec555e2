// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A simulated operator: a hand that trembles and strays, and eyes that see late.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <random>

#include <repel/base/spatial.hpp>
#include <repel/base/types.hpp>

namespace repel::guides {

/// How unsteady the operator is.
struct HandOptions {
  double reaction = 0.2;    ///< [s] from what is seen to what the hand does about it
  double wander = 1e-3;     ///< [m] root mean square along each axis, below about 0.5 Hz
  double tremor = 0.3e-3;   ///< [m] root mean square along each axis, 8 to 12 Hz
  double turning = 0.01;    ///< [rad] wander about each axis
  double correction = 1.5;  ///< [1/s] of the error that is seen
  double speed = 0.04;      ///< [m/s] without an error
  double care = 3e-3;       ///< [m] error at which the hand goes half as fast
};

/// What the operator sees and wants, as of one tick.
struct Sight {
  Vec3 error_W{0, 0, 0};  ///< [m] from the tool to where it should be, across its way
  Vec3 tilt_W{0, 0, 0};   ///< [rad] by which it should turn
  Vec3 ahead_W{0, 0, 0};  ///< unit: along its way
};

/// Three axes of noise: a wander that drifts, and a tremor of three tones.
class Unrest {
 public:
  Unrest(const HandOptions& options, std::uint64_t seed);
  /// Advances by `period` [s].
  void step(double period);
  [[nodiscard]] const Vec3& wander() const noexcept { return wander_; }    ///< [m]
  [[nodiscard]] const Vec3& tremor() const noexcept { return tremor_; }    ///< [m]
  [[nodiscard]] const Vec3& turning() const noexcept { return turning_; }  ///< [rad]

 private:
  /// Noise of unit size and of some seconds: white noise through two low passes.
  struct Drift {
    double first = 0.0, second = 0.0;
  };
  [[nodiscard]] double drifted(Drift& drift, double period);

  HandOptions options_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  std::array<Drift, 6> drifts_{};
  std::array<double, 9> phases_{}, rates_{};  // [rad], [rad/s] of the tones
  Vec3 wander_{0, 0, 0}, tremor_{0, 0, 0}, turning_{0, 0, 0};
};

/// Rates of the hand: what it wants from what it saw, and its unrest.
class Hand {
 public:
  Hand(const HandOptions& options, std::uint64_t seed);
  /// @param sight of this tick; it is acted on `reaction` later
  [[nodiscard]] Twist step(const Sight& sight, double period);

 private:
  HandOptions options_;
  Unrest unrest_;
  std::deque<Sight> seen_;
};

}  // namespace repel::guides
