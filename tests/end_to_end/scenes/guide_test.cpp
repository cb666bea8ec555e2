// SPDX-License-Identifier: BSD-3-Clause
// Virtual fixtures on arms of six and more joints, as a user has them from a scene.
#include <repel/scene/scene.hpp>

#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace guide_test {

using nlohmann::json;

struct Arm {
  std::string urdf, start;
};
const Arm arms[] = {{"puma560", "0 45 -180 0 -45 0 deg"},
                    {"puma560_armstrong", "0 -135 0 0 -45 0 deg"},
                    {"long_reach", "[1900 mm, 0 20 40 20 10 0 deg]"}};

/// A scene without obstacles whose hand goes away and waits.
std::string scene_of(const Arm& arm, int delay, const std::string& fixtures) {
  return "robot:\n  urdf: " REPEL_SOURCE "/robots/" + arm.urdf + ".urdf\n  start: " + arm.start +
         "\n  tool_frame: {position: 0 0 100 mm}\n  drive_delay: " + std::to_string(delay) +
         "\ntool:\n  - {name: ball, shape: sphere, radius: 10 mm}\nobstacles: []\n"
         "network:\n  - {module: torque_arm}\n  - {module: multiplex}\n  - {module: spaceball}\n"
         "  - {module: kbb2}\n  - {module: obstacle}\n" +
         (fixtures.empty() ? "" : "  - module: guide\n    fixtures:\n" + fixtures) +
         "  - {module: puma_kin}\n  - {module: limits}\n  - {module: puma_joints}\n"
         "script:\n"
         "  - {name: away, device: spaceball, duration: 1 s, linear: 15 -20 10 mm/s}\n";
}

std::string near(const Vec3& p, double x, double y, double z) {
  return std::to_string(p.x() + x) + " " + std::to_string(p.y() + y) + " " +
         std::to_string(p.z() + z) + " m";
}

/// A path through the start with an axis beside it, as hard as the arm allows.
std::string hard_fixtures(const Vec3& p) {
  return "      - {name: path, shape: path, stiffness: auto, points: [" + near(p, -0.1, 0.02, 0) +
         ", " + near(p, 0, 0.005, 0.01) + ", " + near(p, 0.05, 0, 0.01) + ", " +
         near(p, 0.1, 0.03, 0) +
         "]}\n      - {name: axis, shape: axis, rpy: 180 0 0 deg, position: " +
         near(p, 0.01, 0, 0) + ", stiffness: auto, angular_stiffness: auto}\n";
}

TEST(Guide, ArmsComeToRestOnHardFixturesAtEveryRateAndDelay) {
  const Folder folder;
  for (const Arm& arm : arms) {
    const std::string free = folder.with("free.yaml", scene_of(arm, 0, ""));
    const std::string log = quoted(folder / "log.csv");
    ASSERT_EQ(teleop(quoted(free) + " --fast --seconds 0.1 --log " + log).status, 0) << arm.urdf;
    const Columns at = columns_of(folder / "log.csv");
    const Vec3 p(at.at("x_m")[0], at.at("y_m")[0], at.at("z_m")[0]);
    for (const int delay : {0, 2}) {
      const std::string scene = folder.with("guided.yaml", scene_of(arm, delay, hard_fixtures(p)));
      for (const std::string rate : {"125", "400", "1000"}) {
        SCOPED_TRACE(arm.urdf + ", " + rate + " Hz, " + std::to_string(delay) + " ticks");
        const Ending ending =
            teleop(quoted(scene) + " --fast --seconds 6 --rate " + rate + " --log " + log +
                   " --report " + quoted(folder / "report.json"));
        ASSERT_EQ(ending.status, 0) << ending;
        const Columns run = columns_of(folder / "log.csv");
        for (const char* rate_of : {"vx_m_s", "vy_m_s", "vz_m_s"}) {
          EXPECT_LT(std::abs(run.at(rate_of).back()), 1e-3);
        }
        const json report = report_of(folder / "report.json");
        for (const json& module : report.at("modules")) {
          if (!module.at("claims_passive").get<bool>()) continue;
          EXPECT_LE(module.at("deficit"), 1e-9) << module;
        }
        EXPECT_FALSE(report.at("status_ticks").contains("energy_gain"));
      }
    }
  }
}

TEST(Guide, TheReportListsFixturesWithTheirGainsAndForces) {
  const Folder folder;
  const Ending run =
      teleop("follow_a_seam --fast --seconds 16 --report " + quoted(folder / "report.json"));
  ASSERT_EQ(run.status, 0) << run;
  const json report = report_of(folder / "report.json");
  for (const json& module : report.at("modules")) {
    if (module.at("name") != "guide") continue;
    const json& fixtures = module.at("fixtures");
    ASSERT_EQ(fixtures.size(), 2U);
    EXPECT_EQ(fixtures[1].at("name"), "seam");
    EXPECT_GT(fixtures[1].at("most_force_n"), 10.0);
    EXPECT_LE(fixtures[1].at("most_force_n"), 60.0);
    EXPECT_GE(fixtures[1].at("stiffness_n_per_m"), 1000.0) << "as hard as the arm allows";
    EXPECT_LE(module.at("supplied_j"), 3.0);
    return;
  }
  ADD_FAILURE() << "no guide";
}

TEST(Guide, ARunWithFixturesAndChangingComplianceIsReplayedBitForBit) {
  const Folder folder;
  const std::string log = quoted(folder / "run.mcap");
  const Ending run = teleop("follow_a_seam --fast --seconds 16 --log " + log);
  ASSERT_EQ(run.status, 0) << run;
  const Ending again = teleop("replay " + log + " --report " + quoted(folder / "replay.json"));
  ASSERT_EQ(again.status, 0) << again;
  const json result = report_of(folder / "replay.json").at("replay");
  EXPECT_EQ(result.at("same"), result.at("ticks"));
  EXPECT_GE(result.at("ticks"), 6000);
}

}  // namespace guide_test
}  // namespace repel::test
