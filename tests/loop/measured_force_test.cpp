// SPDX-License-Identifier: BSD-3-Clause
// A force that is measured, in the whole loop: contacts and virtual walls are felt once each.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "loop/slider.hpp"

namespace repel {
namespace measured_force_test {

constexpr double period = 0.0025;  // [s]

/// Three masses on rails with dry friction along x, where a spring can be touched, and a force
/// sensor.
struct TouchingArm : TorqueDrivenArm {
  void set_torques(std::span<const double> torques) noexcept override { torque = torques[0]; }
  void step(double seconds) noexcept override {
    constexpr int parts = 50;
    const double h = seconds / parts;
    force = 0.0;
    for (int i = 0; i < parts; ++i) {
      const double depth = x - surface;
      const double touch = depth > 0.0 ? std::min(0.0, -stiffness * depth - damping * v) : 0.0;
      v += h * (torque + touch) / mass;
      const double held = h * friction / mass;
      v -= std::clamp(v, -held, held);
      x += h * v;
      force += touch / parts;
    }
  }
  void read_positions(std::span<double> out) const noexcept override {
    out[0] = x;
    out[1] = out[2] = 0.0;
  }
  void read_velocities(std::span<double> out) const noexcept override {
    out[0] = v;
    out[1] = out[2] = 0.0;
  }
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override {
    if (is_silent) return {};
    return Wrench{{is_spoilt ? std::nan("") : force, 0, 0}, {0, 0, 0}};
  }

  double mass = 5.0, friction = 0.0;                       // [kg], [N]
  double surface = 1e9, stiffness = 0.0, damping = 100.0;  // [m], [N/m], [N s/m]
  bool is_silent = false, is_spoilt = false;               // the sensor
  double torque = 0.0, x = 0.0, v = 0.0, force = 0.0;      // [N], [m], [m/s], [N]
};

/// An arm and its cell, with a virtual wall at 10 mm or none.
struct Sensed {
  explicit Sensed(const network::Script& script, std::optional<double> gain,
                  double wall_stiffness = 0.0)
      : hands(script), cell(described(gain, wall_stiffness)) {}

  const TickRecord& tick() noexcept {
    now += std::chrono::nanoseconds(2500000);
    const TickRecord& record =
        cell.step(port.read(), hands.step(cell.X_WT(0).linear(), cell.elapsed()), now);
    port.apply(record);
    arm.step(period);
    return record;
  }
  const TickRecord& run(double seconds) noexcept {
    for (int i = 1; i < std::lround(seconds / period); ++i) (void)tick();
    return tick();
  }

  static CellDescription described(std::optional<double> gain, double wall_stiffness) {
    using namespace network;
    CellDescription description;
    ArmDescription& arm = description.arms.emplace_back();
    arm.model = test::slider_model(1000.0);
    for (ArmLink& link : arm.model.links) link.viscous_friction = 0.0;
    arm.options.joints.touches = true;
    arm.kinematics = std::make_unique<test::SliderKinematics>();
    arm.parts.push_back({"ball", Shape::sphere(0.05)});
    Plan plan = Plan()
                    .add("ball", FlowSource<any_size>(network::Vec<any_size>::Zero(6)))
                    .add("spaceball", Spaceball({.dead_band = 0.0, .time_constant = 0.0}))
                    .add("kbb2", Kbb2())
                    .add("obstacle", Obstacle())
                    .add("puma_kin", PumaKin());
    if (gain) plan.add("force_sensor", ForceSensor({.gain = *gain}));
    arm.network = plan.add("puma_joints", PumaJoints(3));
    if (wall_stiffness == 0.0) return description;
    Pose X = Pose::Identity();
    X.translation().x() = 0.01 + 0.02 + 0.05 + 0.1;  // begins to act at x = 10 mm
    const ForceLaw law{
        .range = 0.02, .surface_force = 0.02 * wall_stiffness, .damping_may_rise = true};
    description.obstacles.push_back({"wall", Shape::box({0.1, 1.0, 1.0}), X, law});
    return description;
  }

