// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A hand that pushes a ball on a rail against a wall, slowly and ever harder.
#pragma once

#include <array>
#include <chrono>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <repel/cell/cell.hpp>
#include <repel/network/modules.hpp>

namespace repel::figures {

/// One rail along x, with the ball at its end.
struct Rail : ArmKinematics {
  void update(std::span<const double> q) noexcept override { pose.translation().x() = q[0]; }
  [[nodiscard]] Pose X_WT() const noexcept override { return pose; }
  [[nodiscard]] Pose X_WL(int /*link*/) const noexcept override { return pose; }
  void tool_jacobian(JacobianRef J) const noexcept override {
    J.setZero();
    J(0, 0) = 1.0;
  }
  void jacobian(int /*link*/, const Vec3& /*p_WQ*/, JacobianRef J) const noexcept override {
    tool_jacobian(J);
  }
  void gravity_torques(std::span<double> out) noexcept override { out[0] = 0.0; }
  Pose pose = Pose::Identity();
};

struct Pushed {
  const char* name;
  ForceLaw law;
};
inline std::vector<Pushed> pushed_walls() {
  const ForceLaw spring{.range = 0.02, .surface_force = 40.0, .damping = 100.0};
  ForceLaw hard = spring;
  hard.hold = HoldKind::hard;
  ForceLaw membrane = spring;
  membrane.ceiling = 15.0;
  membrane.passable = true;
  return {{"spring", spring}, {"hard wall", hard}, {"membrane", membrane}};
}

struct PushedBall {
  double hand = 0.0;   ///< [m] of the hand beyond the surface
  double ball = 0.0;   ///< [m] of the ball beyond it
  double force = 0.0;  ///< [N] that the operator feels
};

/// At 400 Hz, by a hand that moves at 10 mm/s and holds the ball by a spring of 2 N/mm.
inline std::vector<PushedBall> push_ball(const ForceLaw& law) {
  constexpr double mass = 5.0;      // [kg]
  constexpr double friction = 5.0;  // [N s/m]
  constexpr double speed = 0.01;    // [m/s]
  constexpr double before = 0.03;   // [m] between ball and surface at the start
  constexpr double period = 0.0025;
  CellDescription description;
  ArmDescription& arm = description.arms.emplace_back();
  ArmLink link;
  link.name = link.joint_name = "rail";
  link.type = JointType::prismatic;
  link.axis_J = Vec3::UnitX();
  link.lower = -1.0;
  link.upper = 1.0;
  link.effort_limit = 1000.0;
  link.rotor_inertia = mass;
  link.viscous_friction = friction;
  arm.model.links.push_back(link);
  arm.kinematics = std::make_unique<Rail>();
  arm.parts.push_back({"ball", Shape::sphere(0.02)});
  arm.network = network::Plan()
                    .add("lever", network::TorqueArm())
                    .add("multiplex", network::Multiplex())
                    .add("ball", network::Spaceball({.dead_band = 0.0, .time_constant = 0.0}))
                    .add("coupling", network::Kbb2({.stiffness = 2000.0, .force_limit = 1e4}))
                    .add("walls", network::Obstacle())
                    .add("kinematics", network::PumaKin())
                    .add("joints", network::PumaJoints(1));
  Pose X_WP = Pose::Identity();
  X_WP.translation().x() = before + 0.02 + 0.004;
  description.obstacles.push_back({"wall", Shape::box({0.004, 0.2, 0.2}), X_WP, law});
  description.gain_check = network::GainCheck::warning;
  Cell cell(std::move(description));
  std::array<double, 1> q{}, v{};
  network::Command hands;
  hands.hand.ball.linear.x() = speed;
  std::chrono::nanoseconds now{0};
  std::vector<PushedBall> way;
  for (int tick = 0; tick < 4000; ++tick) {
    const TickRecord& record = cell.step({q, v}, hands, now += cell.period());
    v[0] = (v[0] + period * record.torques[0] / mass) / (1.0 + period * friction / mass);
    q[0] += period * v[0];
    way.push_back({speed * period * (tick + 1) - before, q[0] - before, record.coupling.force.x()});
  }
  return way;
}

}  // namespace repel::figures
