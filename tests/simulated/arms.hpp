// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The arms on which engines are tested, and their reference values computed without an engine.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include <repel/base/types.hpp>
#include <repel/world/arm.hpp>

namespace repel::simulated {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = 3.14159265358979323846;

/// A link of `mass` [kg] whose centre of mass is `p_LC` [m] from its joint, without stops.
inline ArmLink link_with(double mass, const Vec3& p_LC, const Vec3& moments) {
  ArmLink link;
  link.name = "link";
  link.joint_name = "joint";
  link.mass = mass;
  link.p_LC = p_LC;
  link.I_C_L = moments.asDiagonal();
  link.lower = -infinity;
  link.upper = infinity;
  return link;
}

/// One link that rotates about the horizontal axis y and hangs down at zero.
inline ArmModel pendulum() {
  ArmModel model;
  model.name = "pendulum";
  model.links.push_back(link_with(2.0, {0, 0, -0.5}, {0.03, 0.03, 0.001}));
  model.links[0].axis_J = Vec3::UnitY();
  return model;
}

/// A joint without gravity and lever arm: `inertia` [kg m^2] about the vertical axis z.
inline ArmModel turntable(double inertia) {
  ArmModel model;
  model.name = "turntable";
  model.links.push_back(link_with(1.0, Vec3::Zero(), {1.0, 1.0, inertia}));
  return model;
}

/// The PUMA 560 of Armstrong, Khatib and Burdick (1986) in standard DH, gravity along -z of the
/// base. The frame of link i is on its joint axis, so it is frame i - 1 of the DH table.
inline ArmModel puma560() {
  struct Joint {
    double alpha, a, d;                         // DH: [rad], [m], [m]
    double lower, upper;                        // [degrees]
    double gear, motor_inertia, motor_viscous;  // [], [kg m^2], [N m s/rad] at the motor
  };
  struct Body {
    double mass;
    Vec3 p_DC, moments;  // in DH frame D of the link
  };
  const std::array<Joint, 6> joints{{
      {pi / 2, 0, 0, -160, 160, -62.6111, 200e-6, 1.48e-3},
      {0, .4318, 0, -45, 225, 107.815, 200e-6, .817e-3},
      {-pi / 2, .0203, .15005, -225, 45, -53.7063, 200e-6, 1.38e-3},
      {pi / 2, 0, .4318, -110, 170, 76.0364, 33e-6, 71.2e-6},
      {-pi / 2, 0, 0, -100, 100, 71.923, 33e-6, 82.6e-6},
      {0, 0, 0, -266, 266, 76.686, 33e-6, 36.7e-6},
  }};
  const std::array<Body, 6> bodies{{
      {0, {0, 0, 0}, {0, .35, 0}},
      {17.4, {-.3638, .006, .2275}, {.13, .524, .539}},
      {4.8, {-.0203, -.0141, .070}, {.066, .086, .0125}},
      {.82, {0, .019, 0}, {1.8e-3, 1.3e-3, 1.8e-3}},
      {.34, {0, 0, 0}, {.3e-3, .4e-3, .3e-3}},
      {.09, {0, 0, .032}, {.15e-3, .15e-3, .04e-3}},
  }};
  ArmModel model;
  model.name = "puma560";
  Pose X_PJ = Pose::Identity();
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto& [alpha, a, d, lower, upper, gear, motor_inertia, motor_viscous] = joints[i];
    const Pose X_LD = Eigen::Translation3d(a, 0, d) * Pose(Eigen::AngleAxisd(alpha, Vec3::UnitX()));
    const Mat3 R_LD = X_LD.linear();
    ArmLink link = link_with(bodies[i].mass, X_LD * bodies[i].p_DC, Vec3::Zero());
    link.joint_name = "joint" + std::to_string(i + 1);
    link.I_C_L = R_LD * bodies[i].moments.asDiagonal() * R_LD.transpose();
    link.X_PJ = X_PJ;
    link.rotor_inertia = motor_inertia * gear * gear;
    link.viscous_friction = motor_viscous * gear * gear;
    link.lower = lower * pi / 180.0;
    link.upper = upper * pi / 180.0;
    model.links.push_back(link);
    X_PJ = X_LD;
  }
  return model;
}

/// The same with a mass in the first link, which has no effect with a fixed base but is required by
/// ODE.
inline ArmModel heavy_puma() {
  ArmModel model = puma560();
  model.links[0].mass = 10.0;
  model.links[0].I_C_L = Vec3(0.35, 0.35, 0.35).asDiagonal();
  return model;
}

/// Six revolute joints, about as long and heavy as a UR5, without motors, friction, stops and
/// limits: its brake parameters are unknown, and light links are attached to heavy ones.
inline ArmModel light_arm() {
  struct Link {
    double alpha, a, d, mass;  // DH: [rad], [m], [m]; [kg]
    Vec3 p_LC;                 // [m]
  };
  const std::array<Link, 6> links{{
      {pi / 2, 0, .089, 3.7, {0, 0, .06}},
      {0, -.425, 0, 8.4, {-.21, 0, .11}},
      {0, -.392, 0, 2.3, {-.24, 0, .03}},
      {pi / 2, 0, .109, 1.2, {0, 0, .1}},
      {-pi / 2, 0, .095, 1.2, {0, 0, .1}},
      {0, 0, .082, .2, {0, 0, .05}},
  }};
  ArmModel model;
  model.name = "light";
  Pose X_PJ = Pose::Identity();
  for (const auto& [alpha, a, d, mass, p_LC] : links) {
    const double size = 0.05 + std::abs(a) / 3;  // [m] radius of gyration
    ArmLink link = link_with(mass, p_LC, Vec3::Constant(mass * size * size));
    link.X_PJ = X_PJ;
    model.links.push_back(link);
    X_PJ = Eigen::Translation3d(a, 0, d) * Pose(Eigen::AngleAxisd(alpha, Vec3::UnitX()));
  }
  return model;
}

