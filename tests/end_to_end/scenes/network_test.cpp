// SPDX-License-Identifier: BSD-3-Clause
#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace network_test {

using nlohmann::json;

const json& module_of(const json& report, const std::string& name) {
  for (const json& module : report.at("modules")) {
    if (module.at("name") == name) return module;
  }
  throw std::runtime_error("no module " + name);
}

/// The lowest ledger of a module that claims to be passive, relative to the energy that passed
/// through it.
double worst_deficit(const json& report) {
  double worst = 0.0;
  for (const json& module : report.at("modules")) {
    if (module.at("claims_passive").get<bool>()) {
      worst = std::max(worst, module.at("deficit").get<double>());
    }
  }
  return worst;
}

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(NetworkOfAScene, ThoseOfThePaperAndOfTheArmKeepTheirLedgersAtEveryRate) {
  const Folder folder;
  for (const std::string rate : {"400", "4000"}) {
    const Ending ending = teleop("--fast --seconds 20 --rate " + rate + " --report " +
                                 quoted(folder / "report.json"));
    ASSERT_EQ(ending.status, 0) << ending;
    const json report = report_of(folder / "report.json");
    ASSERT_EQ(report.at("modules").size(), 11U);
    EXPECT_LE(worst_deficit(report), 1e-9) << report.at("modules");
    EXPECT_GT(module_of(report, "obstacle").at("passed_j"), 1.0);
    EXPECT_GT(module_of(report, "spaceball").at("supplied_j"), 0.05) << "it also lets walls push";
    EXPECT_GT(module_of(report, "torque_arm").at("supplied_j"), 1.0);
    EXPECT_FALSE(report.at("status_ticks").contains("network_fault"));
    EXPECT_TRUE(report.at("network_us").at("p50").is_number());
  }
}

