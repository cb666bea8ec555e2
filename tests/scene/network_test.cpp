// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include <repel/base/setup_error.hpp>
#include <repel/network/modules.hpp>
#include <repel/scene/build_network.hpp>

#include "yaml_text.hpp"

namespace repel::scene {
namespace network_test {

using testing::base_scene;
using testing::options;
using testing::parsed;

Scene with_module(const std::string& text) {
  return parsed(base_scene + "network: [{module: " + text + "}]\n");
}

ArmModel two_joints() {
  ArmModel arm;
  for (const char* name : {"first", "second"}) {
    ArmLink link;
    link.name = link.joint_name = name;
    link.lower = -1.0;
    link.upper = 2.0;
    arm.links.push_back(link);
  }
  return arm;
}

/// The message of the exception from building the network of `modules`; empty if none is thrown.
std::string refusal(const std::string& modules) {
  try {
    const Scene scene = parsed(base_scene + "network:\n" + modules);
    (void)build_network(scene, scene, two_joints(), 400.0);
  } catch (const SetupError& error) {
    return error.what();
  }
  return {};
}

const std::string slave =
    "  - {module: kbb2}\n  - {module: obstacle}\n  - {module: puma_kin}\n"
    "  - {module: limits}\n  - {module: puma_joints}\n";

TEST(SceneNetwork, WithoutOneThoseOfThePaperAndTheWholeArmStandInTheirOrder) {
  const Scene scene = parsed(base_scene);
  std::string names;
  for (const Module& module : scene.network.modules) names += module.name + " ";
  EXPECT_EQ(names,
            "torque_arm multiplex spaceball relief kbb2 obstacle puma_kin arm_obstacle limits "
            "visual puma_joints ");
  EXPECT_EQ(scene.network.gain_check, network::GainCheck::error);
  const network::Network built = build_network(scene, scene, two_joints(), 400.0);
  EXPECT_EQ(built.nodes().size(), 11U);
  EXPECT_EQ(built.connections().size(), 10U);
  EXPECT_EQ(built.find<network::PumaJoints>()->size(), 2);
}

TEST(SceneNetwork, TheLeverIsLosslessUnlessTheFileSaysOtherwise) {
  const auto scales = [](const std::string& text) {
    return options<network::MultiplexOptions>(with_module("multiplex, " + text));
  };
  EXPECT_EQ(scales("velocity_scale: 0.3 m/rad").force_scale, 0.3);
  EXPECT_EQ(scales("velocity_scale: 0.3 m/rad, force_scale: 50 mm").force_scale, 0.05);
}

TEST(SceneNetwork, EveryNumberOfAModuleArrives) {
  const auto relief = options<network::ReliefOptions>(
      with_module("relief, compliant: [x, rz], frame: world, stiffness: 2 N/mm, damping: 7 N s/m, "
                  "angular_stiffness: 3 N m/rad, angular_damping: 4 N m s/rad"));
  EXPECT_EQ(relief.compliant, (std::array<bool, 6>{true, false, false, false, false, true}));
  EXPECT_EQ(relief.frame, network::ReliefFrame::world);
  EXPECT_EQ(relief.stiffness, 2000.0);
  EXPECT_EQ(relief.angular_damping, 4.0);

  const auto line = options<network::LineOptions>(with_module(
      "line, kind: force_velocity, impedance: 30 N s/m, angular_impedance: 2 N m s/rad, delay: "
      "100 ms, jitter: 5 ms, loss: 5 %, seed: 7"));
  EXPECT_EQ(line.kind, network::LineKind::force_velocity);
  EXPECT_EQ(line.impedance, 30.0);
  EXPECT_EQ(line.channel.delay, 0.1);
  EXPECT_EQ(line.channel.loss, 0.05);
  EXPECT_EQ(line.channel.seed, 7U);

  const auto handle = options<network::SixAxesOptions>(with_module(
      "six_axes, mass: 500 g, inertia: 0.002 kg m^2, friction: 2 N s/m, angular_friction: 0.02 "
      "N m s/rad, hand_stiffness: 400 N/m, hand_damping: 20 N s/m, angular_hand_stiffness: 4 "
      "N m/rad, angular_hand_damping: 0.3 N m s/rad, force_limit: 40 N, torque_limit: 3 N m, "
      "motion_scale: 0.5"));
  EXPECT_EQ(handle.mass, 0.5);
  EXPECT_EQ(handle.inertia, 0.002);
  EXPECT_EQ(handle.friction, 2.0);
  EXPECT_EQ(handle.angular_friction, 0.02);
  EXPECT_EQ(handle.hand_stiffness, 400.0);
  EXPECT_EQ(handle.hand_damping, 20.0);
  EXPECT_EQ(handle.angular_hand_stiffness, 4.0);
  EXPECT_EQ(handle.angular_hand_damping, 0.3);
  EXPECT_EQ(handle.force_limit, 40.0);
  EXPECT_EQ(handle.torque_limit, 3.0);
  EXPECT_EQ(handle.motion_scale, 0.5);

  const Scene obstacle = with_module("obstacle, gain_check: warning, most_energy: 2 J");
  EXPECT_EQ(obstacle.network.gain_check, network::GainCheck::warning);
  EXPECT_EQ(options<network::ObstacleOptions>(obstacle).passivity.most_energy, 2.0);

  const auto posture = options<network::PostureOptions>(
      with_module("posture, stiffness: 20 N m/rad, damping: 3 N m s/rad, torque_limit: 9 N m, "
                  "most_energy: 4 J, most_damping: 200 N m s/rad, joints: [50 mm, 0.1 0.2 rad]"));
  EXPECT_EQ(posture.stiffness, 20.0);
  EXPECT_EQ(posture.damping, 3.0);
  EXPECT_EQ(posture.torque_limit, 9.0);
  EXPECT_EQ(posture.most_energy, 4.0);
  EXPECT_EQ(posture.most_damping, 200.0);
  EXPECT_EQ(posture.joints, (std::vector<double>{0.05, 0.1, 0.2}));

  const auto mass = options<Element>(with_module("mass, mass: 200 g, inertia: 0.5 kg m^2"));
  EXPECT_EQ(mass.kind, Element::Kind::mass);
  EXPECT_EQ(mass.linear, 0.2);
  EXPECT_EQ(mass.angular, 0.5);
  EXPECT_EQ(options<network::Common>(with_module("junction, common: effort")),
            network::Common::effort);
}

TEST(SceneNetwork, OtherArrangementsAreAsEasy) {
  // The ball alone, over a line, with a mass at the far end.
  EXPECT_EQ(
      refusal("  - {module: ground}\n  - {module: spaceball}\n  - {module: kbb2, name: near}\n"
              "  - {module: line, delay: 20 ms}\n  - {module: junction, to: kbb2}\n"
              "  - {module: mass, mass: 1 kg, inertia: 0.01 kg m^2, to: junction}\n" +
              slave),
      "");
  EXPECT_EQ(refusal("  - {module: torque_arm}\n  - {module: multiplex}\n" + slave), "");
  // The same with a load that the lever moves as well.
  EXPECT_EQ(refusal("  - {module: torque_arm}\n  - {module: multiplex}\n"
                    "  - {module: junction, to: [load, kbb2]}\n"
                    "  - {module: kbb2, name: load}\n"
                    "  - {module: mass, mass: 1 kg, inertia: 1 kg m^2, to: []}\n" +
                    slave),
            "");
}

TEST(SceneNetwork, WhatCannotBeBuiltIsRefusedWithItsLine) {
  const auto expect = [](const std::string& modules, const std::string& part) {
    const std::string text = refusal(modules);
    EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_NE(text.find("scenes/test.yaml:"), std::string::npos) << text;
  };
  expect("  - {module: multiplex}\n" + slave, "test.yaml:9: network: module 'multiplex' has");
  expect("  - {module: torque_arm}\n  - {module: torque_arm}\n" + slave, "two modules");
  expect("  - {module: torque_arm}\n  - {module: multiplex, to: nowhere}\n" + slave, "'nowhere'");
  expect("  - {module: torque_arm}\n" + slave, "one side is tool, the other lever");
  // The wall force would pass through a spring whose far end has no measured flow.
  expect(
      "  - {module: torque_arm}\n  - {module: multiplex}\n  - {module: obstacle}\n"
      "  - {module: kbb2}\n  - {module: puma_kin}\n  - {module: puma_joints}\n",
      "'obstacle' is a second nonlinear element");
  // Two parallel spring paths.
  expect(
      "  - {module: ground}\n  - {module: junction, name: fork, to: [upper, lower]}\n"
      "  - {module: kbb2, name: upper, to: join}\n"
      "  - {module: kbb2, name: lower, to: join}\n"
      "  - {module: junction, name: join}\n" +
          slave,
      "delay-free loop");
}

/// A mast that slides, 0 to 5 m, and a joint behind it that turns.
ArmModel mast() {
  ArmModel arm = two_joints();
  arm.links[0].type = JointType::prismatic;
  arm.links[0].lower = 0.0;
  arm.links[0].upper = 5.0;
  return arm;
}

/// What is said of a posture with this key; empty: nothing.
std::string posture_refusal(const ArmModel& arm, const std::string& key) {
  try {
    const Scene scene = parsed(base_scene +
                               "network: [{module: ground}, {module: kbb2}, {module: obstacle},\n"
                               "  {module: puma_kin}, {module: posture" +
                               key + "},\n  {module: puma_joints}]\n");
    (void)build_network(scene, scene, arm, 400.0);
  } catch (const SetupError& error) {
    return error.what();
  }
  return {};
}

TEST(SceneNetwork, APostureHasAPositionOfTheRightKindForEachJoint) {
  EXPECT_EQ(posture_refusal(two_joints(), ""), "");
  EXPECT_EQ(posture_refusal(two_joints(), ", joints: 0 45 deg"), "");
  EXPECT_EQ(posture_refusal(mast(), ", joints: [1 m, 45 deg]"), "");
  const auto expect = [](const ArmModel& arm, const std::string& key, const std::string& part) {
    const std::string text = posture_refusal(arm, key);
    EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_EQ(text.find("scenes/test.yaml:"), 0U) << text;
  };
  expect(two_joints(), ", joints: 0 45 10 deg", "'joints' has 3 positions; allowed: 2");
  expect(mast(), ", joints: 0 45 deg", "an angle for the joint 'first'; allowed: a length");
  expect(two_joints(), ", joints: [1 m, 45 deg]", "a length for the joint 'first'");
  expect(two_joints(), ", joints: 0 1e9 rad", "allowed: ");
  expect(two_joints(), ", stiffness: -1 N m/rad", "'stiffness' is '-1 N m/rad'; allowed: 0 to");
  expect(two_joints(), ", range: 1 deg", "'range'");
}

/// Where the limits begin to act, for each joint; the part of the message after the file if they
/// are refused.
struct Zones {
  std::vector<double> of_joints;
  std::string refusal;
};

Zones zones(const ArmModel& arm, const std::string& range) {
  Zones found;
  try {
    const Scene scene =
        parsed(base_scene + "network: [{module: torque_arm}, {module: multiplex}, " +
               "{module: kbb2}, {module: obstacle}, {module: puma_kin},\n  {module: limits" +
               range + "},\n  {module: puma_joints}]\n");
    const network::Network built = build_network(scene, scene, arm, 400.0);
    auto limits = *built.find<network::Limits>();
    network::Signals signals;
    signals.joints = signals.rates = signals.mean_rates = network::Vec<network::any_size>::Zero(2);
    for (int i = 0; i < 2; ++i) {
      // From the lower end on: the distance at which the torque k (zone - distance) vanishes.
      signals.joints(i) = arm.links[static_cast<std::size_t>(i)].lower;
    }
    limits.read(signals);
    for (int i = 0; i < 2; ++i) found.of_joints.push_back(limits.torques()(i) / 2000.0);
  } catch (const SetupError& error) {
    found.refusal = error.what();
  }
  return found;
}

TEST(SceneNetwork, ALimitBeginsAtAnAngleOfATurningJointAndAtALengthOfASlidingOne) {
  const auto expect = [](const ArmModel& arm, const std::string& range, double first,
                         double second) {
    const Zones found = zones(arm, range);
    ASSERT_EQ(found.refusal, "");
    EXPECT_NEAR(found.of_joints[0], first, 1e-12) << range;
    EXPECT_NEAR(found.of_joints[1], second, 1e-12) << range;
  };
  const double degree = std::numbers::pi / 180.0;
  expect(mast(), "", 0.1, 0.1);
  expect(mast(), ", range: [50 mm, 3 deg]", 0.05, 3.0 * degree);
  expect(mast(), ", range: [0.2 m, 0.03 rad]", 0.2, 0.03);
  expect(two_joints(), ", range: 3 deg", 3.0 * degree, 3.0 * degree);
  expect(two_joints(), ", range: [3 deg, 0.2 rad]", 3.0 * degree, 0.2);
  ArmModel sliding = mast();
  sliding.links[1].type = JointType::prismatic;
  expect(sliding, ", range: 5 cm", 0.05, 0.05);
}

TEST(SceneNetwork, ALimitOfTheWrongKindIsRefusedWithItsLine) {
  const auto expect = [](const ArmModel& arm, const std::string& range, const std::string& part) {
    const std::string text = zones(arm, range).refusal;
    EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_EQ(text.find("scenes/test.yaml:9: "), 0U) << text;
  };
  expect(
      mast(), ", range: 0.1 rad",
      "'range' is '0.1 rad'; allowed: a length, 1e-06 to 1000 m, since the joint 'first' slides");
  expect(
      mast(), ", range: 50 mm",
      "'range' is '50 mm'; allowed: an angle, 1e-06 to 1000 rad, since the joint 'second' turns");
  expect(mast(), ", range: [3 deg, 3 deg]", "'range[0]' is '3 deg'; allowed: a length");
  expect(mast(), ", range: [50 mm, 50 mm]", "'range[1]' is '50 mm'; allowed: an angle");
  expect(two_joints(), ", range: 50 mm", "'range' is '50 mm'; allowed: an angle");
  expect(mast(), ", range: [50 mm]", "'range' has 1 entries; allowed: 2, one for each joint");
  expect(mast(), ", range: []", "'range' has 0 entries; allowed: 2");
  expect(two_joints(), ", range: 3 kg", "'range' is '3 kg'; allowed: 1 number, then the unit rad");
  expect(two_joints(), ", range: 3 4 deg", "allowed: 1 number");
  expect(two_joints(), ", range: 0 deg", "'range' is '0 deg'; allowed: 1e-06 to 1000 rad");
  expect(mast(), ", range: [2000 m, 3 deg]", "'range[0]' is '2000 m'; allowed: 1e-06 to 1000 m");
}

TEST(SceneNetwork, ObstaclesNeedTheModuleThroughWhichTheyAct) {
  EXPECT_NE(refusal("  - {module: torque_arm}\n  - {module: multiplex}\n  - {module: kbb2}\n"
                    "  - {module: puma_kin}\n  - {module: puma_joints}\n")
                .find("test.yaml:9: network: there are obstacles and no module 'obstacle'"),
            std::string::npos);
}

TEST(SceneNetwork, AWallThatIsTooStiffHasTheLineOfItsObstacle) {
  const SetupError error = located(parsed(base_scene), SetupError("wall too stiff: 'wall': so"));
  EXPECT_EQ(error.line(), 7) << error.what();
}

}  // namespace network_test
}  // namespace repel::scene
