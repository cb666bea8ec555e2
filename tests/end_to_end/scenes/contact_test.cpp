// SPDX-License-Identifier: BSD-3-Clause
// Physical walls of the engines behind the virtual walls: which of them acts first.
#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace contact_test {

using nlohmann::json;

std::string default_scene() {
  std::string text = text_of(REPEL_SOURCE "/scenes/anderson_4x8.yaml");
  const std::string folder = "../robots";
  return text.replace(text.find(folder), folder.size(), REPEL_SOURCE "/robots");
}

/// The largest penetration [m] of the tool into a solid obstacle, by the distances of the ticks.
double deepest_in_a_solid(const json& report) {
  double deepest = 0.0;
  for (const json& obstacle : report.at("obstacles")) {
    if (obstacle.at("name") == "membrane") continue;
    deepest = std::max(deepest, -obstacle.at("nearest_m").get<double>());
  }
  return deepest;
}

// With `touches` the joints are not probed for frozen encoders: the logs differ in some bits.
TEST(Contact, InTheDefaultSceneVirtualForcesArriveFirst) {
  const Folder folder;
  for (const std::string backend : {"bullet", "ode", "mujoco"}) {
    const std::string run = "anderson_4x8 --fast --seconds 20 --backend " + backend + " --log ";
    const Ending without = teleop(run + quoted(folder / "without.csv"));
    if (without.says("is not built in")) continue;
    ASSERT_EQ(without.status, 0) << without;
    EXPECT_FALSE(without.says("physical contact")) << without;
    const Ending with = teleop(run + quoted(folder / "with.csv") + " --contact --report " +
                               quoted(folder / "r.json"));
    ASSERT_EQ(with.status, 0) << with;
    EXPECT_TRUE(with.says("physical contact       none")) << with;
    EXPECT_EQ(report_of(folder / "r.json").at("physical_contact").at("steps"), 0) << backend;
    const Columns alone = columns_of(folder / "without.csv");
    const Columns solid = columns_of(folder / "with.csv");
    for (const char* axis : {"x_m", "y_m", "z_m"}) {
      const auto& p = alone.at(axis);
      ASSERT_EQ(p.size(), solid.at(axis).size());
      for (std::size_t i = 0; i < p.size(); ++i) {
        ASSERT_NEAR(p[i], solid.at(axis)[i], 1e-3) << backend << ", " << axis << ", row " << i;
      }
    }
  }
}

TEST(Contact, WhereTheWallsDoNotPushTheyHoldTheToolAllTheSame) {
  const Folder folder;
  std::string text = default_scene();
  const std::string law = "surface_force: 200 N, damping: 100 N s/m";
  text.replace(text.find(law), law.size(), "surface_force: 0 N, damping: 0 N s/m");
  const std::string scene = quoted(folder.with("silent.yaml", text));
  for (const std::string backend : {"bullet", "ode"}) {
    const auto run = [&](const std::string& contact) {
      const Ending ending =
          teleop(scene + " --fast --seconds 20 --backend " + backend + contact + " --log " +
                 quoted(folder / "log.csv") + " --report " + quoted(folder / "r.json"));
      EXPECT_EQ(ending.status, 0) << ending;
      EXPECT_EQ(ending.says("physical contact       in "), !contact.empty()) << ending;
      return report_of(folder / "r.json");
    };
    const json without = run("");
    EXPECT_GT(deepest_in_a_solid(without), 0.02) << backend;
    EXPECT_TRUE(without.at("physical_contact").is_null());
    const json with = run(" --contact");
    expect_finite_forces(columns_of(folder / "log.csv"));
    EXPECT_LT(deepest_in_a_solid(with), 0.001) << backend;
    EXPECT_GT(with.at("physical_contact").at("steps"), 1000) << backend;
    const double deepest = with.at("physical_contact").at("deepest_m");
    EXPECT_LT(deepest, 0.001) << backend;
    EXPECT_NEAR(deepest, deepest_in_a_solid(with), 3e-4)
        << backend << ": two measures of one depth";
  }
}

TEST(Contact, AnObstacleThatMovesIsRefusedByName) {
  const Folder folder;
  const std::string text = robot_text() + table_text() +
                           "  - {name: gate, shape: sphere, radius: 10 mm, position: 2 0 0 m, "
                           "motion: {along: 0 1 0 m, duration: 4 s}}\n";
  const Ending ending =
      teleop(quoted(folder.with("gate.yaml", text)) + " --fast --seconds 0.1 --contact");
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("'gate' has a motion") && ending.says("gate.yaml")) << ending;
}

