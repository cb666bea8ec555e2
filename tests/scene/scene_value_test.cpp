// SPDX-License-Identifier: BSD-3-Clause
// The values of a scene in SI units, and the defaults of what it omits.
#include <clocale>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <repel/scene/build_network.hpp>

#include <scene/yaml_text.hpp>

namespace repel::scene {
namespace scene_value_test {

using testing::base_scene;
using testing::changed;
using testing::options;
using testing::parsed;

constexpr double pi = std::numbers::pi;

ForceLaw law_with(const std::string& key_and_value) {
  return parsed(base_scene + "laws: {default: {" + key_and_value + "}}\n").obstacles[0].law;
}

TEST(SceneValue, LengthsMayBeInMetresCentimetresOrMillimetres) {
  EXPECT_EQ(law_with("range: 0.025 m").range, 0.025);
  EXPECT_EQ(law_with("range: 2.5 cm").range, 0.025);
  EXPECT_EQ(law_with("range: 25 mm").range, 0.025);
}

TEST(SceneValue, ForcesMayBeInNewtonOrKilonewton) {
  EXPECT_EQ(law_with("surface_force: 120 N").surface_force, 120.0);
  EXPECT_EQ(law_with("surface_force: 0.12 kN").surface_force, 120.0);
}

TEST(SceneValue, StiffnessesAndDampingsMayBeInMultiples) {
  const auto gains = [](const std::string& text) {
    return options<network::Kbb2Options>(
        parsed(base_scene + "network: [{module: kbb2, " + text + "}]\n"));
  };
  EXPECT_EQ(gains("stiffness: 3 N/mm").stiffness, 3000.0);
  EXPECT_EQ(gains("stiffness: 3 kN/m").stiffness, 3000.0);
  EXPECT_EQ(gains("stiffness: 3000 N/m").stiffness, 3000.0);
  EXPECT_EQ(gains("damping: 0.2 kN s/m").damping, 200.0);
  EXPECT_EQ(gains("angular_stiffness: 15 N m/rad").angular_stiffness, 15.0);
  EXPECT_EQ(gains("angular_damping: 2 N m s/rad").angular_damping, 2.0);
  EXPECT_EQ(gains("torque_limit: 500 mN m").torque_limit, 0.5);
}

TEST(SceneValue, TimesRatesAndBudgetsHaveTheirUnits) {
  const Scene scene = parsed(base_scene +
                             "rate: 0.5 kHz\n"
                             "budget: {wall: 0.5 ms, work: 20000, threads: 2, max_age: 40}\n"
                             "network: [{module: spaceball, time_constant: 40 ms, saturation: 30 "
                             "cm/s}]\n");
  const auto ball = options<network::SpaceballOptions>(scene);
  EXPECT_EQ(scene.rate_hz, 500.0);
  EXPECT_DOUBLE_EQ(scene.budget.wall_us, 500.0);
  EXPECT_EQ(scene.budget.work_units, 20000);
  EXPECT_EQ(scene.budget.threads, 2);
  EXPECT_EQ(scene.budget.max_age, 40);
  EXPECT_EQ(ball.time_constant, 0.04);
  EXPECT_EQ(ball.saturation, 0.3);
}

TEST(SceneValue, AnglesMayBeInDegreesOrRadians) {
  const auto degrees = parsed(base_scene).robot.start;
  ASSERT_EQ(degrees.size(), 6U);
  EXPECT_DOUBLE_EQ(degrees[1], pi / 4);
  EXPECT_DOUBLE_EQ(degrees[2], pi);
  EXPECT_EQ(parsed(changed("0 45 180 0 45 0 deg", "0 1.5 rad")).robot.start[1], 1.5);
}

TEST(SceneValue, StartsOfJointsThatSlideAreLengths) {
  const auto robot = parsed(changed("0 45 180 0 45 0 deg", "[50 mm, 0 90 deg, 1 rad]")).robot;
  ASSERT_EQ(robot.start.size(), 4U);
  EXPECT_EQ(robot.start[0], 0.05);
  EXPECT_DOUBLE_EQ(robot.start[2], pi / 2);
  EXPECT_EQ(robot.start_types[0], JointType::prismatic);
  EXPECT_EQ(robot.start_types[3], JointType::revolute);
  EXPECT_THROW((void)parsed(changed("0 45 180 0 45 0 deg", "[50 kg]")), SetupError);
}

TEST(SceneValue, APayloadHasAMassAPlaceAndIsKnownUnlessItSaysOtherwise) {
  const auto robot = [](const std::string& payload) {
    return parsed(changed("tool:", payload + "tool:")).robot;
  };
  EXPECT_EQ(robot("").payload.mass, 0.0);
  const auto grams = robot("  payload: {mass: 500 g}\n");
  EXPECT_EQ(grams.payload.mass, 0.5);
  EXPECT_EQ(grams.payload.p_TC, Vec3(0, 0, 0));
  EXPECT_TRUE(grams.payload_known);
  const auto placed = robot("  payload: {mass: 100 kg, position: 1 -2 30 cm, known: no}\n");
  EXPECT_EQ(placed.payload.mass, 100.0);
  EXPECT_EQ(placed.payload.p_TC, Vec3(0.01, -0.02, 0.3));
  EXPECT_FALSE(placed.payload_known);
  EXPECT_TRUE(robot("  payload: {mass: 0 kg, known: yes}\n").payload_known);
}

TEST(SceneValue, JointsToHoldAreAListOrAMapToAnglesAndLengths) {
  const auto holds = [](const std::string& text) {
    return parsed(changed("tool:", "  hold: " + text + "\ntool:")).robot.hold;
  };
  EXPECT_TRUE(parsed(base_scene).robot.hold.empty());
  const auto named = holds("[a, b]");
  ASSERT_EQ(named.size(), 2U);
  EXPECT_EQ(named[1].joint, "b");
  EXPECT_FALSE(named[1].position.has_value());
  const auto placed = holds("{finger: 20 mm, wrist: -90 deg}");
  ASSERT_EQ(placed.size(), 2U);
  EXPECT_EQ(placed[0].joint, "finger");
  EXPECT_EQ(placed[0].position, 0.02);
  EXPECT_EQ(placed[0].type, JointType::prismatic);
  EXPECT_DOUBLE_EQ(placed[1].position.value(), -pi / 2);
  EXPECT_EQ(placed[1].type, JointType::revolute);
  for (const char* wrong : {"finger", "{finger: 20}", "{finger: 20 kg}", "{finger: 1 2 mm}"}) {
    EXPECT_THROW((void)holds(wrong), SetupError) << wrong;
  }
}

TEST(SceneValue, PackagesAreFoldersRelativeToTheScene) {
  const auto packages = [](const std::string& text) {
    return parsed(changed("tool:", "  packages: " + text + "\ntool:")).robot.packages;
  };
  EXPECT_EQ(packages("../robots"), std::vector<std::string>{"robots"});
  EXPECT_EQ(packages("[../robots, ../docs]"), (std::vector<std::string>{"robots", "docs"}));
  EXPECT_THROW((void)packages("../no_such_folder"), SetupError);
  EXPECT_THROW((void)packages("../robots/puma560.urdf"), SetupError);
}

TEST(SceneValue, AnObstacleMayMove) {
  EXPECT_FALSE(parsed(base_scene).obstacles[0].motion.has_value());
  const Scene scene =
      parsed(changed("size: 1 2 3 m", "size: 1 2 3 m, motion: {along: 0 20 0 cm, duration: 8 s}"));
  ASSERT_TRUE(scene.obstacles[0].motion.has_value());
  EXPECT_EQ(scene.obstacles[0].motion->along_W.y(), 0.2);
  EXPECT_EQ(scene.obstacles[0].motion->duration, 8.0);
  EXPECT_THROW((void)parsed(changed("size: 1 2 3 m", "size: 1 2 3 m, motion: {duration: 8 s}")),
               SetupError);
}

TEST(SceneValue, APartnerIsAStationOfItsOwn) {
  const Scene scene = parsed(
      base_scene +
      "partners:\n  - name: other\n    law: default\n    robot: {urdf: ../robots/puma560.urdf, "
      "start: 0 0 deg, self_law: default}\n    tool: [{name: ball, shape: sphere, radius: 10 "
      "mm}]\n");
  ASSERT_EQ(scene.partners.size(), 1U);
  EXPECT_EQ(scene.partners[0].name, "other");
  EXPECT_EQ(scene.partners[0].robot.start.size(), 2U);
  EXPECT_TRUE(scene.partners[0].robot.self_law.has_value());
  EXPECT_FALSE(scene.robot.self_law.has_value());
  EXPECT_TRUE(scene.partners[0].script.empty());
  EXPECT_TRUE(feels_links(scene.partners[0]));
}

TEST(SceneValue, RollPitchYawTurnAboutFixedAxesInThatOrder) {
  const Scene scene = parsed(changed("size: 1 2 3 m", "size: 1 2 3 m, rpy: 90 0 90 deg"));
  // Roll maps y to z; yaw, about the fixed z, leaves it there. Roll leaves x, yaw maps it to y.
  const Mat3 R = scene.obstacles[0].X_WP.linear();
  EXPECT_NEAR((R * Vec3::UnitY() - Vec3::UnitZ()).norm(), 0.0, 1e-15);
  EXPECT_NEAR((R * Vec3::UnitX() - Vec3::UnitY()).norm(), 0.0, 1e-15);
}

TEST(SceneValue, EveryShapeHasTheSizeItStates) {
  const auto reach = [](const std::string& shape) {
    return parsed(changed("shape: box, size: 1 2 3 m", shape)).obstacles[0].shape.reach();
  };
  EXPECT_NEAR(reach("shape: box, size: 2 4 4 m"), 3.0, 1e-12);
  EXPECT_NEAR(reach("shape: sphere, radius: 2 m"), 2.0, 1e-12);
  EXPECT_NEAR(reach("shape: capsule, radius: 2 m, length: 6 m"), 5.0, 1e-12);
  EXPECT_NEAR(reach("shape: cylinder, radius: 3 m, length: 8 m"), 5.0, 1e-12);
  EXPECT_NEAR(reach("shape: cone, radius: 3 m, length: 8 m"), 5.0, 1e-12);
  EXPECT_NEAR(reach("shape: ellipsoid, size: 2 6 4 m"), 3.0, 1e-12);
  EXPECT_NEAR(reach("shape: hull, points: [0 0 0 m, 3 0 0 m, 0 400 0 cm, 0 0 1 m]"), 4.0, 1e-12);
}

TEST(SceneValue, PosesOfBaseToolAndPartsAreRead) {
  const Scene scene = parsed(changed("20 mm}", "20 mm, position: 1 2 3 mm}") + "name: a room\n");
  EXPECT_EQ(scene.name, "a room");
  EXPECT_EQ(scene.tool[0].X_BP.translation(), Vec3(0.001, 0.002, 0.003));
  const Scene moved = parsed(
      changed("tool:", "  base: {position: 1 0 0 m}\n  tool_frame: {position: 0 0 15 cm}\ntool:"));
  EXPECT_EQ(moved.robot.X_WB.translation(), Vec3(1.0, 0.0, 0.0));
  EXPECT_EQ(moved.robot.X_LT.translation(), Vec3(0.0, 0.0, 0.15));
}

TEST(SceneValue, ASceneThatSaysLittleHasTheStatedDefaults) {
  const Scene scene = parsed(base_scene);
  EXPECT_EQ(scene.name, "test");
  EXPECT_EQ(scene.file, "scenes/test.yaml");
  EXPECT_EQ(scene.robot.urdf, "robots/puma560.urdf");
  EXPECT_FALSE(scene.robot.is_mjcf);
  EXPECT_EQ(scene.rate_hz, 400.0);
  EXPECT_EQ(scene.tool[0].kind, "sphere");
  EXPECT_EQ(scene.obstacles[0].law.range, 0.02);
  EXPECT_EQ(scene.obstacles[0].law.surface_force, 100.0);
  EXPECT_EQ(scene.obstacles[0].law.damping, 50.0);
  EXPECT_TRUE(std::isinf(scene.obstacles[0].law.ceiling));
  EXPECT_TRUE(scene.script.empty());
  EXPECT_EQ(scene.budget.wall_us, 0.0);
  EXPECT_EQ(scene.budget.work_units, 0);
  EXPECT_EQ(scene.budget.threads, 0);
  EXPECT_EQ(scene.budget.max_age, 100);
}

TEST(SceneValue, AnArmMayStartInsideAnObstacleWhereTheSceneSaysSo) {
  const auto read = [](const std::string& line) { return parsed(base_scene + line).start_inside; };
  EXPECT_EQ(read(""), StartInside::refuse);
  EXPECT_EQ(read("start_inside: refuse\n"), StartInside::refuse);
  EXPECT_EQ(read("start_inside: push_out\n"), StartInside::push_out);
}

TEST(SceneValue, AToolHasAMostSpeed) {
  const auto read = [](const std::string& line) { return parsed(base_scene + line).tool_speed; };
  EXPECT_EQ(read(""), 0.25);
  EXPECT_EQ(read("tool_speed: 100 mm/s\n"), 0.1);
  EXPECT_EQ(read("tool_speed: 0.001 m/s\n"), 0.001);
  EXPECT_EQ(read("tool_speed: 10 m/s\n"), 10.0);
}

TEST(SceneValue, ASceneMayMeasureOverlapsInAnotherWay) {
  const auto read = [](const std::string& lines) { return parsed(base_scene + lines); };
  EXPECT_EQ(read("").measure, Measure::deepest_point);
  EXPECT_EQ(read("").levels, 8);
  EXPECT_EQ(read("measure: deepest_point\n").measure, Measure::deepest_point);
  EXPECT_EQ(read("measure: reduction\n").measure, Measure::reduction);
  EXPECT_EQ(read("measure: exact\n").measure, Measure::exact);
  EXPECT_EQ(read("levels: 1\n").levels, 1);
  const Scene scene = read("measure: reduction\nlevels: 64\n");
  EXPECT_EQ(scene.levels, 64);
  EXPECT_EQ(scene.obstacles[0].shape.reduction().levels, 1) << "reduced by whoever needs it";
}

TEST(SceneValue, AnObstacleTakesTheLawItNamesOrTheDefault) {
  const Scene scene = parsed(base_scene +
                             "  - {name: skin, shape: sphere, radius: 1 m, law: soft}\n"
                             "laws: {default: {range: 1 cm}, soft: {ceiling: 5 N}}\n");
  EXPECT_EQ(scene.obstacles[0].law.range, 0.01);
  EXPECT_EQ(scene.obstacles[1].law.range, 0.02);
  EXPECT_EQ(scene.obstacles[1].law.ceiling, 5.0);
}

TEST(SceneValue, AnObstacleMayBePassable) {
  const Scene scene = parsed(base_scene +
                             "  - {name: skin, shape: sphere, radius: 1 m, law: soft}\n"
                             "laws: {default: {passable: no, ceiling: 1 kN}, soft: {ceiling: 5 N, "
                             "passable: yes, depth: 3 cm, plateau: 0.8}}\n");
  EXPECT_FALSE(scene.obstacles[0].law.passable);
  EXPECT_TRUE(scene.obstacles[1].law.passable);
  EXPECT_EQ(scene.obstacles[1].law.depth, 0.03);
  EXPECT_EQ(scene.obstacles[1].law.plateau, 0.8);
}

TEST(SceneValue, ALawIsGivenAtThePartUnlessItSaysTheTool) {
  const Scene scene =
      parsed(base_scene +
             "  - {name: post, shape: sphere, radius: 1 m, law: scaled}\n"
             "  - {name: skin, shape: sphere, radius: 1 m, law: soft}\n"
             "laws: {scaled: {given_at: tool}, soft: {ceiling: 5 N, passable: yes, given_at: "
             "part}}\n");
  EXPECT_EQ(scene.obstacles[0].law.given_at, GivenAt::part);
  EXPECT_EQ(scene.obstacles[1].law.given_at, GivenAt::tool);
  EXPECT_EQ(scene.obstacles[1].law.surface_force, 100.0) << "scaled by the cell";
  EXPECT_EQ(scene.obstacles[2].law.given_at, GivenAt::part);
}

TEST(SceneValue, AWallIsSoftUnlessItSaysHard) {
  const Scene scene = parsed(base_scene +
                             "  - {name: post, shape: sphere, radius: 1 m, law: firm}\n"
                             "  - {name: pad, shape: sphere, radius: 1 m, law: pad}\n"
                             "laws: {firm: {hold: hard}, pad: {hold: soft}}\n");
  EXPECT_EQ(scene.obstacles[0].law.hold, HoldKind::soft);
  EXPECT_EQ(scene.obstacles[1].law.hold, HoldKind::hard);
  EXPECT_EQ(scene.obstacles[2].law.hold, HoldKind::soft);
}

TEST(SceneValue, TheScriptIsReadPhaseByPhase) {
  const Scene scene =
      parsed(base_scene +
             "script:\n"
             "  - {name: a, device: spaceball, duration: 2 s, linear: 1 2 3 mm/s, angular: 0 0 180 "
             "deg/s}\n"
             "  - {name: b, device: torque_arm, duration: 1 s, frame: tool, direction: 0 3 4, "
             "lever: 90 deg/s}\n");
  ASSERT_EQ(scene.script.size(), 2U);
  EXPECT_EQ(scene.script[0].master, network::Master::spaceball);
  EXPECT_EQ(scene.script[0].frame, network::PhaseFrame::world);
  EXPECT_EQ(scene.script[0].duration, 2.0);
  EXPECT_EQ(scene.script[0].rates.linear, Vec3(0.001, 0.002, 0.003));
  EXPECT_DOUBLE_EQ(scene.script[0].rates.angular.z(), pi);
  EXPECT_EQ(scene.script[1].name, "b");
  EXPECT_EQ(scene.script[1].master, network::Master::torque_arm);
  EXPECT_EQ(scene.script[1].frame, network::PhaseFrame::tool);
  EXPECT_NEAR((scene.script[1].direction - Vec3(0.0, 0.6, 0.8)).norm(), 0.0, 1e-15);
  EXPECT_DOUBLE_EQ(scene.script[1].lever_rate, pi / 2);
}

TEST(SceneValue, ALeverMayTurnTheTool) {
  const std::string rest = ", device: torque_arm, duration: 1 s, direction: 0 0 1, lever: 1 rad/s";
  const Scene scene =
      parsed(base_scene + "script:\n  - {name: a" + rest + "}\n  - {name: b" + rest +
             ", pitch: -5 mm/rad}\n  - {name: c" + rest + ", axis: 0 20 0 mm}\n");
  ASSERT_EQ(scene.script.size(), 3U);
  EXPECT_FALSE(scene.script[0].screw.has_value());
  ASSERT_TRUE(scene.script[1].screw && scene.script[2].screw);
  EXPECT_EQ(scene.script[1].screw->pitch, -0.005);
  EXPECT_EQ(scene.script[1].screw->axis, Vec3::Zero());
  EXPECT_EQ(scene.script[2].screw->pitch, 0.0);
  EXPECT_EQ(scene.script[2].screw->axis, Vec3(0.0, 0.02, 0.0));
}

TEST(SceneValue, ASecondHandHasRatesOfItsOwn) {
  const Scene scene =
      parsed(base_scene +
             "script:\n"
             "  - {name: a, device: six_axes, duration: 1 s, second: {linear: 1 0 0 m/s}}\n"
             "  - {name: b, device: torque_arm, duration: 1 s, direction: 0 0 1, lever: 1 rad/s, "
             "second: {angular: 0 2 0 rad/s}}\n");
  EXPECT_EQ(scene.script[0].second.linear, Vec3(1, 0, 0));
  EXPECT_EQ(scene.script[0].rates.linear, Vec3(0, 0, 0));
  EXPECT_EQ(scene.script[1].second.angular, Vec3(0, 2, 0));
}

TEST(SceneValue, ADeviceMayFailByRatesThatAreNotANumber) {
  const Scene scene = parsed(
      base_scene +
      "script:\n"
      "  - {name: a, device: spaceball, duration: 1 s, linear: nan 0 0 mm/s, angular: 0 nan 0 "
      "rad/s}\n"
      "  - {name: b, device: torque_arm, duration: 1 s, direction: 1 0 0, lever: nan rad/s}\n");
  EXPECT_TRUE(std::isnan(scene.script[0].rates.linear.x()));
  EXPECT_TRUE(std::isnan(scene.script[0].rates.angular.y()));
  EXPECT_TRUE(std::isnan(scene.script[1].lever_rate));
}

TEST(SceneValue, AnEmptyRoomIsAllowedWhenItSaysSo) {
  const Scene scene =
      parsed(changed("obstacles:\n  - {name: wall, shape: box, size: 1 2 3 m}", "obstacles: []"));
  EXPECT_TRUE(scene.obstacles.empty());
}

TEST(SceneValue, NumbersAreReadAlikeInEveryLocale) {
  const std::string before = std::setlocale(LC_ALL, nullptr);
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"}) {
    if (std::setlocale(LC_ALL, name)) break;  // if none is installed, "C" is tested
  }
  EXPECT_EQ(law_with("range: 2.5 cm").range, 0.025);
  std::setlocale(LC_ALL, before.c_str());
}

}  // namespace scene_value_test
}  // namespace repel::scene
