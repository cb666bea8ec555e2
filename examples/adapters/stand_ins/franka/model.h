// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Stand-in for <franka/model.h> of libfranka, with the published signatures of what adapters
/// use. The joints stand as in the maker's table of Denavit-Hartenberg parameters; the masses are
/// invented: a point on each link, and rotors.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <string>

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
  Model(Model&&) noexcept = default;
  Model& operator=(Model&&) noexcept = default;
  Model(const Model&) = delete;
  Model& operator=(const Model&) = delete;
  ~Model() noexcept = default;

  // All matrices by columns. Forms without a state take its joints, tool and load instead.

  /// 4 x 4 pose in the base frame [m].
  std::array<double, 16> pose(Frame frame, const RobotState& state) const {
    return pose(frame, state.q, state.F_T_EE, state.EE_T_K);
  }
  std::array<double, 16> pose(Frame frame, const std::array<double, 7>& q,
                              const std::array<double, 16>& F_T_EE,
                              const std::array<double, 16>& EE_T_K) const {
    std::array<double, 16> out;
    const Frames X = frames(q, F_T_EE, EE_T_K);
    Eigen::Map<Eigen::Matrix4d>(out.data()) = X[static_cast<std::size_t>(frame)].matrix();
    return out;
  }

  /// 6 x 7 Jacobian of the origin of the frame, in the base frame.
  std::array<double, 42> zeroJacobian(Frame frame, const RobotState& state) const {
    return zeroJacobian(frame, state.q, state.F_T_EE, state.EE_T_K);
  }
  std::array<double, 42> zeroJacobian(Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const {
    const Frames X = frames(q, F_T_EE, EE_T_K);
    const auto at = static_cast<std::size_t>(frame);
    return array_of(jacobian(X, std::min(at, last), X[at].translation()));
  }

  /// The same in the frame itself.
  std::array<double, 42> bodyJacobian(Frame frame, const RobotState& state) const {
    return bodyJacobian(frame, state.q, state.F_T_EE, state.EE_T_K);
  }
  std::array<double, 42> bodyJacobian(Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const {
    const Frames X = frames(q, F_T_EE, EE_T_K);
    const auto at = static_cast<std::size_t>(frame);
    Jacobian J = jacobian(X, std::min(at, last), X[at].translation());
    J.topRows<3>() = X[at].linear().transpose() * J.topRows<3>();
    J.bottomRows<3>() = X[at].linear().transpose() * J.bottomRows<3>();
    return array_of(J);
  }

  /// 7 x 7 mass matrix [kg m^2].
  std::array<double, 49> mass(const RobotState& state) const noexcept {
    return mass(state.q, state.I_total, state.m_total, state.F_x_Ctotal);
  }
  std::array<double, 49> mass(const std::array<double, 7>& q, const std::array<double, 9>& I_total,
                              double m_total,
                              const std::array<double, 3>& F_x_Ctotal) const noexcept {
    const Frames X = frames(q);
    Matrix7 M = Matrix7::Identity() * rotor;
    for (std::size_t link = 0; link < 7; ++link) {
      const Jacobian J = jacobian(X, link, X[link].translation());
      M += masses[link] * J.topRows<3>().transpose() * J.topRows<3>();
    }
    const Jacobian J = jacobian(X, last, load_at(X, F_x_Ctotal));
    const Eigen::Matrix3d R = X[flange].linear();
    const Eigen::Map<const Eigen::Matrix3d> I(I_total.data());
    M += m_total * J.topRows<3>().transpose() * J.topRows<3>();
    M += J.bottomRows<3>().transpose() * R * I * R.transpose() * J.bottomRows<3>();
    std::array<double, 49> out;
    Eigen::Map<Matrix7>(out.data()) = M;
    return out;
  }

  /// [N m] not simulated: zeros.
  std::array<double, 7> coriolis(const RobotState&) const noexcept { return {}; }

  /// [N m] that hold the arm and its load.
  std::array<double, 7> gravity(const std::array<double, 7>& q, double m_total,
                                const std::array<double, 3>& F_x_Ctotal,
                                const std::array<double, 3>& gravity_earth = {
                                    {0.0, 0.0, -9.81}}) const noexcept {
    const Frames X = frames(q);
    const Eigen::Map<const Eigen::Vector3d> g(gravity_earth.data());
    Eigen::Matrix<double, 7, 1> held =
        -m_total * jacobian(X, last, load_at(X, F_x_Ctotal)).topRows<3>().transpose() * g;
    for (std::size_t link = 0; link < 7; ++link) {
      held -= masses[link] * jacobian(X, link, X[link].translation()).topRows<3>().transpose() * g;
    }
    std::array<double, 7> out;
    Eigen::Map<Eigen::Matrix<double, 7, 1>>(out.data()) = held;
    return out;
  }
  std::array<double, 7> gravity(const RobotState& state,
                                const std::array<double, 3>& gravity_earth) const noexcept {
    return gravity(state.q, state.m_total, state.F_x_Ctotal, gravity_earth);
  }
  std::array<double, 7> gravity(const RobotState& state) const noexcept {
    return gravity(state.q, state.m_total, state.F_x_Ctotal);
  }

 private:
  friend class Robot;
  Model() = default;  // by Robot::loadModel alone

  using Matrix7 = Eigen::Matrix<double, 7, 7>;
  using Jacobian = Eigen::Matrix<double, 6, 7>;
  using Frames = std::array<Eigen::Isometry3d, 10>;  // of the joints, flange, EE and K
  static constexpr std::size_t last = 6, flange = 7;
  static constexpr std::array<double, 16> here{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  static constexpr double rotor = 0.1;                                           // [kg m^2]
  static constexpr double masses[7] = {4.0, 4.0, 3.0, 3.0, 3.0, 2.0, 1.5};       // [kg]
  static constexpr double a[7] = {0.0, 0.0, 0.0, 0.0825, -0.0825, 0.0, 0.088};   // [m]
  static constexpr double d[7] = {0.333, 0.0, 0.316, 0.0, 0.384, 0.0, 0.0};      // [m]
  static constexpr double alpha[7] = {0.0,       -M_PI / 2, M_PI / 2, M_PI / 2,  // [rad]
                                      -M_PI / 2, M_PI / 2,  M_PI / 2};
  static constexpr double to_flange = 0.107;  // [m]

  static Frames frames(const std::array<double, 7>& q, const std::array<double, 16>& F_T_EE = here,
                       const std::array<double, 16>& EE_T_K = here) noexcept {
    using Eigen::AngleAxisd, Eigen::Isometry3d, Eigen::Matrix4d, Eigen::Translation3d;
    using Eigen::Vector3d;
    Frames X;
    Isometry3d at = Isometry3d::Identity();
    for (std::size_t i = 0; i < 7; ++i) {
      at = at * AngleAxisd(alpha[i], Vector3d::UnitX()) * Translation3d(a[i], 0.0, 0.0) *
           AngleAxisd(q[i], Vector3d::UnitZ()) * Translation3d(0.0, 0.0, d[i]);
      X[i] = at;
    }
    X[flange] = at * Translation3d(0.0, 0.0, to_flange);
    X[8] = X[flange] * Isometry3d(Eigen::Map<const Matrix4d>(F_T_EE.data()));
    X[9] = X[8] * Isometry3d(Eigen::Map<const Matrix4d>(EE_T_K.data()));
    return X;
  }
  static Eigen::Vector3d load_at(const Frames& X, const std::array<double, 3>& F_x_C) noexcept {
    return X[flange] * Eigen::Map<const Eigen::Vector3d>(F_x_C.data());
  }

  static Jacobian jacobian(const Frames& X, std::size_t link, const Eigen::Vector3d& p) noexcept {
    Jacobian J = Jacobian::Zero();
    for (std::size_t i = 0; i <= link; ++i) {
      const Eigen::Vector3d axis = X[i].linear().col(2);
      J.col(static_cast<Eigen::Index>(i)) << axis.cross(p - X[i].translation()), axis;
    }
    return J;
  }
  static std::array<double, 42> array_of(const Jacobian& J) noexcept {
    std::array<double, 42> out;
    Eigen::Map<Jacobian>(out.data()) = J;
    return out;
  }
};

inline Model Robot::loadModel() {
  return Model();
}

inline std::string Robot::getRobotModel() {
  std::ostringstream urdf;
  urdf << std::setprecision(17) << "<robot name=\"stand_in\"><link name=\"link0\"/>";
  for (std::size_t i = 0; i < 7; ++i) {
    const double side = -std::sin(Model::alpha[i]) * Model::d[i];
    const double up = std::cos(Model::alpha[i]) * Model::d[i];
    const std::string effort = i < 4 ? "87" : "12";
    urdf << "<joint name=\"joint" << i + 1 << "\" type=\"revolute\"><parent link=\"link" << i
         << "\"/><child link=\"link" << i + 1 << "\"/><origin xyz=\"" << Model::a[i] << ' ' << side
         << ' ' << up << "\" rpy=\"" << Model::alpha[i] << " 0 0\"/><axis xyz=\"0 0 1\"/>"
         << "<limit lower=\"-3.0\" upper=\"4.0\" velocity=\"2.0\" effort=\"" << effort
         << "\"/></joint><link name=\"link" << i + 1 << "\"><inertial><mass value=\""
         << Model::masses[i] << "\"/><inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\""
         << " izz=\"0\"/></inertial><collision><geometry><sphere radius=\"0.06\"/></geometry>"
         << "</collision></link>";
  }
  urdf << "<joint name=\"joint8\" type=\"fixed\"><parent link=\"link7\"/><child link=\"link8\"/>"
       << "<origin xyz=\"0 0 " << Model::to_flange << "\"/></joint><link name=\"link8\"/></robot>";
  return urdf.str();
}

// Weight and friction are compensated by the robot; what turns with the joints is not simulated.
inline void Robot::move() {
  const std::array<double, 49> mass =
      Model().mass(q_true_, state_.I_total, state_.m_total, state_.F_x_Ctotal);
  const Eigen::Matrix<double, 7, 7> M = Eigen::Map<const Eigen::Matrix<double, 7, 7>>(mass.data());
  Eigen::Map<Eigen::Matrix<double, 7, 1>> q(q_true_.data());
  Eigen::Map<Eigen::Matrix<double, 7, 1>> dq(dq_true_.data());
  dq += 1e-3 * M.ldlt().solve(Eigen::Map<const Eigen::Matrix<double, 7, 1>>(state_.tau_J_d.data()));
  q += 1e-3 * dq;
  state_.q = q_true_;
  state_.dq = dq_true_;
  state_.time += Duration(1);
}

}  // namespace franka