  TouchingArm arm;
  ArmPort port{arm, 3};
  network::ScriptedOperator hands;
  Cell cell;
  std::chrono::nanoseconds now{0};
};

network::Script push(double seconds, double speed) {
  network::Script script = test::push(seconds, speed);
  script.push_back({});
  script.back().duration = 100.0;
  return script;
}

/// What is felt at rest with the hand 30 mm ahead, 20 mm beyond a surface at 10 mm [N].
double felt(double contact_stiffness, double wall_stiffness, std::optional<double> gain,
            double friction = 0.0) {
  Sensed robot(push(1.0, 0.03), gain, wall_stiffness);
  robot.arm.friction = friction;
  if (contact_stiffness > 0.0) {
    robot.arm.surface = 0.01;
    robot.arm.stiffness = contact_stiffness;
  }
  const TickRecord record = robot.run(4.0);
  EXPECT_EQ(record.status & ~status::saturated, 0U) << to_text(record.status);
  EXPECT_NEAR(robot.arm.v, 0.0, 1e-5);
  // All that acts on the arm besides friction, each once. A wall gives a little less while a
  // contact holds the arm that its prediction lets move.
  const double given_up = contact_stiffness > 0.0 && wall_stiffness > 0.0 ? 0.3 : 1e-3;
  const double rest = record.coupling.force.x() + record.virtual_force.force.x() + robot.arm.force;
  EXPECT_LE(std::abs(rest), friction / (1.0 + gain.value_or(0.0)) + given_up);
  EXPECT_EQ(contact_stiffness > 0.0, robot.arm.force < -1.0);
  EXPECT_EQ(wall_stiffness > 0.0, record.virtual_force.force.x() < -1.0);
  return record.coupling.force.x();
}

/// What is felt if each of the two pushes once: with the hand 20 mm beyond the surface, the
/// coupling is in series with a spring and the parabola of a virtual wall [N].
double once(double contact_stiffness, double wall_stiffness) {
  double low = 0.0, high = 0.02;
  for (int i = 0; i < 60; ++i) {
    const double depth = 0.5 * (low + high);
    const double pushed = contact_stiffness * depth + wall_stiffness * depth * depth / 0.02;
    (2000.0 * (0.02 - depth) > pushed ? low : high) = depth;
  }
  return 2000.0 * (0.02 - low);
}

TEST(MeasuredForce, ContactAndVirtualWallAreFeltOnceEach) {
  for (const double gain : {0.0, 0.5, 0.7}) {
    SCOPED_TRACE(gain);
    EXPECT_NEAR(felt(4000.0, 0.0, gain), once(4000.0, 0.0), 0.01);
    EXPECT_NEAR(felt(0.0, 4000.0, gain), once(0.0, 4000.0), 0.01);
    EXPECT_NEAR(felt(2000.0, 2000.0, gain), once(2000.0, 2000.0), 0.2);
  }
  EXPECT_NEAR(felt(4000.0, 0.0, {}), once(4000.0, 0.0), 0.01) << "without friction no difference";
}

TEST(MeasuredForce, DryFrictionIsFeltLess) {
  for (const auto& [contact, wall] : {std::pair(4000.0, 0.0), {0.0, 4000.0}, {2000.0, 2000.0}}) {
    (void)felt(contact, wall, 0.5, 10.0);
    (void)felt(contact, wall, 0.7, 10.0);
  }
}

TEST(MeasuredForce, FrictionOfFreeMotionIsDivided) {
  const auto drag = [](std::optional<double> gain) {
    Sensed robot(push(10.0, 0.05), gain);
    robot.arm.friction = 10.0;
    double sum = 0.0;
    (void)robot.run(3.0);
    for (int i = 0; i < 400; ++i) sum += robot.tick().coupling.force.x();
    return sum / 400;
  };
  EXPECT_NEAR(drag({}), 10.0, 0.05);
  EXPECT_NEAR(drag(0.5), 10.0 / 1.5, 0.05);
  EXPECT_NEAR(drag(0.7), 10.0 / 1.7, 0.05);
}

TEST(MeasuredForce, InertiaOfFreeMotionIsDivided) {
  const auto push_off = [](std::optional<double> gain) {
    network::Script script = test::push(0.8, 0.0);
    script.push_back(test::push(1.0, 0.05).front());
    Sensed robot(script, gain);
    (void)robot.run(0.8);
    double impulse = 0.0;
    for (int i = 0; i < 200; ++i) impulse += period * robot.tick().coupling.force.x();
    return impulse;
  };
  EXPECT_NEAR(push_off({}), 5.0 * 0.05, 0.01);
  EXPECT_NEAR(push_off(0.5), 5.0 * 0.05 / 1.5, 0.01);
}

TEST(MeasuredForce, SensorThatFailsInContactLeavesTheArmAsWithoutIt) {
  for (const bool is_silent : {false, true}) {
    Sensed robot(push(1.0, 0.03), 0.5);
    robot.arm.friction = 5.0;
    robot.arm.surface = 0.01;
    robot.arm.stiffness = 1e5;
    (void)robot.run(4.0);
    const double x = robot.arm.x;
    const auto fail = [&](bool does) {
      (is_silent ? robot.arm.is_silent : robot.arm.is_spoilt) = does;
    };
    double last = robot.arm.torque;
    const auto follow = [&](double seconds, bool is_bad, double slope) {
      for (int i = 0; i < std::lround(seconds / period); ++i) {
        const TickRecord& record = robot.tick();
        ASSERT_EQ((record.status & status::bad_wrench) != 0U, is_bad) << to_text(record.status);
        ASSERT_EQ(record.stop, Stop::running);
        // All it adds here is what dry friction carries.
        ASSERT_LE(std::abs(robot.arm.torque - last), 0.5 * 5.0 * period / slope + 0.01);
        ASSERT_NEAR(robot.arm.x, x, 1e-4);
        last = robot.arm.torque;
      }
    };
    fail(true);
    follow(0.5, true, network::ForceSensor::fall);
    EXPECT_EQ(robot.cell.network(0).find<network::ForceSensor>()->gain(), 0.0);
    fail(false);
    follow(1.0, false, network::ForceSensor::rise);
    EXPECT_EQ(robot.cell.network(0).find<network::ForceSensor>()->gain(), 0.5);
  }
}

TEST(MeasuredForce, IsReadWhereAModuleTakesIt) {
  Sensed with(push(1.0, 0.0), 0.5), without(push(1.0, 0.0), {});
  EXPECT_TRUE(with.run(0.1).wrench_read.has_value());
  EXPECT_FALSE(without.run(0.1).wrench_read.has_value());
}

}  // namespace measured_force_test
}  // namespace repel
