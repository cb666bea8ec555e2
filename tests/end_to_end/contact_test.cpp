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

TEST(Contact, InTheDefaultSceneVirtualForcesArriveFirstAndNoBitIsAnother) {
  const Folder folder;
  for (const std::string backend : {"bullet", "ode"}) {
    const std::string run = "anderson_4x8 --fast --seconds 20 --backend " + backend + " --log ";
    const Ending without = teleop(run + quoted(folder / "without.csv"));
    ASSERT_EQ(without.status, 0) << without;
    EXPECT_FALSE(without.says("physical contact")) << without;
    const Ending with = teleop(run + quoted(folder / "with.csv") + " --contact --report " +
                               quoted(folder / "r.json"));
    ASSERT_EQ(with.status, 0) << with;
    EXPECT_TRUE(with.says("physical contact       none")) << with;
    EXPECT_EQ(report_of(folder / "r.json").at("physical_contact").at("steps"), 0) << backend;
    EXPECT_TRUE(text_of(folder / "without.csv") == text_of(folder / "with.csv")) << backend;
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

}  // namespace contact_test
}  // namespace repel::test
