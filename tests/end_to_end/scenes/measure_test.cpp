// SPDX-License-Identifier: BSD-3-Clause
// How overlaps are measured: by the scene, by the command line, in the report and in a replay.
#include <algorithm>
#include <map>
#include <string>

#include "end_to_end/rewriting.hpp"
#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace measure_test {

using Entries = std::map<std::string, std::string>;

/// A block that is pressed some centimetres into a soft table, edge first, and slides in it.
std::string soft_scene(const std::string& keys = "") {
  return keys +
         "robot:\n  urdf: " REPEL_SOURCE
         "/robots/puma560.urdf\n"
         "  start: 0 45 -180 0 -45 0 deg\n  tool_frame: {position: 0 0 100 mm}\n  links: []\n"
         "tool:\n  - {name: block, shape: box, size: 80 60 40 mm, rpy: 45 0 0 deg}\n"
         "laws: {default: {range: 5 mm, surface_force: 5 N}}\n"
         "obstacles:\n"
         "  - {name: table, shape: box, size: 0.6 0.8 0.12 m, position: 0.6 -0.15 0.4 m}\n"
         "script:\n"
         "  - {name: down, device: spaceball, duration: 1 s, linear: 0 0 -60 mm/s}\n"
         "  - {name: slide, device: spaceball, duration: 1 s, linear: 30 0 0 mm/s}\n";
}

struct Outcome {
  nlohmann::json report;
  Ending ending;
};

Outcome run_of(const std::string& arguments) {
  const Folder folder;
  const Ending ending = teleop(arguments + " --report " + quoted(folder / "report.json"));
  EXPECT_EQ(ending.status, 0) << arguments << ending;
  return {report_of(folder / "report.json"), ending};
}

TEST(MeasureOfOverlaps, IsThatOfTheSceneOrOfTheCommandLine) {
  const Folder folder;
  const std::string plain = folder.with("plain.yaml", soft_scene());
  const std::string reduced =
      folder.with("reduced.yaml", soft_scene("measure: reduction\nlevels: 4\n"));
  const auto log_of = [&](const std::string& scene, const std::string& options) {
    const Outcome run = run_of(quoted(scene) + " --fast --seconds 2 " + options + " --log " +
                               quoted(folder / "log.csv"));
    EXPECT_LT(run.report.at("nearest_m"), -0.005) << options;
    return text_of(folder / "log.csv");
  };
  const std::string by_scene = log_of(reduced, "");
  EXPECT_TRUE(by_scene == log_of(plain, "--measure reduction --levels 4"));
  EXPECT_FALSE(by_scene == log_of(reduced, "--levels 5"));
  EXPECT_FALSE(by_scene == log_of(plain, "--measure exact"));
  const std::string by_default = log_of(plain, "");
  EXPECT_FALSE(by_scene == by_default);
  EXPECT_TRUE(by_default == log_of(reduced, "--measure deepest_point"));
  EXPECT_TRUE(by_default == log_of(plain, "--levels 64")) << "no measure of the scene has levels";
}

TEST(MeasureOfOverlaps, IsInTheReportsWithTheLevelsItNeeds) {
  const Folder folder;
  const std::string scene = quoted(folder.with("scene.yaml", soft_scene())) + " --fast ";
  const Outcome plain = run_of(scene + "--seconds 2");
  EXPECT_EQ(plain.report.at("measure"), "deepest_point");
  EXPECT_TRUE(plain.report.at("levels").is_null());
  EXPECT_FALSE(plain.ending.says("measure of overlaps"));
  const auto skips_levels = [](const Outcome& run) {
    const auto& parts = run.report.at("skipped");
    return std::count(parts.begin(), parts.end(), "reduction levels") == 1;
  };
  EXPECT_TRUE(skips_levels(plain));
  const Outcome reduced =
      run_of(scene + "--seconds 2 --measure reduction --html " + quoted(folder / "page.html"));
  EXPECT_EQ(reduced.report.at("measure"), "reduction");
  EXPECT_EQ(reduced.report.at("levels"), 8);
  EXPECT_TRUE(reduced.ending.says("measure of overlaps")) << reduced.ending;
  EXPECT_TRUE(reduced.ending.says("reduction, 8 levels")) << reduced.ending;
  EXPECT_FALSE(skips_levels(reduced));
  EXPECT_NE(text_of(folder / "page.html").find("overlaps by reduction"), std::string::npos);
  const Outcome exact = run_of(scene + "--seconds 0.1 --measure exact --levels 3");
  EXPECT_EQ(exact.report.at("measure"), "exact");
  EXPECT_TRUE(exact.report.at("levels").is_null()) << "there are only boxes";
}

TEST(MeasureOfOverlaps, ComesAgainInAReplayBitForBit) {
  const Folder folder;
  const std::string file = folder / "run.mcap";
  const std::string scene = folder.with("scene.yaml", soft_scene("measure: exact\n"));
  (void)run_of(quoted(scene) + " --fast --seconds 2 --measure reduction --levels 5 --log " +
               quoted(file));
  const auto expect_same = [](const std::string& recording, const std::string& measure) {
    const Outcome replay = run_of("replay " + quoted(recording));
    EXPECT_EQ(replay.report.at("measure"), measure);
    EXPECT_EQ(replay.report.at("replay").at("ticks"), 800);
    EXPECT_EQ(replay.report.at("replay").at("same"), 800);
    return replay.report.at("levels");
  };
  EXPECT_EQ(expect_same(file, "reduction"), 5);
  // A recording that does not say follows its scene.
  (void)run_of(quoted(scene) + " --fast --seconds 2 --log " + quoted(file));
  const std::string older = folder / "older.mcap";
  rewrite(file, older, {.options = [](Entries& options) {
            EXPECT_EQ(options.erase("measure") + options.erase("levels"), 2U);
          }});
  EXPECT_TRUE(expect_same(older, "exact").is_null());
}

TEST(MeasureOfOverlaps, ThatIsNoneIsRefusedWithThoseThereAre) {
  for (const char* arguments :
       {"--measure tree", "--measure ''", "--measure", "--levels 0", "--levels 65", "--levels many",
        "replay x.mcap --measure exact", "replay x.mcap --levels 8"}) {
    const Ending ending = teleop(arguments);
    EXPECT_EQ(ending.status, 2) << arguments << '\n' << ending;
  }
  const Ending ending = teleop("--measure tree");
  for (const char* words : {"--measure", "tree", "deepest_point", "reduction", "exact"}) {
    EXPECT_TRUE(ending.says(words)) << words << '\n' << ending;
  }
  const Folder folder;
  const std::string file = folder / "run.mcap";
  (void)run_of("empty --fast --seconds 0.1 --log " + quoted(file));
  const auto expect_refused = [&](const char* key, const char* value, const char* allowed) {
    const std::string other = folder / "other.mcap";
    rewrite(file, other, {.options = [&](Entries& options) { options[key] = value; }});
    const Ending refused = teleop("replay " + quoted(other));
    EXPECT_EQ(refused.status, 1) << refused;
    for (const char* words : {"other.mcap", key, value, allowed}) {
      EXPECT_TRUE(refused.says(words)) << words << refused;
    }
  };
  expect_refused("measure", "tree", "deepest_point, reduction, exact");
  expect_refused("levels", "65", "0 to 64");
}

}  // namespace measure_test
}  // namespace repel::test
