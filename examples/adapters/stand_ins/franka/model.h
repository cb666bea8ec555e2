// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <franka/model.h> of libfranka, with the published signatures of what the adapter
/// uses. The joints stand as in the maker's table of Denavit-Hartenberg parameters; the masses are
/// invented: a point on each link, and rotors.
#pragma once

#include <algorithm>
#include <array>

#include <Eigen/Dense>

#include <franka/robot.h>

namespace franka {

enum class Frame {
  kJoint1,
  kJoint2,
  kJoint3,
  kJoint4,
  kJoint5,
  kJoint6,
  kJoint7,
  kFlange,
  kEndEffector,
  kStiffness
};

class Model {
 public:
  Model() = default;
  Model(Model&&) noexcept = default;
  Model& operator=(Model&&) noexcept = default;
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  ~Model() noexcept = default;

  /// Column-major 4 x 4 pose in the base frame [m].
  std::array<double, 16> pose(Frame frame, const RobotState& state) const {
    std::array<double, 16> out;
    Eigen::Map<Eigen::Matrix4d>(out.data()) = frames(state)[static_cast<int>(frame)].matrix();
    return out;
  }

  /// Column-major 6 x 7 Jacobian of the origin of the frame, in the base frame.
  std::array<double, 42> zeroJacobian(Frame frame, const RobotState& state) const {
    const Frames X = frames(state);
    const int at = static_cast<int>(frame);
    std::array<double, 42> out{};
    Eigen::Map<Jacobian>(out.data()) = jacobian(X, std::min(at, 6), X[at].translation());
    return out;
  }

  /// Column-major 7 x 7 mass matrix [kg m^2].
  std::array<double, 49> mass(const RobotState& state) const noexcept {
    const Frames X = frames(state);
    Eigen::Matrix<double, 7, 7> M = Eigen::Matrix<double, 7, 7>::Identity() * 0.1;  // rotors
    for (int link = 0; link < 7; ++link) {
      const Jacobian J = jacobian(X, link, X[link].translation());
      M += masses[link] * J.topRows<3>().transpose() * J.topRows<3>();
    }
    std::array<double, 49> out;
    Eigen::Map<Eigen::Matrix<double, 7, 7>>(out.data()) = M;
    return out;
  }

 private:
  using Jacobian = Eigen::Matrix<double, 6, 7>;
  using Frames = std::array<Eigen::Isometry3d, 10>;  // of the joints, flange, EE and K
  static constexpr double masses[7] = {4.0, 4.0, 3.0, 3.0, 3.0, 2.0, 1.5};  // [kg]

  static Frames frames(const RobotState& state) noexcept {
    constexpr double a[7] = {0.0, 0.0, 0.0, 0.0825, -0.0825, 0.0, 0.088};  // [m]
    constexpr double d[7] = {0.333, 0.0, 0.316, 0.0, 0.384, 0.0, 0.0};     // [m]
    constexpr double alpha[7] = {0.0, -M_PI / 2, M_PI / 2, M_PI / 2, -M_PI / 2, M_PI / 2, M_PI / 2};
    using Eigen::AngleAxisd, Eigen::Translation3d, Eigen::Vector3d;
    Frames X;
    Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
    for (std::size_t i = 0; i < 7; ++i) {
      at = at * AngleAxisd(alpha[i], Vector3d::UnitX()) * Translation3d(a[i], 0.0, 0.0) *
           AngleAxisd(state.q[i], Vector3d::UnitZ()) * Translation3d(0.0, 0.0, d[i]);
      X[i] = at;
    }
    X[7] = at * Translation3d(0.0, 0.0, 0.107);
    X[8] = X[9] = X[7] * Eigen::Isometry3d(Eigen::Map<const Eigen::Matrix4d>(state.F_T_EE.data()));
    return X;
  }

  static Jacobian jacobian(const Frames& X, int link, const Eigen::Vector3d& p) noexcept {
    Jacobian J = Jacobian::Zero();
    for (int i = 0; i <= link; ++i) {
      const Eigen::Vector3d axis = X[i].linear().col(2);
      J.col(i) << axis.cross(p - X[i].translation()), axis;
    }
    return J;
  }
};

inline Model Robot::loadModel() {
  return Model();
}

// Weight and friction are compensated by the robot; what turns with the joints is not simulated.
inline void Robot::move() {
  RobotState now;
  now.q = q_true_;
  const std::array<double, 49> mass = Model().mass(now);
  const Eigen::Matrix<double, 7, 7> M = Eigen::Map<const Eigen::Matrix<double, 7, 7>>(mass.data());
  Eigen::Map<Eigen::Matrix<double, 7, 1>> q(q_true_.data());
  Eigen::Map<Eigen::Matrix<double, 7, 1>> dq(dq_true_.data());
  dq += 1e-3 * M.ldlt().solve(Eigen::Map<const Eigen::Matrix<double, 7, 1>>(state_.tau_J_d.data()));
  q += 1e-3 * dq;
  state_.q = q_true_;
  state_.dq = dq_true_;
  state_.time = Duration(state_.time.toMSec() + 1);
}

}  // namespace franka
