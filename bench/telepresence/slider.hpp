// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A slider simulated exactly: the device of all parts.
#pragma once

#include <Eigen/Core>

namespace repel::telepresence {

/// A mass on a viscous guide, optionally held by a hand through a spring and a damper.
struct SliderOptions {
  double mass = 2.0;            ///< m [kg]
  double friction = 30.0;       ///< b [N s/m]
  double hand_stiffness = 0.0;  ///< [N/m]
  double hand_damping = 0.0;    ///< [N s/m]
};

/// Between two ticks the force is constant, the hand moves at constant speed, and the dynamics are
/// linear:
///
///     m dv/dt = F - b v + k_h (x_h - x) + c_h (v_h - v)
///
/// The matrix exponential of this system, computed at set-up, gives the exact motion over a period.
class Slider {
 public:
  /// @param period [s]
  Slider(const SliderOptions& options, double period)
      : transition_(exponential(period * motion(options))) {}

  /// One period under `force` [N] with the hand moving at `hand_speed` [m/s].
  void move(double force, double hand_speed = 0.0) {
    state_(3) = force;
    state_(4) = hand_speed;
    state_ = (transition_ * state_).eval();
  }
  [[nodiscard]] double position() const { return state_(0); }  ///< [m]
  [[nodiscard]] double speed() const { return state_(1); }     ///< [m/s]

 private:
  using Matrix = Eigen::Matrix<double, 5, 5>;

  static Matrix motion(const SliderOptions& o) {
    Matrix A = Matrix::Zero();
    A(0, 1) = 1.0;
    A.row(1) << -o.hand_stiffness, -(o.friction + o.hand_damping), o.hand_stiffness, 1.0,
        o.hand_damping;
    A.row(1) /= o.mass;
    A(2, 4) = 1.0;
    return A;
  }
  // Scaling and squaring with a Taylor series.
  static Matrix exponential(const Matrix& A) {
    const Matrix part = A / 1024.0;
    Matrix sum = Matrix::Identity();
    for (int n = 8; n > 0; --n) sum = (Matrix::Identity() + part * sum / n).eval();
    for (int i = 0; i < 10; ++i) sum = (sum * sum).eval();
    return sum;
  }

  Matrix transition_;
  Eigen::Matrix<double, 5, 1> state_ = Eigen::Matrix<double, 5, 1>::Zero();  // x v x_h F v_h
};

}  // namespace repel::telepresence
