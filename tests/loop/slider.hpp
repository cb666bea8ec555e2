// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The smallest possible cell: an arm of three prismatic joints, a ball as the tool, boxes as
/// walls.
#pragma once

#include <repel/cell/arm_port.hpp>
#include <repel/cell/cell.hpp>
#include <repel/network/modules.hpp>

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace repel::test {

/// Three masses on rails along x, y and z. Its readings can be corrupted.
struct SliderArm : TorqueDrivenArm {
  void set_torques(std::span<const double> torques) noexcept override {
    std::copy(torques.begin(), torques.end(), force.begin());
  }
  void step(double period) noexcept override {
    for (int i = 0; i < 3; ++i) {
      v[i] = (v[i] + period * force[i] / mass) / (1.0 + period * friction / mass);
      q[i] += period * v[i];
    }
  }
  void read_positions(std::span<double> out) const noexcept override {
    std::copy(q.begin(), q.end(), out.begin());
    if (spoilt) out[1] = std::numeric_limits<double>::quiet_NaN();
  }
  void read_velocities(std::span<double> out) const noexcept override {
    std::copy(v.begin(), v.end(), out.begin());
  }

  double mass = 5.0;       // [kg]
  double friction = 20.0;  // [N s/m]
  bool spoilt = false;
  std::array<double, 3> q{};      // [m]
  std::array<double, 3> v{};      // [m/s]
  std::array<double, 3> force{};  // [N]
};

/// The tool is at the slider positions; its pose can be corrupted.
struct SliderKinematics : ArmKinematics {
  void update(std::span<const double> q) noexcept override {
    pose.translation() = Vec3(q[0], q[1], q[2]);
    if (spoilt) pose.translation().x() = std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] Pose X_WT() const noexcept override { return pose; }
  void tool_jacobian(JacobianRef J) const noexcept override {
    J.setZero();
    J.topLeftCorner<3, 3>().setIdentity();
  }
  /// Link i is carried by rails 0 to i.
  [[nodiscard]] Pose X_WL(int link) const noexcept override {
    Pose X = Pose::Identity();
    X.translation().head(link + 1) = pose.translation().head(link + 1);
    return X;
  }
  void jacobian(int link, const Vec3& /*p_WQ*/, JacobianRef J) const noexcept override {
    J.setZero();
    for (int i = 0; i <= link; ++i) J(i, i) = 1.0;
  }
  void gravity_torques(std::span<double> out) noexcept override {
    std::fill(out.begin(), out.end(), 0.0);
  }

  Pose pose = Pose::Identity();
  bool spoilt = false;
};

inline ArmModel slider_model(double effort_limit) {
  ArmModel model;
  for (const char* name : {"x", "y", "z"}) {
    ArmLink link;
    link.name = name;
    link.joint_name = name;
    link.type = JointType::prismatic;
    link.lower = -10.0;
    link.upper = 10.0;
    link.effort_limit = effort_limit;
    link.rotor_inertia = SliderArm{}.mass;
    link.viscous_friction = SliderArm{}.friction;
    model.links.push_back(link);
  }
  return model;
}

/// A network from a hand to the joints, with these modules before and after the Jacobian.
inline network::Plan plan_with(const std::vector<network::Module>& before,
                               const std::vector<network::Module>& after, int joints = 3) {
  network::Plan plan;
  plan.add("hand", network::FlowSource<network::any_size>(network::Vec<network::any_size>::Zero(6)))
      .add("kbb2", network::Kbb2());
  for (std::size_t i = 0; i < before.size(); ++i) plan.add("wall " + std::to_string(i), before[i]);
  plan.add("puma_kin", network::PumaKin());
  for (std::size_t i = 0; i < after.size(); ++i) plan.add("link " + std::to_string(i), after[i]);
  plan.add("puma_joints", network::PumaJoints(joints));
  return plan;
}

/// The network of Figure 9 of the paper on three rails; the ball acts without delay.
inline network::Plan sliders_network(const network::Kbb2Options& coupling = {},
                                     double ball_time = 0.0) {
  using namespace network;
  const std::vector<JointRange> rails(3, {-10.0, 10.0});
  return Plan()
      .add("torque_arm", TorqueArm())
      .add("multiplex", Multiplex())
      .add("spaceball", Spaceball({.time_constant = ball_time}))
      .add("relief", Relief())
      .add("kbb2", Kbb2(coupling))
      .add("obstacle", Obstacle())
      .add("puma_kin", PumaKin())
      .add("limits", network::Limits({}, rails))
      .add("visual", Visual())
      .add("puma_joints", PumaJoints(3));
}

/// The parameters of a run.
struct SliderOptions {
  CoprocessorOptions coprocessor{};
  double effort_limit = 1000.0;  // [N]
  double velocity_limit = 0.0;   // [m/s] of the first; 0: none
  int walls = 1;                 // one behind the other, 1 mm apart
  std::optional<ReciprocatingMotion> door{};
  bool is_touched = false;  // by what is not in the model
};

/// A ball of 50 mm that the script moves towards +x, against a wall with its face at x = 0.2 m. A
/// door, if there is one, begins 30 mm behind the ball.
struct SliderCell {
  static constexpr std::chrono::nanoseconds period{2500000};

  explicit SliderCell(const network::Script& script, const SliderOptions& options = {})
      : hands(script), cell(described(options)) {}

  /// One tick with a clock that advances by `elapsed`.
  const TickRecord& tick_alone(std::chrono::nanoseconds elapsed = period) noexcept {
    now += elapsed;
    const ArmReadings readings = port.read();
    cell.sense({&readings, 1}, now);
    const network::Command& command = hands.step(cell.X_WT(0).linear(), cell.elapsed());
    const TickRecord& record = *cell.act({&command, 1}).front();
    port.apply(record);
    return record;
  }
  /// The same, and simulates one period of the arm.
  const TickRecord& tick(std::chrono::nanoseconds elapsed = period) noexcept {
    const TickRecord& record = tick_alone(elapsed);
    arm.step(1e-9 * static_cast<double>(period.count()));
    return record;
  }

  CellDescription described(const SliderOptions& options) {
    CellDescription description;
    description.coprocessor = options.coprocessor;
    description.gain_check = network::GainCheck::warning;
    ArmDescription& sliders = description.arms.emplace_back();
    sliders.model = slider_model(options.effort_limit);
    sliders.model.links[0].velocity_limit = options.velocity_limit;
    sliders.options.joints.touches = options.is_touched;
    auto owned = std::make_unique<SliderKinematics>();
    kinematics = owned.get();
    sliders.kinematics = std::move(owned);
    sliders.parts.push_back({"ball", Shape::sphere(0.05)});
    sliders.network = sliders_network();
    const ForceLaw law{.range = 0.02, .surface_force = 100.0, .damping = 50.0};
    for (int i = 0; i < options.walls; ++i) {
      Pose X = Pose::Identity();
      X.translation() = Vec3(0.3, 0.0, 0.001 * i);
      description.obstacles.push_back(
          {"wall " + std::to_string(i), Shape::box({0.1, 1.0, 1.0}), X, law});
    }
    if (options.door) {
      Pose X = Pose::Identity();
      X.translation().x() = -0.13;
      description.obstacles.push_back(
          {"panel", Shape::box({0.05, 0.2, 0.2}), X, law, options.door});
    }
    return description;
  }

  SliderArm arm;
  ArmPort port{arm, 3};
  network::ScriptedOperator hands;
  SliderKinematics* kinematics = nullptr;
  Cell cell;
  std::chrono::nanoseconds now{0};
};

/// Moves along x at `speed` [m/s] for `seconds`.
inline network::Script push(double seconds, double speed) {
  network::Phase phase;
  phase.name = "push";
  phase.duration = seconds;
  phase.rates.linear = Vec3(speed, 0.0, 0.0);
  return {phase};
}

}  // namespace repel::test