TEST(NetworkOfAScene, ALeverScrewsTheToolIntoATable) {
  const Folder folder;
  // Against the x axis of the tool's hand; down, and about the vertical.
  const std::string scene = folder.with(
      "screw.yaml", "name: screw\nrate: 400 Hz\n" + robot_text() + table_text() +
                        "script:\n"
                        "  - {name: screw, device: torque_arm, duration: 3 s, direction: 0 0 -1, "
                        "lever: 0.4 rad/s, pitch: 25 mm/rad}\n");
  const Ending ending =
      teleop(quoted(scene) + " --fast --seconds 3 --log " + quoted(folder / "log.csv") +
             " --report " + quoted(folder / "report.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const json report = report_of(folder / "report.json");
  EXPECT_LE(worst_deficit(report), 1e-9) << report.at("modules");
  const Columns log = columns_of(folder / "log.csv");
  // The tool points down: its last joint turns it, as the lever turns, which the table slows down.
  const double turned = log.at("q6_rad").back() - log.at("q6_rad").front();
  const double sunk = log.at("z_m").front() - log.at("z_m").back();
  EXPECT_GT(std::abs(turned), 0.5);
  EXPECT_NEAR(sunk, 0.025 * std::abs(turned), 0.006) << "but for what gives way";
  EXPECT_NEAR(log.at("x_m").back(), log.at("x_m").front(), 0.003);
  EXPECT_GT(log.at("virtual_fz_n").back(), 1.0);
  // The pitch makes a torque of the force: dW = F dz = T d(lever), with 0.1 m of the lever's scale.
  EXPECT_GT(std::abs(log.at("lever_torque_nm").back()), 0.01);
}

TEST(NetworkOfAScene, TwoLeversLeadOneTool) {
  // One lever sideways, one down: each RELIEF gives way where the other lever leads the tool.
  const Folder folder;
  const std::string scene = folder.with(
      "levers.yaml",
      "name: levers\nrate: 400 Hz\n" + robot_text() + table_text() +
          "network:\n"
          "  - {module: torque_arm, name: left}\n"
          "  - {module: multiplex, name: sideways}\n"
          "  - {module: relief, name: left_grip, compliant: [x, y, z, rx, ry, rz], "
          "stiffness: 1 N/mm, to: tool}\n"
          "  - {module: torque_arm, name: right, hand: second}\n"
          "  - {module: multiplex, name: down, hand: second}\n"
          "  - {module: relief, name: right_grip, compliant: [x, y, z, rx, ry, rz], "
          "stiffness: 1 N/mm, to: tool}\n"
          "  - {module: junction, name: tool}\n"
          "  - {module: kbb2}\n"
          "  - {module: obstacle}\n"
          "  - {module: puma_kin}\n"
          "  - {module: limits}\n"
          "  - {module: puma_joints}\n"
          "script:\n"
          "  - {name: both, device: torque_arm, duration: 2 s, direction: 0 1 0, lever: 0.4 rad/s, "
          "second: {direction: 0 0 -1, lever: 0.2 rad/s}}\n");
  const std::string run = quoted(scene) + " --fast --seconds 2";
  const Ending ending = teleop(run + " --log " + quoted(folder / "log.csv") + " --report " +
                               quoted(folder / "report.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const json report = report_of(folder / "report.json");
  EXPECT_LE(worst_deficit(report), 1e-9) << report.at("modules");
  EXPECT_GT(module_of(report, "left").at("supplied_j"), 0.001);
  EXPECT_GT(module_of(report, "right").at("supplied_j"), 0.001);
  const Columns log = columns_of(folder / "log.csv");
  const auto moved = [&log](const char* axis) {
    return log.at(axis).back() - log.at(axis).front();
  };
  EXPECT_NEAR(moved("x_m"), 0.0, 0.01);
  EXPECT_GT(moved("y_m"), 0.015);
  EXPECT_LT(moved("z_m"), -0.005);
  const Ending recorded = teleop(run + " --log " + quoted(folder / "run.mcap"));
  ASSERT_EQ(recorded.status, 0) << recorded;
  const Ending replayed = teleop("replay " + quoted(folder / "run.mcap"));
  EXPECT_EQ(replayed.status, 0) << replayed;
}

TEST(NetworkOfAScene, TwoHandsLeadOneToolIntoATable) {
  const Folder folder;
  const std::string scene = folder.with(
      "hands.yaml",
      "name: hands\nrate: 400 Hz\n" + robot_text() + table_text() +
          "network:\n"
          "  - {module: six_axes, name: left, to: tool}\n"
          "  - {module: six_axes, name: right, hand: second, motion_scale: 2, to: tool}\n"
          "  - {module: junction, name: tool}\n"
          "  - {module: relief}\n"
          "  - {module: kbb2}\n"
          "  - {module: obstacle}\n"
          "  - {module: puma_kin}\n"
          "  - {module: limits}\n"
          "  - {module: puma_joints}\n"
          "script:\n"
          "  - {name: down, device: six_axes, duration: 1.5 s, linear: 0 0 -40 mm/s, "
          "second: {linear: 0 0 -20 mm/s}}\n"
          "  - {name: against, device: six_axes, duration: 1 s, linear: 0 20 0 mm/s, "
          "second: {linear: 0 -40 0 mm/s}}\n");
  const std::string run = quoted(scene) + " --fast --seconds 2.5";
  const Ending ending = teleop(run + " --log " + quoted(folder / "log.csv") + " --report " +
                               quoted(folder / "report.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const json report = report_of(folder / "report.json");
  EXPECT_LE(worst_deficit(report), 1e-9) << report.at("modules");
  EXPECT_GT(module_of(report, "left").at("supplied_j"), 0.001);
  EXPECT_GT(module_of(report, "right").at("supplied_j"), 0.001);
  EXPECT_GT(report.at("peak_force_n"), 2.0);
  const Columns log = columns_of(folder / "log.csv");
  EXPECT_GT(log.at("z_m").front() - log.at("z_m").back(), 0.005);
  // They draw it to opposite sides, the second twice as far at half the force.
  EXPECT_NEAR(log.at("y_m").back(), log.at("y_m").front(), 0.004);
  const Ending recorded = teleop(run + " --log " + quoted(folder / "run.mcap"));
  ASSERT_EQ(recorded.status, 0) << recorded;
  const Ending replayed = teleop("replay " + quoted(folder / "run.mcap"));
  EXPECT_EQ(replayed.status, 0) << replayed;
}

TEST(NetworkOfAScene, LedgersOfEveryTickAreInTheLog) {
  const Folder folder;
  const Ending ending = teleop("--fast --seconds 3 --log " + quoted(folder / "log.csv"));
  ASSERT_EQ(ending.status, 0) << ending;
  const Columns log = columns_of(folder / "log.csv");
  for (const char* name : {"torque_arm", "kbb2", "obstacle", "puma_joints"}) {
    ASSERT_EQ(log.count(std::string("energy_") + name + "_j"), 1U) << name;
  }
  const auto& kbb2 = log.at("energy_kbb2_j");
  EXPECT_GT(*std::max_element(kbb2.begin(), kbb2.end()), 0.01);
  EXPECT_GE(*std::min_element(kbb2.begin(), kbb2.end()), 0.0);
}

// What the tool does not feel of its joints had no admittance: such an arm never moved, and the
// run ended as if it had.
TEST(NetworkOfAScene, ArmOfSevenJointsAndASingularOneMoveWhereNothingKeepsTheToolOffWalls) {
  struct Way {
    const char* urdf;
    const char* start;  ///< [deg]
  };
  const Folder folder;
  for (const Way& way : {Way{"/bench/arms/iiwa14.urdf", "0 30 0 -90 0 60 0"},
                         Way{"/robots/puma560.urdf", "0 45 -180 0 0 0"}}) {
    const std::string scene = folder.with(
        "free.yaml",
        std::string("robot:\n  urdf: " REPEL_SOURCE) + way.urdf + "\n  start: " + way.start +
            " deg\n  tool_frame: {position: 0 0 80 mm}\n  links: []\n"
            "tool:\n  - {name: ball, shape: sphere, radius: 30 mm}\nobstacles: []\n"
            "network:\n  - {module: torque_arm}\n  - {module: multiplex}\n"
            "  - {module: spaceball}\n  - {module: kbb2}\n  - {module: puma_kin}\n"
            "  - {module: arm_obstacle}\n  - {module: limits}\n  - {module: puma_joints}\n"
            "script:\n"
            "  - {name: up, device: spaceball, duration: 2 s, linear: 0 0 30 mm/s}\n");
    const Ending ending =
        teleop(quoted(scene) + " --fast --seconds 2.5 --log " + quoted(folder / "log.csv") +
               " --report " + quoted(folder / "report.json"));
    ASSERT_EQ(ending.status, 0) << way.urdf << '\n' << ending;
    const json report = report_of(folder / "report.json");
    EXPECT_FALSE(report.at("status_ticks").contains("network_fault")) << report.at("status_ticks");
    EXPECT_LE(worst_deficit(report), 1e-9) << report.at("modules");
    const Columns log = columns_of(folder / "log.csv");
    EXPECT_NEAR(log.at("z_m").back() - log.at("z_m").front(), 0.056, 0.01) << way.urdf;
  }
}

TEST(NetworkOfAScene, WallThatIsTooStiffIsRefusedWithTheLimit) {
  const Folder folder;
  const std::string stiff =
      robot_text() +
      "laws:\n  default: {range: 1 mm, surface_force: 25 N, damping: 0 N s/m}\n"
      "obstacles:\n"
      "  - {name: slab, shape: box, size: 1 1 0.1 m, position: 0 0 -1 m}\n";
  const Ending refused = teleop(quoted(folder.with("stiff.yaml", stiff)) + " --fast --seconds 0.1");
  EXPECT_EQ(refused.status, 1) << refused;
  for (const char* part : {"'slab'", "wall stiffness is 50000 N/m", "limit is", "2.5 ms",
                           "N s/m of damping in the device", "needs 62.5 N s/m", "gain_check"}) {
    EXPECT_TRUE(refused.says(part)) << part << '\n' << refused;
  }
  const std::string warned =
      stiff +
      "network: [{module: torque_arm}, {module: multiplex}, {module: kbb2}, {module: obstacle, "
      "gain_check: warning}, {module: puma_kin}, {module: puma_joints}]\n";
  const Ending said = teleop(quoted(folder.with("warned.yaml", warned)) + " --fast --seconds 0.1");
  EXPECT_EQ(said.status, 0) << said;
  EXPECT_TRUE(said.says("wall stiffness is 50000 N/m")) << said;
}

TEST(NetworkOfAScene, SilentDeviceRampsTheForceToZero) {
  const Folder folder;
  const std::string scene =
      folder.with("silent.yaml",
                  robot_text() + table_text() +
                      "script:\n"
                      "  - {name: push, device: spaceball, duration: 1 s, linear: 0 0 -50 mm/s}\n"
                      "  - {name: lost, device: spaceball, duration: 500 ms, silent: yes}\n");
  const Ending ending =
      teleop(quoted(scene) + " --fast --seconds 2 --log " + quoted(folder / "log.csv") +
             " --report " + quoted(folder / "report.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const json report = report_of(folder / "report.json");
  EXPECT_EQ(report.at("status_ticks").at("silent_device"), 192);  // 500 ms minus 20 ms
  const Columns log = columns_of(folder / "log.csv");
  expect_finite_forces(log);
  const auto& gain = log.at("gain");
  EXPECT_EQ(gain[400], 1.0);
  EXPECT_EQ(gain[440], 0.0);  // after 20 ms of timeout and 50 ms of ramp
}

/// Runs a scene and checks it: no ledger is violated and all forces are finite.
std::pair<json, Columns> ran(const Folder& folder, const std::string& scene, double seconds) {
  const Ending ending =
      teleop(quoted(scene) + " --fast --seconds " + std::to_string(seconds) + " --log " +
             quoted(folder / "log.csv") + " --report " + quoted(folder / "report.json"));
  EXPECT_EQ(ending.status, 0) << ending;
  const json report = report_of(folder / "report.json");
  EXPECT_LE(worst_deficit(report), 1e-9) << report.at("modules");
  Columns log = columns_of(folder / "log.csv");
  expect_finite_forces(log);
  return {report, std::move(log)};
}

// The elbow is folded up to its limit, and the hand continues. The other joints may yield.
TEST(NetworkOfAScene, JointAtItsLimitHoldsAgainstTheOperatorAndIsFelt) {
  const Folder folder;
  std::string robot = robot_text();
  const std::string start = "0 45 -180 0 -45 0 deg";
  robot.replace(robot.find(start), start.size(), "0 70 -218 0 -30 0 deg");
  const std::string scene =
      folder.with("limit.yaml", robot +
                                    "obstacles: []\n"
                                    "script:\n"
                                    "  - {name: fold, device: torque_arm, duration: 5 s, "
                                    "direction: -1 0 0, lever: 0.8 rad/s}\n"
                                    "  - {name: back, device: torque_arm, duration: 3 s, "
                                    "direction: -1 0 0, lever: -0.8 rad/s}\n");
  const auto [report, log] = ran(folder, scene, 8);
  EXPECT_GT(report.at("status_ticks").at("joint_limit").get<int>(), 1000);
  const auto& torque = log.at("lever_torque_nm");
  const auto& x = log.at("x_m");
  const auto& gain = log.at("gain");
  EXPECT_LT(torque[1999], -2.0);  // opposite to its motion
  const auto& elbow = log.at("q3_rad");
  EXPECT_LT(std::abs(elbow[1999] - elbow[1799]), 0.02 * std::abs(elbow[200] - elbow[0]))
      << "the elbow went on";
  EXPECT_GT(x.back(), x[1999] + 0.05) << "the arm did not come back";
  EXPECT_EQ(*std::min_element(gain.begin(), gain.end()), 1.0) << "a limit is no fault";
}

// A device at full deflection is followed as fast as the ball allows, and reported as saturated.
TEST(NetworkOfAScene, SaturatedInputIsCutAndReported) {
  const Folder folder;
  const std::string scene = folder.with(
      "fast.yaml", robot_text() + table_text() +
                       "script:\n"
                       "  - {name: hit, device: spaceball, duration: 500 ms, linear: 0 0 -9 m/s}\n"
                       "  - {name: pull, device: torque_arm, duration: 500 ms, direction: 0 0 1, "
                       "lever: 90 rad/s}\n");
  const auto [report, log] = ran(folder, scene, 1.5);
  EXPECT_GT(report.at("status_ticks").at("saturated").get<int>(), 200);
  const auto& z = log.at("z_m");
  for (std::size_t i = 1; i < 200; ++i) ASSERT_LT(std::abs(z[i] - z[i - 1]), 0.6 / 400.0) << i;
}

/// Largest virtual force in the last second of a minute of holding the tool on the table, over 100
/// ms and a channel that loses one packet in twenty; and the report.
std::pair<double, json> held_over_a_line(const Folder& folder, const std::string& kind) {
  std::string text = text_of(REPEL_SOURCE "/scenes/delayed.yaml");
  const auto replace = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  replace("../robots", REPEL_SOURCE "/robots");
  replace("module: line,", "module: line, kind: " + kind + ",");
  replace("duration: 6 s", "duration: 60 s");
  const Ending ending =
      teleop(quoted(folder.with("held.yaml", text)) + " --fast --seconds 60 --log " +
             quoted(folder / "log.csv") + " --report " + quoted(folder / "report.json"));
  // The plain line may let the arm gain so much energy that it is a fault (5).
  EXPECT_TRUE(ending.status == 0 || (kind != "waves" && ending.status == 5)) << ending;
  const Columns log = columns_of(folder / "log.csv");
  const auto& force = log.at("virtual_fz_n");
  double largest = 0.0;
  for (std::size_t i = force.size() - 400; i < force.size(); ++i) {
    largest = std::max(largest, std::abs(force[i]));
  }
  return {largest, report_of(folder / "report.json")};
}

TEST(NetworkOfAScene, WavesHoldAWallOverADelayWhereThePlainLineDoesNot) {
  const Folder folder;
  const auto [by_waves, waves] = held_over_a_line(folder, "waves");
  EXPECT_GT(by_waves, 5.0) << "nothing was held";
  EXPECT_LT(waves.at("peak_force_n"), 100.0);
  EXPECT_LE(worst_deficit(waves), 1e-9) << waves.at("modules");
  const auto [by_force, plain] = held_over_a_line(folder, "force_velocity");
  // Although the speed of the tool is bounded.
  EXPECT_GT(plain.at("peak_force_n").get<double>(), 2.0 * waves.at("peak_force_n").get<double>());
  EXPECT_LT(module_of(plain, "line").at("least_j"), -100.0);
}

}  // namespace network_test
}  // namespace repel::test
