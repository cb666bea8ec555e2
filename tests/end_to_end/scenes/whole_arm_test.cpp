// SPDX-License-Identifier: BSD-3-Clause
// Walls act on the links of the arm as on the tool.
#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace whole_arm_test {

using nlohmann::json;

/// A post beside the forearm, and a tool that is moved past it at 100 mm/s.
std::string scene_with(const std::string& network, const std::string& links = "") {
  return robot_text(REPEL_SOURCE "/robots/puma560.urdf", links) +
         "laws:\n  default: {range: 40 mm, surface_force: 40 N, damping: 1 N s/m}\n"
         "obstacles:\n"
         "  - {name: post, shape: capsule, radius: 20 mm, length: 0.6 m, position: 0.3 0.04 0.9 "
         "m}\n" +
         network +
         "script:\n"
         "  - {name: swing, device: spaceball, duration: 3 s, linear: 0 100 0 mm/s}\n";
}

TEST(WholeArm, StopsWhereItsForearmMeetsAPostAndTheOperatorFeelsIt) {
  const Folder folder;
  const std::string scene = folder.with("post.yaml", scene_with(""));
  const Ending ending =
      teleop(quoted(scene) + " --fast --seconds 5 --log " + quoted(folder / "log.csv") +
             " --report " + quoted(folder / "r.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const json report = report_of(folder / "r.json");
  const json& post = report.at("obstacles").at(0);
  EXPECT_EQ(post.at("body"), "link_3") << report.at("obstacles");
  EXPECT_GT(post.at("peak_force_n"), 20.0);
  EXPECT_GT(post.at("nearest_m"), -0.01);
  EXPECT_TRUE(ending.says("(link_3)")) << ending;
  for (const json& module : report.at("modules")) {
    if (!module.at("claims_passive").get<bool>()) continue;
    EXPECT_LE(module.at("deficit"), 1e-9) << module;
  }
  const Columns log = columns_of(folder / "log.csv");
  expect_finite_forces(log);
  const auto& y = log.at("y_m");
  EXPECT_LT(std::abs(y.back() - y[1600]), 0.001) << "it must have stopped";
  EXPECT_GT(std::abs(log.at("coupling_fy_n").back()), 10.0) << "the hand pushes against it";
  EXPECT_EQ(log.at("virtual_fy_n").back(), 0.0) << "nothing is near the tool";
}

TEST(WholeArm, WithoutTheModuleTheToolAloneFeelsTheWallsAndTheReportSaysSo) {
  const Folder folder;
  const std::string network =
      "network: [{module: torque_arm}, {module: multiplex}, {module: spaceball}, {module: kbb2}, "
      "{module: obstacle}, {module: puma_kin}, "
      "{module: puma_joints}]\n";
  const std::string scene = folder.with("post.yaml", scene_with(network));
  const Ending ending =
      teleop(quoted(scene) + " --fast --seconds 4 --report " + quoted(folder / "r.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_EQ(report_of(folder / "r.json").at("pairs"), 1);
  EXPECT_TRUE(ending.says("links of the arm")) << ending;
}

/// A UR5 that swings its upper arm against a post near its base, driven at the tool.
std::string swing_scene(const std::string& given_at) {
  return "robot: {urdf: " REPEL_SOURCE
         "/bench/arms/ur5.urdf, start: 0 -30 60 -120 -90 0 deg}\n"
         "tool: [{name: rod, shape: capsule, radius: 15 mm, length: 60 mm}]\n"
         "laws: {default: {range: 20 mm, surface_force: 120 N, damping: 200 N s/m" +
         given_at +
         "}}\n"
         "obstacles: [{name: post, shape: capsule, radius: 30 mm, length: 0.6 m, position: 0.14 "
         "0.22 0.3 m}]\n"
         "network: [{module: torque_arm}, {module: multiplex}, {module: spaceball}, "
         "{module: kbb2, stiffness: 3 N/mm, damping: 300 N s/m, force_limit: 120 N}, "
         "{module: obstacle}, {module: puma_kin}, {module: arm_obstacle}, {module: limits}, "
         "{module: puma_joints}]\n"
         "script: [{name: swing, device: spaceball, duration: 6 s, linear: 0 100 0 mm/s}]\n";
}

/// The report on the post, and the warnings of the run.
std::pair<json, json> swing(const std::string& given_at, const std::string& says) {
  const Folder folder;
  const std::string scene = folder.with("swing.yaml", swing_scene(given_at));
  const Ending ending =
      teleop(quoted(scene) + " --fast --seconds 8 --report " + quoted(folder / "r.json"));
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says(says)) << ending;
  const json report = report_of(folder / "r.json");
  return {report.at("obstacles").at(0), report.at("warnings")};
}

TEST(WholeArm, APostNearTheBaseIsEnteredFarLessWithALawGivenAtTheTool) {
  const auto [as_before, warnings] = swing("", "law given at the part: 120 N at the part, 3");
  EXPECT_GT(as_before.at("deepest_m"), 0.04) << as_before;
  const json& weak = as_before.at("link_laws").at(0);
  EXPECT_EQ(weak.at("body"), "upper_arm_link");
  EXPECT_EQ(weak.at("given_at"), "part");
  EXPECT_EQ(weak.at("surface_force_at_part_n"), 120.0);
  const double leverage = weak.at("leverage");
  EXPECT_GT(leverage, 3.0) << "the tool reaches 0.95 m, the post is 0.29 m from the first axis";
  EXPECT_LT(leverage, 3.6);
  EXPECT_NEAR(weak.at("surface_force_at_tool_n").get<double>(), 120.0 / leverage, 1e-6);
  EXPECT_NEAR(weak.at("peak_force_at_tool_n").get<double>() * leverage, weak.at("peak_force_n"),
              1e-6);
  ASSERT_EQ(warnings.size(), 1U) << warnings;
  const std::string warning = warnings[0];
  EXPECT_NE(warning.find("the law of 'post' is given at the part"), std::string::npos) << warning;
  EXPECT_NE(warning.find("pushes with up to 120 N"), std::string::npos) << warning;

  const auto [scaled, none] = swing(", given_at: tool", "law given at the tool: 3");
  EXPECT_LT(scaled.at("deepest_m").get<double>(), 0.3 * as_before.at("deepest_m").get<double>());
  EXPECT_EQ(scaled.at("link_laws").at(0).at("given_at"), "tool");
  EXPECT_NEAR(scaled.at("link_laws").at(0).at("leverage").get<double>(), leverage, 1e-9);
  EXPECT_NEAR(scaled.at("link_laws").at(0).at("surface_force_at_tool_n").get<double>(), 120.0,
              1e-6);
  EXPECT_TRUE(none.empty()) << none;
}

// With the leverage of the tool, the hand pressed the upper arm 47 mm into the post.
TEST(WholeArm, AHardPostIsNotEnteredWhateverTheLeverage) {
  const Folder folder;
  const std::string scene = folder.with("swing.yaml", swing_scene(""));
  const Ending ending = teleop(quoted(scene) + " --fast --seconds 8 --walls hard --report " +
                               quoted(folder / "r.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const json report = report_of(folder / "r.json");
  const json& post = report.at("obstacles").at(0);
  EXPECT_EQ(post.at("hold"), "hard");
  EXPECT_LT(post.at("deepest_m"), 1e-4) << post;
  EXPECT_GT(post.at("withstood_n"), 100.0) << post;
  EXPECT_FALSE(report.at("status_ticks").contains("hold_lost")) << report.at("status_ticks");
  EXPECT_GE(report.at("hold_margin_m"), 0.0) << "it was proven all the time";
  EXPECT_LT(report.at("hold_margin_m"), 1e-3);
  EXPECT_EQ(report.at("hold_gaps_left_out"), 0);
  EXPECT_TRUE(ending.says("hard walls             stopping proven")) << ending;
}

/// The robot of the repository, with a gripper on its flange.
std::string robot_with_gripper() {
  std::string urdf = text_of(REPEL_SOURCE "/robots/puma560.urdf");
  const std::string more =
      "<link name='stator'/><link name='mover'><inertial><mass value='0.1'/><inertia ixx='1e-4' "
      "ixy='0' ixz='0' iyy='1e-4' iyz='0' izz='1e-4'/></inertial></link>"
      "<joint name='mount' type='fixed'><parent link='flange'/><child link='stator'/></joint>"
      "<joint name='gripper' type='revolute'><parent link='stator'/><child link='mover'/>"
      "<axis xyz='1 0 0'/><limit lower='-2' upper='0' velocity='1' effort='1'/></joint>";
  return urdf.replace(urdf.rfind("</robot>"), 0, more);
}

TEST(WholeArm, HoldsTheGripperWhereTheSceneSaysAndNamesItInTheReport) {
  const Folder folder;
  (void)folder.with("gripper.urdf", robot_with_gripper());
  const std::string scene =
      folder.with("gripper.yaml", robot_text("gripper.urdf", "  hold: {gripper: -90 deg}\n") +
                                      table_text() + push_text());
  const Ending ending =
      teleop(quoted(scene) + " --fast --seconds 2 --report " + quoted(folder / "r.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const json held = report_of(folder / "r.json").at("held_joints");
  ASSERT_EQ(held.size(), 1U) << held;
  EXPECT_EQ(held[0].at("name"), "gripper");
  EXPECT_EQ(held[0].at("unit"), "rad");
  EXPECT_NEAR(held[0].at("position").get<double>(), -1.5707963, 1e-6);
  EXPECT_TRUE(ending.says("gripper at -90.00 deg")) << ending;
  EXPECT_GT(report_of(folder / "r.json").at("peak_force_n"), 10.0);
}

TEST(WholeArm, OfTheDefaultSceneIsLeftOutOnRequest) {
  const Folder folder;
  for (const auto& [option, pairs] : {std::pair{"", 120}, {"--tool-alone ", 32}}) {
    const Ending ending = teleop(std::string("anderson_4x8 --fast --seconds 1 ") + option +
                                 "--report " + quoted(folder / "r.json"));
    ASSERT_EQ(ending.status, 0) << ending;
    EXPECT_EQ(report_of(folder / "r.json").at("pairs"), pairs);
    EXPECT_EQ(ending.says("links of the arm"), pairs == 32) << ending;
  }
}

TEST(WholeArm, LinksThatAreNoneAreRefused) {
  const Folder folder;
  const std::string text = scene_with("", "  links: [link_3, tail]\n");
  const Ending ending = teleop(quoted(folder.with("post.yaml", text)) + " --fast --seconds 1");
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("'tail' is no moving link")) << ending;
}

/// A post at the start of the forearm.
std::string inside_scene(const std::string& law, const std::string& more) {
  return robot_text(REPEL_SOURCE "/robots/puma560.urdf", "") + "laws: {default: " + law +
         "}\nobstacles: [{name: post, shape: capsule, radius: 20 mm, length: 0.6 m, "
         "position: 0.3 -0.15 0.9 m}]\n" +
         more;
}

constexpr const char* solid = "{range: 40 mm, surface_force: 40 N, damping: 1 N s/m}";

TEST(WholeArm, AStartInsideAnObstacleIsRefusedAndThePartAndWhatToDoAreNamed) {
  const Folder folder;
  for (const char* more : {"", "start_inside: refuse\n"}) {
    const std::string scene = folder.with("inside.yaml", inside_scene(solid, more));
    const Ending ending = teleop(quoted(scene) + " --fast --seconds 0.1");
    EXPECT_EQ(ending.status, 1) << ending;
    EXPECT_TRUE(ending.says("inside.yaml: 'link_3_0' ")) << ending;
    EXPECT_TRUE(ending.says("starts inside 'post'")) << ending;
    EXPECT_TRUE(ending.says(" mm deep or more")) << ending;
    EXPECT_TRUE(ending.says("another 'start', or 'start_inside: push_out'")) << ending;
  }
}

TEST(WholeArm, AStartInsideAnObstacleIsAWarningWhereItIsToBePushedOut) {
  const Folder folder;
  const std::string scene =
      folder.with("inside.yaml", inside_scene(solid, "start_inside: push_out\n"));
  const Ending ending = teleop(quoted(scene) + " --fast --seconds 0.1");
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_TRUE(ending.says("starts inside 'post'")) << ending;
}

TEST(WholeArm, AStartInsideWhatMayBeEnteredIsNoneToSpeakOf) {
  const Folder folder;
  const std::string scene = folder.with(
      "inside.yaml",
      inside_scene("{range: 40 mm, surface_force: 40 N, damping: 1 N s/m, passable: yes, "
                   "ceiling: 10 N}",
                   ""));
  const Ending ending = teleop(quoted(scene) + " --fast --seconds 0.1");
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_FALSE(ending.says("starts inside")) << ending;
}

/// A redundant arm with its elbow out to the side, a bar that moves 150 mm towards the elbow and
/// back, and an idle operator.
std::string elbow_scene(const std::string& posture = "") {
  return "robot:\n  urdf: " REPEL_SOURCE
         "/robots/long_reach.urdf\n"
         "  base: {position: 0 0 4 m}\n"
         "  start: [1 m, 0 0.6 -1.2 0 0.6 0 rad]\n  tool_frame: {position: 0 0 100 mm}\n"
         "tool: [{name: rod, shape: capsule, radius: 15 mm, length: 60 mm}]\n"
         "laws:\n  default: {range: 50 mm, surface_force: 200 N, damping: 100 N s/m}\n"
         "obstacles:\n"
         "  - {name: bar, shape: box, size: 0.1 1 0.1 m, position: 1.05 0 1.56 m, "
         "motion: {along: -0.15 0 0 m, duration: 8 s}}\n"
         "network:\n  - {module: ground}\n  - {module: spaceball}\n"
         "  - {module: kbb2, stiffness: 10 N/mm, damping: 1 kN s/m, force_limit: 600 N, "
         "angular_stiffness: 400 N m/rad, angular_damping: 20 N m s/rad, torque_limit: 40 N m}\n"
         "  - {module: obstacle, gain_check: warning}\n  - {module: puma_kin}\n"
         "  - {module: arm_obstacle}\n  - {module: limits}\n" +
         posture + "  - {module: puma_joints}\n";
}

// Seven joints and a tool with six degrees of freedom: a force on the elbow folds the arm, and the
// coupling keeps the tool in place.
TEST(WholeArm, GivesWayAtItsElbowWhileTheToolStaysWhereTheArmHasAJointToSpare) {
  const Folder folder;
  const std::string scene = folder.with("elbow.yaml", elbow_scene());
  const Ending ending =
      teleop(quoted(scene) + " --fast --seconds 6 --log " + quoted(folder / "log.csv") +
             " --report " + quoted(folder / "r.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const json report = report_of(folder / "r.json");
  EXPECT_GT(report.at("nearest_m"), 0.0) << "the bar must not reach the arm";
  const Columns log = columns_of(folder / "log.csv");
  const auto& elbow = log.at("q4_rad");
  EXPECT_GT(*std::max_element(elbow.begin(), elbow.end()) - elbow.front(), 0.1)
      << "the elbow must have moved";
  const auto moved = [&](std::size_t tick) {
    return std::hypot(log.at("x_m")[tick] - log.at("x_m")[0],
                      log.at("y_m")[tick] - log.at("y_m")[0],
                      log.at("z_m")[tick] - log.at("z_m")[0]);
  };
  for (std::size_t tick = 0; tick < elbow.size(); ++tick) ASSERT_LT(moved(tick), 0.01) << tick;
  EXPECT_LT(moved(elbow.size() - 1), 0.002) << "with the bar at rest";
}

TEST(WholeArm, BringsItsElbowBackWhereAPostureSaysSo) {
  const Folder folder;
  const auto left_after = [&](const std::string& posture) {
    const std::string scene = folder.with("elbow.yaml", elbow_scene(posture));
    const Ending ending =
        teleop(quoted(scene) + " --fast --seconds 8 --log " + quoted(folder / "log.csv") +
               " --report " + quoted(folder / "r.json"));
    EXPECT_EQ(ending.status, 0) << ending;
    const Columns log = columns_of(folder / "log.csv");
    return log.at("q4_rad").back() - log.at("q4_rad").front();
  };
  EXPECT_GT(left_after(""), 0.1) << "the bar has gone, the elbow stays";
  EXPECT_LT(left_after("  - {module: posture, stiffness: 400 N m/rad, damping: 200 N m s/rad, "
                       "torque_limit: 300 N m}\n"),
            0.02);
  for (const json& module : report_of(folder / "r.json").at("modules")) {
    if (module.at("name") != "posture") continue;
    EXPECT_TRUE(module.at("passive").get<bool>()) << module;
  }
}

// The partner's rod as an obstacle, seen from the other arm, and vice versa.
TEST(WholeArm, TwoArmsInOneCellKeepOffEachOther) {
  const Folder folder;
  const std::string tool =
      "tool: [{name: rod, shape: capsule, radius: 15 mm, length: 60 mm, position: 0 0 -30 mm}]\n";
  const std::string urdf = REPEL_SOURCE "/robots/puma560.urdf";
  const std::string pose = "start: 0 45 -180 0 -45 0 deg, tool_frame: {position: 0 0 100 mm}";
  std::string text = "robot: {urdf: " + urdf + ", " + pose + "}\n" + tool +
                     "laws:\n  default: {range: 40 mm, surface_force: 40 N, damping: 1 N s/m}\n"
                     "obstacles: []\n"
                     "script: [{name: in, device: spaceball, duration: 3 s, linear: 90 0 0 mm/s}]\n"
                     "partners:\n  - name: right\n    robot: {urdf: " +
                     urdf + ", " + pose +
                     ", base: {position: 1.4 -0.3 0 m, rpy: 0 0 180 deg}}\n    " + tool +
                     "    script: [{name: in, device: spaceball, duration: 3 s, linear: -90 0 0 "
                     "mm/s}]\n";
  const Ending ending =
      teleop(quoted(folder.with("two.yaml", text)) + " --fast --seconds 4 --log " +
             quoted(folder / "log.csv") + " --report " + quoted(folder / "r.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const json report = report_of(folder / "r.json");
  EXPECT_GT(report.at("nearest_m"), 0.0);
  const Columns log = columns_of(folder / "log.csv");
  const double left = log.at("virtual_fx_n").back();
  EXPECT_LT(left, -5.0);
  EXPECT_NEAR(log.at("right/virtual_fx_n").back(), -left, 1e-6) << "action and reaction";
  EXPECT_GT(log.at("right/coupling_fx_n").front() + 1.0, 0.0);
  ASSERT_EQ(report.at("partners").size(), 1U);
  for (const json& modules : {report.at("modules"), report.at("partners")[0].at("modules")}) {
    for (const json& module : modules) {
      if (!module.at("claims_passive").get<bool>()) continue;
      EXPECT_LE(module.at("deficit"), 1e-9) << module;
    }
  }
}

TEST(WholeArm, PartsOfOneArmAreKeptApartWhereTheSceneSaysSo) {
  const Folder folder;
  const std::string script =
      "script:\n  - {name: fold, device: spaceball, duration: 4 s, linear: -120 0 100 mm/s}\n";
  const auto report_with = [&](const std::string& law) {
    const std::string text =
        robot_text(REPEL_SOURCE "/robots/puma560.urdf", law) +
        "laws:\n  default: {range: 40 mm, surface_force: 60 N, damping: 1 N s/m}\nobstacles: []\n" +
        script;
    const Ending ending = teleop(quoted(folder.with("self.yaml", text)) +
                                 " --fast --seconds 5 --report " + quoted(folder / "r.json"));
    EXPECT_EQ(ending.status, 0) << ending;
    return report_of(folder / "r.json");
  };
  const json kept = report_with("  self_law: default\n");
  EXPECT_GT(kept.at("nearest_m"), 0.0);
  double peak = 0.0;
  for (const json& part : kept.at("obstacles")) {
    peak = std::max(peak, part.at("peak_force_n").get<double>());
  }
  EXPECT_GT(peak, 20.0) << "the wrist must have been folded towards the forearm";
  EXPECT_EQ(report_with("").at("pairs"), 0);
}

// The cube turns the wrist towards the forearm while a post holds the forearm. Regression: a link
// that moved towards another supplied it as a moving obstacle does, and ARM_OBSTACLE ended with
// 0.3 J less than nothing, OBSTACLE with less than nothing on account of the cube and the wrist.
TEST(WholeArm, PairsOfItsOwnLinksReturnNoMoreThanTheyTook) {
  const Folder folder;
  const std::string text =
      "robot:\n  urdf: " REPEL_SOURCE
      "/robots/puma560.urdf\n"
      "  start: 0 45 -180 0 -45 0 deg\n  self_law: default\n"
      "tool: [{name: cube, shape: box, size: 60 60 60 mm}]\n"
      "laws:\n  default: {range: 30 mm, surface_force: 400 N, damping: 150 N s/m}\n"
      "obstacles:\n"
      "  - {name: post, shape: box, size: 40 40 1000 mm, position: 0.40 0.05 0.95 m}\n"
      "network: [{module: torque_arm}, {module: multiplex}, {module: spaceball}, {module: kbb2}, "
      "{module: obstacle, gain_check: warning}, {module: puma_kin}, {module: arm_obstacle}, "
      "{module: limits}, {module: puma_joints}]\n"
      "script:\n"
      "  - {name: out, device: torque_arm, duration: 4 s, direction: 0 1 0, lever: 60 deg/s}\n"
      "  - {name: back, device: torque_arm, duration: 3 s, direction: 0 1 0, lever: -60 deg/s}\n";
  const Ending ending = teleop(quoted(folder.with("cube.yaml", text)) +
                               " --fast --seconds 8 --report " + quoted(folder / "r.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  EXPECT_FALSE(ending.says("NOT PASSIVE")) << ending;
  const json report = report_of(folder / "r.json");
  EXPECT_GT(report.at("nearest_m"), 0.0);
  double own = 0.0;
  for (const json& part : report.at("obstacles")) {
    if (part.at("name") == "post") continue;
    own = std::max(own, part.at("peak_force_n").get<double>());
  }
  EXPECT_GT(own, 50.0) << "links must have pushed each other";
  for (const json& module : report.at("modules")) {
    EXPECT_EQ(module.at("passive"), module.at("claims_passive")) << module;
    const bool walls = module.at("name") == "obstacle" || module.at("name") == "arm_obstacle";
    if (!walls) continue;
    EXPECT_EQ(module.at("supplied_j"), 0.0) << module;
  }
}

}  // namespace whole_arm_test
}  // namespace repel::test
