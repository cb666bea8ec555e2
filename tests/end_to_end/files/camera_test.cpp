// SPDX-License-Identifier: BSD-3-Clause
// What only a depth camera sees keeps its distance from the arm, whatever the camera is like.
#include "end_to_end/teleop.hpp"
#include "support/draws.hpp"
#include "support/families.hpp"

namespace repel::test {
namespace camera_test {

using nlohmann::json;

/// The scene, with some of its text changed.
std::string seen_with(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::string text = text_of(REPEL_SOURCE "/scenes/seen.yaml");
  const auto change = [&](const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
  };
  change("../robots", REPEL_SOURCE "/robots");
  for (const auto& [from, to] : changes) change(from, to);
  return text;
}

json run_of(const std::string& scene, const std::string& options, double seconds = 20.0) {
  const Folder folder;
  const Ending ending =
      teleop(quoted(folder.with("scene.yaml", scene)) + " --fast --seconds " +
             std::to_string(seconds) + " " + options + " --report " + quoted(folder / "r.json"));
  EXPECT_EQ(ending.status, 0) << ending;
  return report_of(folder / "r.json");
}

TEST(Camera, KeepsTheArmOffWhatOnlyItSeesWhateverItIsLike) {
  constexpr unsigned seed = 320;
  families::Rng rng(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(rng);
  };
  const int draws = std::max(1, families::draws(3));
  int touched = 0;
  for (int i = 0; i < draws; ++i) {
    const double noise = between(0.0, 1.2);
    const double lost = between(0.0, 0.3);
    const double rate = between(20.0, 60.0);
    const auto place = [&](double x, double y, const char* z) {
      return "position: " + std::to_string(x + between(-0.02, 0.02)) + " " +
             std::to_string(y + between(-0.02, 0.02)) + " " + z;
    };
    const std::string scene =
        seen_with({{"noise: 1 mm", "noise: " + std::to_string(noise) + " mm"},
                   {"lost: 0.02", "lost: " + std::to_string(lost)},
                   {"rate: 30 Hz", "rate: " + std::to_string(rate) + " Hz"},
                   {"parts: 600", "parts: 600\n  seed: " + std::to_string(i)},
                   {"unseen: free", i % 2 == 0 ? "unseen: free" : "unseen: solid"},
                   {"position: 0.62 0.20 0.21", place(0.62, 0.20, "0.21")},
                   {"position: 0.52 -0.30 0.19", place(0.52, -0.30, "0.19")}});
    const json camera = run_of(scene, "").at("camera");
    SCOPED_TRACE("seed " + std::to_string(seed) + ", draw " + std::to_string(i) + "\n" + scene +
                 camera.dump(1));
    EXPECT_GT(camera.at("least_clearance_m"), 0.002);
    EXPECT_EQ(camera.at("cells_left_out"), 0);
    EXPECT_GT(camera.at("images"), 300);
    if (camera.at("least_clearance_m") < 0.02) ++touched;
  }
  EXPECT_GE(2 * touched, draws) << "the arm should come near what is seen";
}

TEST(Camera, IsTheOnlyOneThatKnowsWhatItSees) {
  // Without its images the bottle is run into: the test above means something.
  const std::string blind = seen_with({{"duration: 0.5 s}", "duration: 0.5 s, blind: yes}"},
                                       {"rate: 30 Hz", "rate: 1 Hz"},
                                       {"latency: 33 ms", "latency: 10 s"},
                                       {"parts: 600", "parts: 600\n  silent_after: 100 s"}});
  EXPECT_LT(run_of(blind, "", 5.0).at("camera").at("least_clearance_m"), 0.0);
}

TEST(Camera, SilentIsAnOperatorThatIsSilent) {
  const json report = run_of(seen_with({}), "", 9.8);
  const double silent = report.at("camera").at("silent_s");
  EXPECT_GT(silent, 0.5);
  EXPECT_LT(silent, 1.0);
  EXPECT_GT(report.at("status_ticks").at("silent_device"), 200);
  // At any rate, and whatever simulates the arm.
  for (const char* options : {"--rate 100", "--rate 1000 --backend ode"}) {
    const json camera = run_of(seen_with({}), options, 9.8).at("camera");
    EXPECT_NEAR(camera.at("silent_s"), silent, 0.05) << options;
    EXPECT_GT(camera.at("least_clearance_m"), 0.002) << options;
  }
}

TEST(Camera, IsReplayedBitForBitUnlessTheRunWasByTheClock) {
  const Folder folder;
  const std::string file = quoted(folder / "seen.mcap");
  const Ending recorded = teleop("seen --fast --seconds 4 --log " + file);
  ASSERT_EQ(recorded.status, 0) << recorded;
  const Ending again = teleop("replay " + file);
  ASSERT_EQ(again.status, 0) << again;
  EXPECT_TRUE(again.says("1600 of 1600 ticks, bit for bit")) << again;
  const Ending refused = teleop("seen --seconds 1 --log " + file);
  EXPECT_EQ(refused.status, 1);
  EXPECT_TRUE(refused.says("allowed: with --fast, or a CSV file")) << refused;
  const Ending by_the_clock = teleop("seen --seconds 2 --log " + quoted(folder / "seen.csv"));
  EXPECT_EQ(by_the_clock.status, 0) << by_the_clock;
  EXPECT_TRUE(by_the_clock.says("allocations in tick    0")) << by_the_clock;
}

/// The scene with two cameras at its sides instead of its own.
std::string seen_by_two(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::string text = seen_with(changes);
  const std::size_t begin = text.find("\ncamera:\n") + 1;
  const std::size_t end = text.find("hidden:\n");
  const std::string both =
      "width: 240, height: 180, view: 60 deg, nearest: 300 mm, farthest: 2.5 m, latency: 33 ms, "
      "noise: 1 mm, lost: 0.02, margin: 10 mm, parts: 500, law: seen, look_at: 0.5 -0.1 0.15 m";
  return text.replace(begin, end - begin,
                      "cameras:\n  - {name: left, position: 1.2 0.5 0.95 m, rate: 30 Hz, " + both +
                          "}\n  - {name: right, position: 1.1 -0.8 0.8 m, rate: 25 Hz, seed: 2, " +
                          both + "}\n");
}

TEST(Camera, IsOneOfSeveralEachWithPartsOfItsOwn) {
  const json report = run_of(seen_by_two({}), "");
  EXPECT_GT(report.at("camera").at("least_clearance_m"), 0.002);
  EXPECT_LT(report.at("camera").at("least_clearance_m"), 0.03) << "it should come near";
  const json& cameras = report.at("cameras");
  ASSERT_EQ(cameras.size(), 2U);
  EXPECT_EQ(cameras[0].at("name"), "left");
  std::int64_t images = 0;
  for (const json& camera : cameras) {
    EXPECT_GT(camera.at("images"), 300);
    EXPECT_GT(camera.at("parts_made"), 50);
    EXPECT_EQ(camera.at("cells_left_out"), 0);
    images += camera.at("images").get<std::int64_t>();
  }
  EXPECT_EQ(report.at("camera").at("images"), images);
  EXPECT_GT(cameras[0].at("images"), cameras[1].at("images")) << "30 Hz and 25 Hz";
  std::vector<std::string> felt;
  for (const json& obstacle : report.at("obstacles")) {
    if (obstacle.at("peak_force_n") > 1.0) felt.push_back(obstacle.at("name"));
  }
  for (const char* name : {"seen_left", "seen_right"}) {
    EXPECT_EQ(std::count(felt.begin(), felt.end(), name), 1) << name;
  }
}

TEST(Camera, OfSeveralKeepsTheArmOffWhatItAloneSees) {
  // The other one looks away.
  for (const char* look_at : {"look_at: 3 3 0.15 m", "look_at: 3 -3 0.15 m"}) {
    std::string scene = seen_by_two({});
    const bool is_left = std::string(look_at).find("-3") == std::string::npos;
    const std::string away = "look_at: 0.5 -0.1 0.15 m";
    scene.replace(is_left ? scene.find(away) : scene.rfind(away), away.size(), look_at);
    const json report = run_of(scene, "", 5.0);
    EXPECT_GT(report.at("camera").at("least_clearance_m"), 0.002) << look_at;
    EXPECT_EQ(report.at("cameras")[is_left ? 0 : 1].at("parts_made"), 0) << look_at;
    EXPECT_GT(report.at("cameras")[is_left ? 1 : 0].at("parts_made"), 20) << look_at;
  }
}

TEST(Camera, OfSeveralSilencesTheOperatorAlone) {
  const json report = run_of(seen_by_two({{"blind: yes", "blind: right"}}), "", 9.8);
  EXPECT_EQ(report.at("cameras")[0].at("silent_s"), 0.0);
  const double silent = report.at("cameras")[1].at("silent_s");
  EXPECT_GT(silent, 0.5);
  EXPECT_EQ(report.at("camera").at("silent_s"), silent);
  EXPECT_GT(report.at("status_ticks").at("silent_device"), 200);
}

TEST(Camera, OfSeveralIsReplayedBitForBit) {
  const Folder folder;
  const std::string scene = quoted(folder.with("scene.yaml", seen_by_two({})));
  const std::string file = quoted(folder / "seen.mcap");
  const Ending recorded = teleop(scene + " --fast --seconds 2 --log " + file);
  ASSERT_EQ(recorded.status, 0) << recorded;
  EXPECT_TRUE(recorded.says("  left                   ")) << recorded;
  const Ending again = teleop("replay " + file);
  ASSERT_EQ(again.status, 0) << again;
  EXPECT_TRUE(again.says("800 of 800 ticks, bit for bit")) << again;
  const Ending by_the_clock = teleop(scene + " --seconds 2");
  EXPECT_EQ(by_the_clock.status, 0) << by_the_clock;
  EXPECT_TRUE(by_the_clock.says("allocations in tick    0")) << by_the_clock;
}

#ifdef REPEL_RUNS_OCTREES
TEST(Camera, WithAMapKeepsTheArmOffWhatOnlyItSees) {
  constexpr unsigned seed = 321;
  families::Rng rng(seed);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(rng);
  };
  const int draws = std::max(1, families::draws(2));
  int touched = 0;
  for (int i = 0; i < draws; ++i) {
    const std::string cube = std::to_string(between(20.0, 50.0)) + " mm";
    const auto place = [&](double x, double y, const char* z) {
      return "position: " + std::to_string(x + between(-0.02, 0.02)) + " " +
             std::to_string(y + between(-0.02, 0.02)) + " " + z;
    };
    const std::string scene =
        seen_with({{"parts: 600", "parts: 800\n  map: {cube: " + cube + "}"},
                   {"noise: 1 mm", "noise: " + std::to_string(between(0.0, 1.2)) + " mm"},
                   {"lost: 0.02", "lost: " + std::to_string(between(0.0, 0.3))},
                   {"position: 0.62 0.20 0.21", place(0.62, 0.20, "0.21")},
                   {"position: 0.52 -0.30 0.19", place(0.52, -0.30, "0.19")}});
    const json camera = run_of(scene, "").at("camera");
    SCOPED_TRACE("seed " + std::to_string(seed) + ", draw " + std::to_string(i) + "\n" + scene +
                 camera.dump(1));
    EXPECT_GT(camera.at("least_clearance_m"), 0.002);
    EXPECT_EQ(camera.at("cells_left_out"), 0);
    EXPECT_GT(camera.at("images"), 300);
    EXPECT_GE(camera.at("largest_cube_m"), 0.02);
    if (camera.at("least_clearance_m") < 0.06) ++touched;
  }
  EXPECT_GE(2 * touched, draws) << "the arm should come near what is seen";
}

TEST(Camera, WithAMapIsReplayedBitForBit) {
  const Folder folder;
  const std::string scene = quoted(
      folder.with("scene.yaml", seen_with({{"parts: 600", "parts: 600\n  map: {cube: 5 cm}"}})));
  const std::string file = quoted(folder / "seen.mcap");
  const Ending recorded = teleop(scene + " --fast --seconds 2 --log " + file);
  ASSERT_EQ(recorded.status, 0) << recorded;
  const Ending again = teleop("replay " + file);
  ASSERT_EQ(again.status, 0) << again;
  EXPECT_TRUE(again.says("800 of 800 ticks, bit for bit")) << again;
  const Ending by_the_clock = teleop(scene + " --seconds 2");
  EXPECT_EQ(by_the_clock.status, 0) << by_the_clock;
  EXPECT_TRUE(by_the_clock.says("allocations in tick    0")) << by_the_clock;
}
#endif

TEST(Camera, IsRefusedWithLineAndCureWhereItMakesNoSense) {
  const auto refusal = [&](const std::vector<std::pair<std::string, std::string>>& changes) {
    const Folder folder;
    const Ending ending =
        teleop(quoted(folder.with("scene.yaml", seen_with(changes))) + " --fast --seconds 0.1");
    EXPECT_EQ(ending.status, 1) << ending;
    return ending.err;
  };
  EXPECT_NE(refusal({{"rate: 30 Hz", "rate: 2 Hz"}}).find("silent between two images"),
            std::string::npos);
  EXPECT_NE(refusal({{"look_at: 0.50 -0.10 0.15 m", "look_at: 1.25 0.35 0.95 m"}}).find("look_at"),
            std::string::npos);
  EXPECT_NE(refusal({{"hidden:", "spare: {count: 2}\nhidden:"}}).find("one of the two"),
            std::string::npos);
  EXPECT_NE(refusal({{"shape: cone", "law: wall, shape: cone"}}).find("law"), std::string::npos);
}

}  // namespace camera_test
}  // namespace repel::test