/// Eight equal links of 1 m and 10 kg, stretched out horizontally at zero: solvers that sweep from
/// joint to joint converge very slowly on it.
inline ArmModel chain() {
  ArmModel model;
  model.name = "chain";
  for (int i = 0; i < 8; ++i) {
    ArmLink link = link_with(10.0, {0.5, 0, 0}, {0.1, 0.1, 0.1});
    link.axis_J = Vec3::UnitY();
    if (i > 0) link.X_PJ.translation() = Vec3::UnitX();
    model.links.push_back(link);
  }
  return model;
}

/// The pose of every link at `q`, from the base outward.
inline std::vector<Pose> link_poses(const ArmModel& model, const std::vector<double>& q) {
  std::vector<Pose> X_WL;
  Pose X_WP = model.X_WB;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const ArmLink& link = model.links[i];
    Pose X_JL = Pose::Identity();
    if (link.type == JointType::revolute) {
      X_JL.linear() = Eigen::AngleAxisd(q[i], link.axis_J).toRotationMatrix();
    } else {
      X_JL.translation() = q[i] * link.axis_J;
    }
    X_WP = X_WP * link.X_PJ * X_JL;
    X_WL.push_back(X_WP);
  }
  return X_WL;
}

/// Potential energy [J] at `q`.
inline double potential_energy(const ArmModel& model, const std::vector<double>& q) {
  const std::vector<Pose> X_WL = link_poses(model, q);
  double energy = 0.0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    energy -= model.links[i].mass * model.gravity_W.dot(X_WL[i] * model.links[i].p_LC);
  }
  return energy;
}

/// The torques [N m] that balance gravity at `q`: the gradient of the potential energy.
inline std::vector<double> holding_torques(const ArmModel& model, const std::vector<double>& q) {
  constexpr double step = 1e-4;
  std::vector<double> torques;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const auto at = [&](double offset) {
      std::vector<double> moved = q;
      moved[i] += offset;
      return potential_energy(model, moved);
    };
    // Sixth-order differences: the energy is a trigonometric polynomial, so the residual is
    // rounding.
    torques.push_back((45 * (at(step) - at(-step)) - 9 * (at(2 * step) - at(-2 * step)) +
                       (at(3 * step) - at(-3 * step))) /
                      (60 * step));
  }
  return torques;
}

/// Kinetic energy [J] of links and rotors at `q`, `v`.
inline double kinetic_energy(const ArmModel& model, const std::vector<double>& q,
                             const std::vector<double>& v) {
  const std::vector<Pose> X_WL = link_poses(model, q);
  Vec3 omega_W = Vec3::Zero(), v_WL = Vec3::Zero(), p_WL = model.X_WB.translation();
  double energy = 0.0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    const ArmLink& link = model.links[i];
    const Mat3 R_WL = X_WL[i].linear();
    const Vec3 axis_W = R_WL * link.axis_J;
    v_WL += omega_W.cross(X_WL[i].translation() - p_WL);
    if (link.type == JointType::revolute) omega_W += v[i] * axis_W;
    if (link.type == JointType::prismatic) v_WL += v[i] * axis_W;
    p_WL = X_WL[i].translation();
    const Vec3 v_WC = v_WL + omega_W.cross(R_WL * link.p_LC);
    const Vec3 omega_L = R_WL.transpose() * omega_W;
    energy += 0.5 * (link.mass * v_WC.squaredNorm() + omega_L.dot(link.I_C_L * omega_L) +
                     link.rotor_inertia * v[i] * v[i]);
  }
  return energy;
}

template <class Arm>
std::vector<double> positions(const Arm& arm) {
  std::vector<double> q(static_cast<std::size_t>(arm.links()));
  arm.read_positions(q);
  return q;
}

template <class Arm>
std::vector<double> velocities(const Arm& arm) {
  std::vector<double> v(static_cast<std::size_t>(arm.links()));
  arm.read_velocities(v);
  return v;
}

/// Kinetic and potential energy [J] of the arm of `model`.
template <class Arm>
double energy(const ArmModel& model, const Arm& arm) {
  return kinetic_energy(model, positions(arm), velocities(arm)) +
         potential_energy(model, positions(arm));
}

/// The acceleration under `torques` at `q`, `v`, from one step of `period` [s]. Free bodies with
/// constraints need a longer one: rounding of their positions counts by its inverse square.
template <class Arm>
std::vector<double> accelerations(Arm& arm, const std::vector<double>& q,
                                  const std::vector<double>& v, const std::vector<double>& torques,
                                  double period = 1e-6) {
  arm.reset(q, v);
  arm.set_torques(torques);
  arm.step(period);
  std::vector<double> a = velocities(arm);
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = (a[i] - v[i]) / period;
  return a;
}

}  // namespace repel::simulated
