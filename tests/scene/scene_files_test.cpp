// SPDX-License-Identifier: BSD-3-Clause
// The scenes of the repository and the page on their format.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include <repel/base/capacities.hpp>
#include <repel/common/input_limits.hpp>
#include <scene/yaml_text.hpp>

namespace repel::scene {
namespace scene_files_test {

std::string text_of(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The first fenced block of YAML in a Markdown page.
std::string example_in(const std::string& page) {
  const std::string fence = "```yaml\n";
  const auto begin = page.find(fence) + fence.size();
  return page.substr(begin, page.find("```", begin) - begin);
}

TEST(SceneFiles, TheExampleOfThePageLoads) {
  const std::string page = text_of("scenes/README.md");
  ASSERT_NE(page.find("```yaml\n"), std::string::npos);
  const Scene scene = parse(example_in(page), "scenes/README.md");
  EXPECT_EQ(scene.tool.size(), 1U);
  EXPECT_EQ(scene.obstacles.size(), 1U);
  EXPECT_EQ(scene.obstacles[0].law.surface_force, 120.0);
  EXPECT_EQ(scene.script.size(), 2U);
}

TEST(SceneFiles, EveryKeyOfTheSchemaIsOnThePage) {
  const std::string page = text_of("scenes/README.md");
  const std::string of_json = "type items properties required pattern description minimum maximum";
  const std::string text = schema();
  int keys = 0;
  for (auto end = text.find("\":"); end != std::string::npos; end = text.find("\":", end + 1)) {
    const auto begin = text.rfind('"', end - 1) + 1;
    const std::string name = text.substr(begin, end - begin);
    if (name.find_first_not_of("abcdefghijklmnopqrstuvwxyz_") != std::string::npos) continue;
    if (of_json.find(name) != std::string::npos || name == "enum" || name == "const" ||
        name == "if" || name == "then" || name == "title") {
      continue;
    }
    EXPECT_NE(page.find("`" + name + "`"), std::string::npos) << name << " is not on the page";
    ++keys;
  }
  EXPECT_GT(keys, 200);
}

TEST(SceneFiles, TheLimitsOnThePageAreThoseThatHold) {
  const std::string page = text_of("scenes/README.md");
  const auto expect_row = [&](const std::string& what, std::size_t most) {
    const auto at = page.find("| " + what);
    ASSERT_NE(at, std::string::npos) << what;
    const std::string row = page.substr(at, page.find('\n', at) - at);
    EXPECT_NE(row.find(" | " + std::to_string(most)), std::string::npos) << row;
  };
  expect_row("the file", input_limits.file_bytes);
  expect_row("one text", input_limits.text_bytes);
  expect_row("one list or map", input_limits.entries);
  expect_row("`partners` |", static_cast<std::size_t>(Capacities{}.bodies));
  expect_row("`network` of one arm", input_limits.modules);
  expect_row("`points` of one hull", 10000);
  expect_row("`points` of all hulls", input_limits.hull_points);
  expect_row("values in all", input_limits.values);
  expect_row("lists and maps in each other", input_limits.depth);
  expect_row("lines that begin with `%`", input_limits.directives);
}

TEST(SceneFiles, EverySceneLoads) {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator("scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    const Scene scene = load(entry.path().string());
    EXPECT_EQ(scene.name, entry.path().stem().string());
    EXPECT_FALSE(scene.script.empty()) << scene.name;
    EXPECT_GE(scene.robot.start.size(), 6U) << scene.name;
    ++scenes;
  }
  EXPECT_GE(scenes, 3);
}

TEST(SceneFiles, TheSceneOfThePaperHasItsNumbers) {
  const Scene scene = load("scenes/anderson_4x8.yaml");
  EXPECT_EQ(scene.rate_hz, 400.0);
  EXPECT_EQ(scene.tool.size(), 4U);
  EXPECT_EQ(scene.obstacles.size(), 8U);
  double duration = 0.0;
  bool with_lever = false;
  for (const auto& phase : scene.script) {
    duration += phase.duration;
    with_lever = with_lever || phase.master == network::Master::torque_arm;
  }
  EXPECT_GT(duration, 15.0);
  EXPECT_LT(duration, 30.0);
  EXPECT_TRUE(with_lever);
}

TEST(SceneFiles, ThousandsOfObstaclesLoad) {
  std::string text = testing::base_scene;
  for (int i = 1; i < 2500; ++i) {
    text += "  - {name: wall_" + std::to_string(i) +
            ", shape: box, size: 1 2 3 cm, position: " + std::to_string(i) + " 0 0 mm}\n";
  }
  const Scene scene = testing::parsed(text);
  ASSERT_EQ(scene.obstacles.size(), 2500U);
  EXPECT_EQ(scene.obstacles[2499].X_WP.translation().x(), 2.499);
}

TEST(SceneFiles, AnErrorAmongThousandsNamesItsLine) {
  std::string text = testing::base_scene;
  for (int i = 1; i < 2500; ++i) {
    const std::string size = i == 2000 ? "1 2 cm" : "1 2 3 cm";
    text += "  - {name: wall_" + std::to_string(i) + ", shape: box, size: " + size + "}\n";
  }
  try {
    (void)testing::parsed(text);
    FAIL() << "the scene was accepted";
  } catch (const SetupError& error) {
    EXPECT_EQ(error.line(), 2007);
  }
}

}  // namespace scene_files_test
}  // namespace repel::scene
