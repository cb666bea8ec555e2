// SPDX-License-Identifier: BSD-3-Clause
#include <repel/scene/scene.hpp>

#include "end_to_end/whole_run.hpp"

namespace repel::test {
namespace scene_test {

// The finger tips are 20 mm before the tool frame, which points down.
constexpr double tip = 0.02;

TEST(Scene, TheDefaultOnePushesTheToolAndLetsItThroughTheMembraneOnly) {
  const Folder folder;
  const Ending ending = teleop("--fast --seconds 24 --log " + quoted(folder / "log.csv") +
                               " --report " + quoted(folder / "report.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const auto report = report_of(folder / "report.json");
  const Columns log = columns_of(folder / "log.csv");
  ASSERT_EQ(log.at("tick").size(), 9600U);
  expect_finite_forces(log);
  EXPECT_GT(report.at("peak_force_n"), 10.0);
  EXPECT_FALSE(report.at("status_ticks").contains("stale_pairs")) << report;

  const scene::Scene scene = scene::load(REPEL_SOURCE "/scenes/anderson_4x8.yaml");
  const scene::Obstacle* membrane = nullptr;
  for (const scene::Obstacle& obstacle : scene.obstacles) {
    if (std::isfinite(obstacle.law.ceiling)) membrane = &obstacle;
  }
  ASSERT_NE(membrane, nullptr);
  const Vec3 centre = membrane->X_WP.translation();
  double lowest = 1.0;     // [m] tips below the middle of the membrane
  double intrusion = 0.0;  // [m] into a wall, where the membrane is out of reach
  for (std::size_t i = 0; i < log.at("tick").size(); ++i) {
    const Vec3 p(log.at("x_m")[i], log.at("y_m")[i], log.at("z_m")[i] - tip);
    const bool over = (p - centre).head<2>().norm() < 0.2;
    if (over) lowest = std::min(lowest, p.z() - centre.z());
    if (!over) intrusion = std::max(intrusion, -log.at("nearest_m")[i]);
  }
  EXPECT_LT(lowest, -0.005) << "the membrane was not crossed";
  EXPECT_LT(intrusion, 0.001) << "a wall was entered";
}

const nlohmann::json& module_of(const nlohmann::json& report, const std::string& name) {
  for (const nlohmann::json& module : report.at("modules")) {
    if (module.at("name") == name) return module;
  }
  throw std::invalid_argument("no module " + name);
}

// A coupling at its limit drags its command along: the operator would feel the limit, not the law.
TEST(Scene, TheDefaultOneLeadsWithTheLeverSlidesWithinTheLimitsAndUsesEveryModule) {
  const scene::Scene scene = scene::load(REPEL_SOURCE "/scenes/anderson_4x8.yaml");
  EXPECT_EQ(scene.script.front().master, network::Master::torque_arm);
  double lever = 0.0, ball = 0.0;  // [s]
  for (const network::Phase& phase : scene.script) {
    (phase.master == network::Master::torque_arm ? lever : ball) += phase.duration;
  }
  EXPECT_GT(lever, 4.0 * ball);
  EXPECT_GT(ball, 1.0);

  const Folder folder;
  for (const std::string backend : {"bullet", "ode", "mujoco", "reference", "ideal"}) {
    SCOPED_TRACE(backend);
    const Ending ending = teleop("--fast --seconds 20 --backend " + backend + " --report " +
                                 quoted(folder / "report.json"));
    if (ending.says("is not built in")) continue;
    ASSERT_EQ(ending.status, 0) << ending;
    const auto report = report_of(folder / "report.json");
    EXPECT_TRUE(report.at("warnings").empty()) << report.at("warnings");
    const auto& status = report.at("status_ticks");
    EXPECT_FALSE(status.contains("saturated")) << status;
    EXPECT_FALSE(status.contains("torque_limit")) << status;
    EXPECT_GT(status.at("joint_limit"), 50);
    EXPECT_LT(status.at("joint_limit"), 1000) << "it must be left again";
    EXPECT_GT(module_of(report, "relief").at("most_given").at("z"), 0.03);
    EXPECT_GT(module_of(report, "limits").at("most_torques").at(2), 5.0);
    for (const auto& obstacle : report.at("obstacles")) {
      EXPECT_GT(obstacle.at("peak_force_n"), 8.0) << obstacle;
      EXPECT_EQ(obstacle.at("body") == "link_3", obstacle.at("name") == "post") << obstacle;
    }
    EXPECT_LT(report.at("chatter").at("walls").at("torque_rms_nm"), 0.05);
    EXPECT_LT(report.at("chatter").at("walls").at("torque_jump_nm"), 0.8);
    EXPECT_EQ(report.at("budget").at("work_units"), 256);
    EXPECT_EQ(report.at("pairs_stale"), 0);
    EXPECT_LE(report.at("support_pairs_most"), 256);
  }
}

// The walls of the paper act on the tool alone, so its arm is not kept off the post.
TEST(Scene, TheDefaultOneAsInThePaperStaysWithinTheLimitsToo) {
  const Folder folder;
  const auto furthest = [&folder](const std::string& options) {
    const Ending ending = teleop("--fast --seconds 20 --log " + quoted(folder / "log.csv") +
                                 options + " --report " + quoted(folder / "report.json"));
    EXPECT_EQ(ending.status, 0) << ending;
    EXPECT_FALSE(report_of(folder / "report.json").at("status_ticks").contains("saturated"));
    const Columns log = columns_of(folder / "log.csv");
    return *std::max_element(log.at("y_m").begin(), log.at("y_m").end());
  };
  EXPECT_GT(furthest(" --tool-alone --budget i860"), furthest("") + 0.015);
}

const nlohmann::json& obstacle_of(const nlohmann::json& report, const std::string& name) {
  for (const nlohmann::json& obstacle : report.at("obstacles")) {
    if (obstacle.at("name") == name) return obstacle;
  }
  throw std::invalid_argument("no obstacle " + name);
}

TEST(Scene, SoftTissueStiffensWithDepthOverBoneAndSkinGivesWay) {
  const Folder folder;
  const Ending ending =
      teleop("soft_tissue --fast --seconds 20 --log " + quoted(folder / "log.csv") + " --report " +
             quoted(folder / "report.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const auto report = report_of(folder / "report.json");
  EXPECT_TRUE(report.at("status_ticks").empty()) << report.at("status_ticks");
  const Columns log = columns_of(folder / "log.csv");
  constexpr double surface = 0.40;  // [m] where the tissue begins
  constexpr double press = 1.0;     // phase of the script
  const auto force_at = [&](double depth) {
    for (std::size_t i = 0; i < log.at("tick").size(); ++i) {
      const bool pressed = log.at("phase")[i] == press;
      if (pressed && log.at("z_m")[i] < surface - depth) return log.at("virtual_fz_n")[i];
    }
    return 0.0;
  };
  EXPECT_GT(force_at(0.01), 0.5);
  EXPECT_GT(force_at(0.02), 3.0 * force_at(0.01)) << "stiffer as it is pressed deeper";
  EXPECT_LT(force_at(0.02), 6.0) << "and soft all the same";
  EXPECT_GT(obstacle_of(report, "lump").at("peak_force_n"), 3.0);
  EXPECT_GT(obstacle_of(report, "bone").at("peak_force_n"),
            3.0 * obstacle_of(report, "tissue").at("peak_force_n").get<double>());
  EXPECT_NEAR(obstacle_of(report, "skin").at("peak_force_n"), 3.0, 1e-6);
  EXPECT_LT(obstacle_of(report, "skin").at("nearest_m"), -0.005) << "punctured";
  EXPECT_LT(report.at("chatter").at("walls").at("force_rms_n"), 0.05);
  EXPECT_LT(report.at("chatter").at("walls").at("torque_jump_nm"), 0.01);
}

TEST(Scene, EveryOneOfTheRepositoryRunsWithoutAFault) {
  const Folder folder;
  for (const std::string& scene : scene_names()) {
    for (const std::string backend : {"bullet", "ode", "mujoco", "reference", "ideal"}) {
      const Ending ending = teleop(scene + " --fast --seconds 1 --backend " + backend +
                                   " --report " + quoted(folder / "report.json"));
      if (ending.says("is not built in")) continue;
      ASSERT_EQ(ending.status, 0) << scene << '\n' << ending;
      const auto report = report_of(folder / "report.json");
      for (const char* fault : {"bad_pose", "bad_command", "bad_joints", "clock_fault"}) {
        EXPECT_FALSE(report.at("status_ticks").contains(fault)) << scene << ' ' << fault;
      }
    }
  }
}

/// Every tick of 20 s of the default scene; nothing if that back end is not built.
Columns log_with(const Folder& folder, const std::string& backend) {
  const Ending ending =
      teleop("--fast --seconds 20 --backend " + backend + " --log " + quoted(folder / "log.csv"));
  if (ending.says("is not built in")) return {};
  EXPECT_EQ(ending.status, 0) << ending;
  return columns_of(folder / "log.csv");
}

// Engines that share only the model: they differ in the integration scheme and in the treatment of
// dry friction.
TEST(Scene, TheEnginesAndTheReferenceArmFeelTheSameWalls) {
  const Folder folder;
  const Columns reference = log_with(folder, "reference");
  const auto& force = reference.at("virtual_fz_n");
  EXPECT_GT(*std::max_element(force.begin(), force.end()), 50.0);
  for (const char* backend : {"bullet", "ode", "mujoco"}) {
    const Columns log = log_with(folder, backend);
    if (log.empty()) continue;
    for (const char* column : {"x_m", "y_m", "z_m"}) {
      const auto& a = reference.at(column);
      const auto& b = log.at(column);
      ASSERT_EQ(a.size(), 8000U);
      ASSERT_EQ(b.size(), 8000U);
      for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_NEAR(a[i], b[i], 0.005) << backend << ' ' << column << ' ' << i;
      }
    }
  }
}

TEST(Scene, NoObstaclesMeansNoForce) {
  const Folder folder;
  for (const char* budget : {"", "budget: {work: 100}\n"}) {
    const std::string scene =
        folder.with("empty.yaml", robot_text() + "obstacles: []\n" + push_text() + budget);
    const Ending ending =
        teleop(quoted(scene) + " --fast --seconds 1 --report " + quoted(folder / "report.json"));
    ASSERT_EQ(ending.status, 0) << budget << ending;
    const auto report = report_of(folder / "report.json");
    EXPECT_EQ(report.at("pairs"), 0);
    EXPECT_EQ(report.at("peak_force_n"), 0.0);
    EXPECT_TRUE(report.at("nearest_m").is_null());
  }
}

TEST(Scene, OperatorThatSendsNoNumbersIsSaidAndForcesStayFinite) {
  const Folder folder;
  const std::string scene = folder.with(
      "fault.yaml",
      robot_text() + table_text() +
          "script:\n"
          "  - {name: push, device: spaceball, duration: 800 ms, linear: 0 0 -100 mm/s}\n"
          "  - {name: fail, device: spaceball, duration: 200 ms, linear: nan 0 0 mm/s}\n"
          "  - {name: lever, device: torque_arm, duration: 200 ms, direction: 0 0 -1, lever: nan "
          "rad/s}\n");
  const Ending ending =
      teleop(quoted(scene) + " --fast --seconds 2 --log " + quoted(folder / "log.csv") +
             " --report " + quoted(folder / "report.json"));
  ASSERT_EQ(ending.status, 5) << "a fifth of the ticks has a fault " << ending;
  EXPECT_TRUE(ending.says("bad_command")) << ending;
  EXPECT_EQ(report_of(folder / "report.json").at("status_ticks").at("bad_command"), 160);
  const Columns log = columns_of(folder / "log.csv");
  expect_finite_forces(log);
  EXPECT_GT(*std::max_element(log.at("virtual_fz_n").begin(), log.at("virtual_fz_n").end()), 1.0);
  EXPECT_EQ(log.at("gain")[319], 1.0);
  EXPECT_EQ(log.at("gain")[479], 0.0);
}

/// Four tool parts among 2500 small blocks under the tool, all within range.
std::string crowd() {
  std::string text = "name: crowd\n" + robot_text();
  for (const char* part : {"a", "b", "c"}) {
    text += std::string("  - {name: ") + part +
            ", shape: box, size: 20 20 60 mm, position: 0 0 -30 mm}\n";
  }
  text += "laws:\n  default: {range: 1 m, surface_force: 0.01 N, damping: 0.01 N s/m}\n";
  text += "budget: {wall: 50 us}\nobstacles:\n";
  for (int i = 0; i < 2500; ++i) {
    const int x = 350 + 10 * (i % 50);
    const int y = -400 + 10 * (i / 50);
    text += "  - {name: block" + std::to_string(i) +
            ", shape: box, size: 9 9 9 mm, position: " + std::to_string(x) + " " +
            std::to_string(y) + " 380 mm}\n";
  }
  return text + push_text();
}

TEST(Scene, TenThousandPairsInFiftyMicrosecondsRunByTheClockAndAreReportedHonestly) {
  const Folder folder;
  const std::string scene = folder.with("crowd.yaml", crowd());
  const Ending ending = teleop(quoted(scene) + " --seconds 1 --log " + quoted(folder / "log.csv") +
                               " --report " + quoted(folder / "report.json"));
  // 5: on a slow machine, results expire in many of its ticks.
  ASSERT_TRUE(ending.status == 0 || ending.status == 5) << ending;
  const auto report = report_of(folder / "report.json");
  // A slow machine skips ticks, and says so.
  EXPECT_GE(report.at("ticks").get<int>() + report.at("skipped_ticks").get<int>(), 400);
  EXPECT_LE(report.at("ticks"), 400);
  EXPECT_EQ(report.at("pairs"), 10000);
  EXPECT_GT(report.at("pairs_stale"), 0);
  EXPECT_GT(report.at("oldest_age_ticks"), 0);
  EXPECT_GT(report.at("status_ticks").at("stale_pairs"), 0);
  EXPECT_LT(report.at("pairs_evaluated_per_tick"), 10000.0);
  const double rate = report.at("success_rate_last_100");
  EXPECT_TRUE(rate >= 0.0 && rate <= 1.0) << rate;
  const auto& allocations = report.at("allocations_in_tick");
  EXPECT_TRUE(allocations.is_null() || allocations == 0) << allocations;
  expect_finite_forces(columns_of(folder / "log.csv"));
}

}  // namespace scene_test
}  // namespace repel::test
