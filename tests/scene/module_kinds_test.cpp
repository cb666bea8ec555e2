// SPDX-License-Identifier: BSD-3-Clause
#include <repel/scene/module_kinds.hpp>

#include <gtest/gtest.h>

#include <repel/base/setup_error.hpp>
#include <repel/network/modules.hpp>
#include <repel/scene/build_network.hpp>

#include "yaml_text.hpp"

namespace repel::scene {
namespace module_kinds_test {

using network::any_size;
using testing::base_scene;

/// A custom wall for the tool, used for its options.
struct Cushion {
  static constexpr network::Traits traits{.left = network::Space::tool,
                                          .right = network::Space::tool,
                                          .needs_flow = true,
                                          .keeps_flow = true,
                                          .walls = network::Walls::tool};
  bool reflected(const network::Equivalent<any_size>& behind,
                 network::Equivalent<any_size>& shown) noexcept {
    shown = behind;
    return true;
  }
  void incident(const network::PortState<any_size>& at_root,
                const network::Equivalent<any_size>& /*behind*/,
                network::PortState<any_size>& at_leaf) noexcept {
    at_leaf = at_root;
  }
  double softness = 0.0;
  std::string mood;
};

ModuleKinds kinds_with_cushion() {
  ModuleKinds kinds;
  kinds.add("cushion", [](const ModuleEntry& entry) {
    return Cushion{entry.number("softness", "mm/rad", 0.0, 1.0, 0.5),
                   entry.word("mood", {"calm", "wild"})};
  });
  return kinds;
}

Scene with_cushion(const std::string& options) {
  const std::string text = base_scene +
                           "network:\n  - {module: ground}\n  - {module: kbb2}\n"
                           "  - {module: cushion" +
                           options + "}\n  - {module: puma_kin}\n  - {module: puma_joints}\n";
  return parse(text, "scenes/test.yaml", kinds_with_cushion());
}

Cushion cushion_of(const Scene& scene) {
  const network::Network built = [&] {
    ArmModel arm;
    arm.links.resize(3);
    return build_network(scene, scene, arm, 400.0);
  }();
  return *built.find<Cushion>();
}

std::string refusal(const std::string& options) {
  try {
    (void)with_cushion(options);
  } catch (const SetupError& error) {
    return error.what();
  }
  return {};
}

TEST(ModuleKinds, OfAProgramAreReadLikeThoseOfTheLibrary) {
  const Cushion given = cushion_of(with_cushion(", softness: 20 mm/rad, mood: wild"));
  EXPECT_DOUBLE_EQ(given.softness, 0.02);
  EXPECT_EQ(given.mood, "wild");
  const Cushion silent = cushion_of(with_cushion(""));
  EXPECT_EQ(silent.softness, 0.5);
  EXPECT_EQ(silent.mood, "calm");
}

TEST(ModuleKinds, WhatTheReaderDoesNotAskForIsRefusedWithItsLine) {
  const auto expect = [](const std::string& options, const std::string& part) {
    const std::string text = refusal(options);
    EXPECT_NE(text.find(part), std::string::npos) << text;
    EXPECT_NE(text.find("scenes/test.yaml:11"), std::string::npos) << text;
  };
  expect(", softnes: 20 mm/rad", "softness");
  expect(", softness: 2 m/rad", "0 to 1 m/rad");
  expect(", softness: 2 kg", "m/rad");
  expect(", mood: sad", "calm");
}

TEST(ModuleKinds, AWordStandsForOneModule) {
  ModuleKinds kinds = kinds_with_cushion();
  const auto read = [](const ModuleEntry& /*entry*/) { return network::Visual(); };
  EXPECT_THROW(kinds.add("cushion", read), SetupError);
  EXPECT_THROW(kinds.add("kbb2", read), SetupError);
  kinds.add("pillow", read);
  EXPECT_EQ(kinds.words().back(), "pillow");
}

// A unit for which no quantity exists is a programming error, reported at once.
TEST(ModuleKinds, TheUnitIsOneThatFilesKnow) {
  ModuleKinds kinds;
  kinds.add("cushion", [](const ModuleEntry& entry) {
    return Cushion{entry.number("softness", "furlong", 0.0, 1.0, 0.5), ""};
  });
  EXPECT_THROW(
      (void)parse(base_scene + "network: [{module: cushion}]\n", "scenes/test.yaml", kinds),
      SetupError);
}

TEST(ModuleKinds, CanDependOnTheArm) {
  ModuleKinds kinds;
  kinds.add("own_joints", [](const ModuleEntry& /*entry*/) {
    return ReadModule{{}, [](const ArmModel& arm) {
                        return network::PumaJoints(static_cast<int>(arm.links.size()));
                      }};
  });
  const Scene scene = parse(base_scene +
                                "network: [{module: ground}, {module: kbb2}, {module: obstacle}, "
                                "{module: puma_kin}, {module: own_joints}]\n",
                            "scenes/test.yaml", kinds);
  ArmModel arm;
  arm.links.resize(5);
  EXPECT_EQ(build_network(scene, scene, arm, 400.0).find<network::PumaJoints>()->size(), 5);
}

TEST(ModuleKinds, ForceSensorTakesItsOptionsAndTheGravityOfTheArm) {
  const std::string text =
      base_scene +
      "network:\n  - {module: ground}\n  - {module: kbb2}\n  - {module: obstacle}\n"
      "  - {module: puma_kin}\n  - {module: force_sensor, gain: 60 %, cutoff: 3 Hz, force_range: "
      "90 N, torque_range: 9 N "
      "m, "
      "tare: 100 ms, mass: 2 kg, position: 0 0 50 mm}\n  - {module: puma_joints}\n";
  const Scene scene = parse(text, "scenes/test.yaml");
  const auto* options =
      std::any_cast<network::ForceSensorOptions>(&scene.network.modules[4].options);
  ASSERT_NE(options, nullptr);
  EXPECT_EQ(options->gain, 0.6);
  EXPECT_EQ(options->cutoff, 3.0);
  EXPECT_EQ(options->force_range, 90.0);
  EXPECT_EQ(options->torque_range, 9.0);
  EXPECT_EQ(options->tare, 0.1);
  EXPECT_EQ(options->mass, 2.0);
  EXPECT_EQ(options->p_TC, Vec3(0, 0, 0.05));
  ArmModel arm;
  arm.links.resize(3);
  arm.gravity_W = Vec3::Zero();
  network::ForceSensor sensor =
      *build_network(scene, scene, arm, 400.0).find<network::ForceSensor>();
  network::Signals signals = network::detail::neutral_signals(3, 0.0025);
  signals.is_measured = true;
  for (int tick = 0; tick < 200; ++tick) sensor.read(signals);
  EXPECT_EQ(sensor.force().force, Vec3::Zero()) << "without gravity the tool has no weight";
  EXPECT_THROW((void)parse(base_scene + "network:\n  - {module: force_sensor, gain: 0.8}\n",
                           "scenes/test.yaml"),
               SetupError);
}

TEST(ModuleKinds, SimulatedForceSensorHasTheErrorsOfTheScene) {
  std::string text = base_scene;
  const std::string before = "  start:";
  text.insert(text.find(before),
              "  sensor_errors: {force_noise: 1 N, torque_noise: 20 mN m, force_bias: 1 2 3 N, "
              "torque_bias: 0 0 1 N m, seed: 9}\n");
  const SensorErrors errors = parse(text, "scenes/test.yaml").robot.sensor;
  EXPECT_EQ(errors.force_noise, 1.0);
  EXPECT_EQ(errors.torque_noise, 0.02);
  EXPECT_EQ(errors.bias.force, Vec3(1, 2, 3));
  EXPECT_EQ(errors.bias.torque, Vec3(0, 0, 1));
  EXPECT_EQ(errors.seed, 9U);
  EXPECT_TRUE(parse(base_scene, "scenes/test.yaml").robot.sensor.none());
}

}  // namespace module_kinds_test
}  // namespace repel::scene
