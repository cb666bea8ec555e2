// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Figure 8 of Anderson 1993 in a closed loop: a free plate is pressed onto a fixed one, and
/// nothing but virtual forces, computed once a period, keeps the two apart and parallel.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <repel/base/spatial.hpp>
#include <repel/force/law.hpp>
#include <repel/reduction/separation.hpp>

namespace repel::figures {

/// Where the force of the pair acts on the free plate.
enum class Witness {
  plain,     ///< at the witness point of the query: a corner, in the next tick another one
  filtered,  ///< at that point after a first-order filter of 5 ms in the frame of the plate
  averaged,  ///< in equal parts at the witness points of four poses tilted by a degree
};

struct PlatesOptions {
  Witness witness = Witness::plain;
  Measure measure = Measure::reduction;
  double rate = 1000.0;  ///< [Hz] of the loop
  double press = 20.0;   ///< [N] downward, at the centre of the plate, all the time
  bool held = false;     ///< damped as by the coupling of the default scene; else a bare body
};

/// One tick: the free plate, and the virtual force on it.
struct PlatesTick {
  double time = 0.0;    ///< [s]
  double height = 0.0;  ///< [m] of its centre, less the thickness of a plate
  double tilt = 0.0;    ///< [rad] between the plates
  double speed = 0.0;   ///< [m/s] no corner is faster
  Wrench F_W;           ///< about its centre
};

class Plates {
 public:
  static constexpr double half_side = 0.1;        ///< [m] of the free plate
  static constexpr double half_thickness = 0.01;  ///< [m] of both
  static constexpr double mass = 2.0;             ///< [kg]
  static constexpr double filter_time = 0.005;    ///< [s]

  /// At rest where the force begins, tilted by about a degree.
  explicit Plates(const PlatesOptions& options) : options_(options) {
    X_WA_.translation().z() = 2.0 * half_thickness + law_.range;
    X_WA_.linear() = Eigen::AngleAxisd(0.02, Vec3(1.0, 0.6, 0.0).normalized()).matrix();
  }

  std::vector<PlatesTick> run() {
    constexpr double duration = 10.0;  // [s]
    constexpr int substeps = 20;
    std::vector<PlatesTick> ticks;
    for (int k = 0; k < duration * options_.rate; ++k) {
      const double time = k / options_.rate;
      const Wrench F_W = virtual_force();
      const double dt = 1.0 / (substeps * options_.rate);
      ticks.push_back(record(time, F_W));
      for (int i = 0; i < substeps; ++i) move(F_W + hand_force(time), dt);
    }
    return ticks;
  }

 private:
  [[nodiscard]] Separation separate(const Pose& X_WA, WarmStart& warm) const {
    return separation(free_, X_WA, fixed_, Pose::Identity(), {.measure = options_.measure}, warm);
  }

  /// The force of the law at Q, a point of the free plate.
  [[nodiscard]] Wrench force_at(const Vec3& p_WQ, const Separation& s) const {
    const Vec3 p_AQ_W = p_WQ - X_WA_.translation();
    const double rate = s.extraction_W.dot(V_W_.linear + V_W_.angular.cross(p_AQ_W));
    return wrench_of_force(law_(s.distance, rate) * s.extraction_W, p_AQ_W);
  }

  [[nodiscard]] Wrench virtual_force() {
    if (options_.witness == Witness::averaged) return averaged();
    const Separation s = separate(X_WA_, warm_.front());
    if (options_.witness == Witness::plain) return force_at(s.p_WA, s);
    p_AQ_ += (X_WA_.inverse() * s.p_WA - p_AQ_) / (1.0 + filter_time * options_.rate);
    return force_at(X_WA_ * p_AQ_, s);
  }

  /// Asked at four tilts, a parallel plate names its four corners, and one that is tilted further
  /// the nearest of them four times. Each has the distance that it has at the true pose: there is a
  /// spring and a damper at every corner, and at parallel the force of all is that of one query.
  [[nodiscard]] Wrench averaged() {
    constexpr double tilt = 0.0175;  // [rad]
    Wrench sum;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 axis(k % 2 == 0 ? 1.0 : -1.0, k / 2 == 0 ? 1.0 : -1.0, 0.0);
      const Pose X_WT = X_WA_ * Eigen::AngleAxisd(tilt, axis.normalized());
      Separation s = separate(X_WT, warm_[k]);
      const Vec3 p_WQ = X_WA_ * (X_WT.inverse() * s.p_WA);
      s.distance += s.extraction_W.dot(p_WQ - s.p_WA);
      sum += 0.25 * force_at(p_WQ, s);
    }
    return sum;
  }

  /// The press, from 2 s to 2.5 s a quarter of it more at a corner, and the damping of the hold.
  [[nodiscard]] Wrench hand_force(double time) const {
    Wrench F_W{{0.0, 0.0, -options_.press}, Vec3::Zero()};
    if (time >= 2.0 && time < 2.5) {
      const Vec3 p_AC_W = X_WA_.linear() * Vec3(half_side, half_side, 0.0);
      F_W += wrench_of_force({0.0, 0.0, -0.25 * options_.press}, p_AC_W);
    }
    if (options_.held) F_W += {-300.0 * V_W_.linear, -4.0 * V_W_.angular};
    return F_W;
  }

  /// Semi-implicit: the velocity first.
  void move(const Wrench& F_W, double dt) {
    const double about_z = mass / 3.0 * 2.0 * half_side * half_side;
    const double across = 0.5 * about_z + mass / 3.0 * half_thickness * half_thickness;
    const Vec3 inertia(across, across, about_z);  // [kg m^2] in the axes of the plate
    const Mat3 R_WA = X_WA_.linear();
    const Vec3 w_A = R_WA.transpose() * V_W_.angular;
    const Vec3 torque_A = R_WA.transpose() * F_W.torque - w_A.cross(inertia.cwiseProduct(w_A));
    V_W_.linear += dt / mass * F_W.force;
    V_W_.angular += dt * (R_WA * torque_A.cwiseQuotient(inertia));
    X_WA_.translation() += dt * V_W_.linear;
    const double turn = dt * V_W_.angular.norm();
    if (turn > 0.0) X_WA_.linear() = Eigen::AngleAxisd(turn, V_W_.angular.normalized()) * R_WA;
  }

  [[nodiscard]] PlatesTick record(double time, const Wrench& F_W) const {
    const Vec3 normal_W = X_WA_.linear().col(2);
    return {.time = time,
            .height = X_WA_.translation().z() - 2.0 * half_thickness,
            .tilt = std::atan2(std::hypot(normal_W.x(), normal_W.y()), normal_W.z()),
            .speed = V_W_.linear.norm() + 1.5 * half_side * V_W_.angular.norm(),
            .F_W = F_W};
  }

  PlatesOptions options_;
  ForceLaw law_;
  Shape free_ = Shape::box({half_side, half_side, half_thickness});
  Shape fixed_ = Shape::box({2.0 * half_side, 2.0 * half_side, half_thickness});
  Pose X_WA_ = Pose::Identity();  ///< of the free plate; the fixed one stands in W
  Twist V_W_;                     ///< of its centre
  Vec3 p_AQ_ = Vec3::Zero();      ///< [m] filtered witness point
  std::array<WarmStart, 4> warm_{};
};

}  // namespace repel::figures
