/// @file
/// The virtual coupling between what the operator asks for and what the tool does (KBB2).
#pragma once

#include <algorithm>
#include <cmath>

#include <repel/base/spatial.hpp>

namespace repel::network {

/// Gains of the coupling; translation and rotation apart.
struct CouplingGains {
  double stiffness = 2000.0;        ///< K [N/m]
  double damping = 120.0;           ///< B [N s/m]
  double force_limit = 60.0;        ///< [N] the spring stretches no further than this
  double angular_stiffness = 60.0;  ///< [N m/rad]
  double angular_damping = 4.0;     ///< [N m s/rad]
  double torque_limit = 8.0;        ///< [N m]
};

/// A spring K parallel to a damper B between the commanded and the actual tool frame. The command
/// is a flow: it moves the far end of the spring. Where the spring reaches its limit the far end is
/// dragged along, so that a held-up tool winds nothing up and lets go at once when the operator
/// turns back.
class Coupling {
 public:
  explicit Coupling(const CouplingGains& gains) noexcept : gains_(gains) {}

  /// Puts the commanded frame on the actual one: no stretch, no force.
  void reset(const Pose& X_WT) noexcept { X_WD_ = X_WT; }

  /// Advances the commanded frame by one period and returns the wrench on the tool about its
  /// origin, in world axes.
  /// @param V_WD_W commanded twist [m/s, rad/s]; X_WT, V_WT_W the actual tool; period [s]
  [[nodiscard]] Wrench step(const Twist& V_WD_W, const Pose& X_WT, const Twist& V_WT_W,
                            double period) noexcept {
    X_WD_.translation() += period * V_WD_W.linear;
    X_WD_.linear() = rotated_by(period * V_WD_W.angular) * X_WD_.linear();
    Vec3 stretch = X_WD_.translation() - X_WT.translation();
    Vec3 twist = rotation_vector(X_WD_.linear() * X_WT.linear().transpose());
    stretch = limited(stretch, gains_.force_limit / gains_.stiffness);
    twist = limited(twist, gains_.torque_limit / gains_.angular_stiffness);
    X_WD_.translation() = X_WT.translation() + stretch;
    X_WD_.linear() = rotated_by(twist) * X_WT.linear();
    return {gains_.stiffness * stretch + gains_.damping * (V_WD_W.linear - V_WT_W.linear),
            gains_.angular_stiffness * twist +
                gains_.angular_damping * (V_WD_W.angular - V_WT_W.angular)};
  }

  [[nodiscard]] const Pose& commanded() const noexcept { return X_WD_; }

 private:
  [[nodiscard]] static Vec3 limited(const Vec3& v, double most) noexcept {
    const double length = v.norm();
    return length > most ? Vec3(v * (most / length)) : v;
  }
  [[nodiscard]] static Mat3 rotated_by(const Vec3& rotation) noexcept {
    const double angle = rotation.norm();
    if (!(angle > 0.0)) return Mat3::Identity();
    return Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix();
  }
  [[nodiscard]] static Vec3 rotation_vector(const Mat3& R) noexcept {
    const Eigen::AngleAxisd turn(R);
    return turn.angle() * turn.axis();
  }

  CouplingGains gains_;
  Pose X_WD_ = Pose::Identity();
};

}  // namespace repel::network