/// A table without virtual forces, a network with a force sensor, and a script that presses.
std::string scene_to_feel(const std::string& sensor, const std::string& errors = "") {
  std::string text = robot_text(REPEL_SOURCE "/robots/puma560.urdf", errors) + table_text();
  const std::string law = "surface_force: 40 N, damping: 1 N s/m";
  text.replace(text.find(law), law.size(), "surface_force: 0 N, damping: 0 N s/m");
  return text +
         "network:\n  - {module: torque_arm}\n  - {module: multiplex}\n  - {module: spaceball}\n"
         "  - {module: kbb2}\n  - {module: obstacle}\n  - {module: puma_kin}\n"
         "  - {module: limits}\n" +
         sensor +
         "  - {module: puma_joints}\n"
         "script:\n"
         "  - {name: wait, device: spaceball, duration: 1 s}\n"
         "  - {name: push, device: spaceball, duration: 1.2 s, linear: 0 0 -50 mm/s}\n"
         "  - {name: rest, device: spaceball, duration: 2.8 s}\n";
}

TEST(Contact, IsMeasuredAndItsRunRepeatsBitForBit) {
  const Folder folder;
  const std::string scene = quoted(folder.with(
      "felt.yaml", scene_to_feel("  - {module: force_sensor, tare: 0.2 s}\n",
                                 "  links: []\n  sensor_errors: {force_noise: 0.5 N, "
                                 "torque_noise: 10 mN m, force_bias: 3 -2 1 N, seed: 7}\n")));
  for (const std::string backend : {"bullet", "ode", "mujoco"}) {
    const std::string run = scene + " --fast --seconds 5 --backend " + backend + " --report " +
                            quoted(folder / "r.json") + " --log " + quoted(folder / "log.mcap");
    const Ending ending = teleop(run + " --contact");
    if (ending.says("is not built in")) continue;
    ASSERT_EQ(ending.status, 0) << ending;
    EXPECT_TRUE(ending.says("measured")) << ending;
    const json touched = report_of(folder / "r.json");
    EXPECT_GT(touched.at("physical_contact").at("steps"), 400) << backend;
    EXPECT_GT(touched.at("peak_measured_force_n"), 20.0) << backend;
    EXPECT_EQ(touched.at("sensor_saturated_ticks"), 0) << backend;
    EXPECT_EQ(touched.at("sensor_lost_ticks"), 0) << backend;
    const Ending again = teleop("replay " + quoted(folder / "log.mcap") + " --report " +
                                quoted(folder / "again.json"));
    ASSERT_EQ(again.status, 0) << again;
    const json replayed = report_of(folder / "again.json");
    EXPECT_EQ(replayed.at("replay").at("same"), 2000) << backend;
    EXPECT_EQ(replayed.at("peak_measured_force_n"), touched.at("peak_measured_force_n"));
    EXPECT_TRUE(replayed.at("physical_contact").is_null());
    ASSERT_EQ(teleop(run).status, 0);
    EXPECT_LT(report_of(folder / "r.json").at("peak_measured_force_n"), 2.0)
        << backend << ": noise alone, without its bias";
  }
}

/// The mean of a column over `ticks` ticks from `first` on.
double mean_of(const Columns& log, const char* column, std::size_t first, std::size_t ticks) {
  const std::vector<double>& all = log.at(column);
  double sum = 0.0;
  for (std::size_t i = first; i < first + ticks; ++i) sum += all.at(i);
  return sum / static_cast<double>(ticks);
}

TEST(Contact, IsFeltOnceThroughASensorAndFrictionLess) {
  const Folder folder;
  const auto log_with = [&](const std::string& sensor) {
    const Ending ending =
        teleop(quoted(folder.with("felt.yaml", scene_to_feel(sensor))) +
               " --fast --seconds 5 --contact --log " + quoted(folder / "log.csv"));
    EXPECT_EQ(ending.status, 0) << ending;
    return columns_of(folder / "log.csv");
  };
  const Columns without = log_with("");
  const Columns with = log_with("  - {module: force_sensor}\n");
  // In the last second the coupling presses on the table, as hard as without the sensor.
  const double pressed = mean_of(without, "coupling_fz_n", 1600, 400);
  EXPECT_LT(pressed, -20.0);
  EXPECT_NEAR(mean_of(with, "coupling_fz_n", 1600, 400), pressed, 2.0);
  // On the way there only friction and inertia are felt.
  const double drag = mean_of(without, "coupling_fz_n", 480, 80);
  EXPECT_LT(drag, -3.0);
  EXPECT_LT(std::abs(mean_of(with, "coupling_fz_n", 480, 80)), 0.75 * std::abs(drag));
}

TEST(Contact, SensorAtAnotherPlaceIsRefusedWithItsLine) {
  const Folder folder;
  std::string text = scene_to_feel("");
  const std::string before = "  - {module: limits}\n";
  text.replace(text.find(before), before.size(), "  - {module: force_sensor}\n" + before);
  const Ending ending =
      teleop(quoted(folder.with("felt.yaml", text)) + " --fast --seconds 0.1 --contact");
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("'force_sensor' must be the last module before 'puma_joints'")) << ending;
}

}  // namespace contact_test
}  // namespace repel::test
