/// @file
/// The smallest cell there is: an arm of three sliding joints, a ball for a tool, walls of boxes.
#pragma once

#include <repel/loop/shuttle.hpp>
#include <repel/loop/tick.hpp>
#include <repel/network/modules.hpp>

#include <array>
#include <limits>
#include <string>

namespace repel::test {

/// Three masses on rails along x, y and z. What it reports can be spoiled.
struct SliderArm {
  void set_torques(std::span<const double> torques) noexcept {
    std::copy(torques.begin(), torques.end(), force.begin());
  }
  void step(double period) noexcept {
    for (int i = 0; i < 3; ++i) {
      v[i] = (v[i] + period * force[i] / mass) / (1.0 + period * friction / mass);
      q[i] += period * v[i];
    }
  }
  void read_positions(std::span<double> out) const noexcept {
    std::copy(q.begin(), q.end(), out.begin());
    if (spoilt) out[1] = std::numeric_limits<double>::quiet_NaN();
  }
  void read_velocities(std::span<double> out) const noexcept {
    std::copy(v.begin(), v.end(), out.begin());
  }

  double mass = 5.0;       // [kg]
  double friction = 20.0;  // [N s/m]
  bool spoilt = false;
  std::array<double, 3> q{};      // [m]
  std::array<double, 3> v{};      // [m/s]
  std::array<double, 3> force{};  // [N]
};

/// The tool is where the sliders are; its pose can be spoiled.
struct SliderKinematics {
  void update(std::span<const double> q) noexcept {
    pose.translation() = Vec3(q[0], q[1], q[2]);
    if (spoilt) pose.translation().x() = std::numeric_limits<double>::quiet_NaN();
  }
  [[nodiscard]] Pose X_WT() const noexcept { return pose; }
  void tool_jacobian(Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>> J) const noexcept {
    J.setZero();
    J.topLeftCorner<3, 3>().setIdentity();
  }
  /// Link i is carried by the rails 0 to i.
  [[nodiscard]] Pose X_WL(int link) const noexcept {
    Pose X = Pose::Identity();
    X.translation().head(link + 1) = pose.translation().head(link + 1);
    return X;
  }
  void jacobian(int link, const Vec3& /*p_WQ*/,
                Eigen::Ref<Eigen::Matrix<double, 6, Eigen::Dynamic>> J) const noexcept {
    J.setZero();
    for (int i = 0; i <= link; ++i) J(i, i) = 1.0;
  }
  void gravity_torques(std::span<double> out) noexcept { std::fill(out.begin(), out.end(), 0.0); }

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

/// The paper's Figure 9 on three rails; the ball acts at once.
inline network::Network sliders_network(std::chrono::nanoseconds period,
                                        const network::Kbb2Options& coupling = {},
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
      .add("puma_joints", PumaJoints(3))
      .build(std::chrono::duration<double>(period).count());
}

/// A ball of 50 mm that the script pushes to +x, against a wall whose face is at x = 0.2 m. Where
/// there is a door, it stands 30 mm behind the ball and is the test's to move.
struct SliderCell {
  static constexpr std::chrono::nanoseconds period{2500000};

  explicit SliderCell(const network::Script& script, const CoprocessorOptions& options = {},
                      double effort_limit = 1000.0, int walls = 1, bool with_door = false)
      : model(slider_model(effort_limit)),
        tool(world.add_body("tool")),
        coprocessor(built(walls, with_door), options),
        the_operator(script),
        teleoperator(model, arm, kinematics, world, tool, coprocessor, the_operator,
                     sliders_network(period), period) {}

  /// One tick by a clock that advances by `elapsed`, and one period of the arm.
  const TickRecord& tick(std::chrono::nanoseconds elapsed = period) {
    now += elapsed;
    const TickRecord& record = teleoperator.tick(now);
    arm.step(1e-9 * static_cast<double>(period.count()));
    return record;
  }

  World& built(int walls, bool with_door) {
    const PartId ball = world.add_part(tool, "ball", Shape::sphere(0.05));
    for (int i = 0; i < walls; ++i) {
      Pose X = Pose::Identity();
      X.translation() = Vec3(0.3, 0.0, 0.001 * i);
      const PartId wall =
          world.add_part(World::fixed, "wall " + std::to_string(i), Shape::box({0.1, 1.0, 1.0}), X);
      world.add_pair(ball, wall, {.range = 0.02, .surface_force = 100.0, .damping = 50.0});
    }
    if (with_door) {
      door.X_WB.translation().x() = -0.13;
      door.body = world.add_body("door", door.X_WB);
      const PartId panel = world.add_part(door.body, "panel", Shape::box({0.05, 0.2, 0.2}));
      world.add_pair(ball, panel, {.range = 0.02, .surface_force = 100.0, .damping = 50.0});
    }
    return world;
  }

  ArmModel model;
  SliderArm arm;
  SliderKinematics kinematics;
  World world;
  BodyId tool;
  Shuttle door;
  Coprocessor coprocessor;
  network::ScriptedOperator the_operator;
  Teleoperator<SliderArm, SliderKinematics> teleoperator;
  std::chrono::nanoseconds now{0};
};

/// `seconds` of pushing along x at `speed` [m/s].
inline network::Script push(double seconds, double speed) {
  network::Phase phase;
  phase.name = "push";
  phase.duration = seconds;
  phase.rates.linear = Vec3(speed, 0.0, 0.0);
  return {phase};
}

}  // namespace repel::test
