// SPDX-License-Identifier: BSD-3-Clause
// Other values than those of a scene file, by their paths.
#include <numbers>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <repel/network/modules/kbb2.hpp>

#include <scene/yaml_text.hpp>

namespace repel::scene {
namespace change_test {

constexpr double degree = std::numbers::pi / 180.0;

const std::string text = testing::base_scene +
                         "  - {name: side, shape: box, size: 1 1 1 m, law: &glass soft}\n"
                         "laws: {soft: {range: 10 mm, damping: 5 N s/m}, default: {range: 5 mm}}\n"
                         "network: [{module: spaceball}, {module: kbb2, stiffness: 3 N/mm}]\n";

Scene with(std::vector<Change> changes) {
  return parse(text, "scenes/test.yaml", {}, std::move(changes));
}

std::string complaint(std::vector<Change> changes) {
  try {
    (void)with(std::move(changes));
  } catch (const SetupError& error) {
    return error.what();
  }
  return "none";
}

TEST(Change, ReplacesAValueAndNothingElse) {
  const Scene scene = with({{"laws.soft.range", "30 mm"}});
  EXPECT_EQ(scene.obstacles[1].law.range, 0.03);
  EXPECT_EQ(scene.obstacles[1].law.damping, 5.0);
  EXPECT_EQ(scene.obstacles[0].law.range, 0.005);
  ASSERT_EQ(scene.changes.size(), 1);
  EXPECT_EQ(scene.changes[0].path, "laws.soft.range");
}

TEST(Change, FindsEntriesByNameModuleOrNumber) {
  EXPECT_EQ(with({{"obstacles.side.law", "default"}}).obstacles[1].law.range, 0.005);
  EXPECT_EQ(with({{"obstacles.1.law", "default"}}).obstacles[1].law.range, 0.005);
  const Scene scene = with({{"network.kbb2.stiffness", "4 N/mm"}});
  EXPECT_EQ(std::any_cast<network::Kbb2Options>(scene.network.modules[1].options).stiffness, 4e3);
}

TEST(Change, ReplacesOneNumberOfSeveral) {
  const std::vector<double> start = with({{"robot.start.1", "44.5"}}).robot.start;
  EXPECT_DOUBLE_EQ(start[0], 0.0);
  EXPECT_DOUBLE_EQ(start[1], 44.5 * degree);
  EXPECT_DOUBLE_EQ(start[2], 180.0 * degree);
}

TEST(Change, AddsWhatIsNotThere) {
  EXPECT_EQ(with({{"robot.payload.mass", "2 kg"}}).robot.payload.mass, 2.0);
  EXPECT_EQ(with({{"tool_speed", "0.5 m/s"}}).tool_speed, 0.5);
}

TEST(Change, MayBeAListOrAMapAndTheLastCounts) {
  const Scene scene = with({{"laws.soft", "{range: 7 mm}"}, {"laws.soft.range", "8 mm"}});
  EXPECT_EQ(scene.obstacles[1].law.range, 0.008);
  EXPECT_NE(scene.obstacles[1].law.damping, 5.0);
}

TEST(Change, LeavesTheOtherUsersOfAnAliasAlone) {
  const std::string shared =
      testing::base_scene + "laws: {a: &law {range: 10 mm}, b: *law, default: *law}\n";
  const Scene scene = parse(shared, "scenes/test.yaml", {}, {{"laws.a.range", "30 mm"}});
  EXPECT_EQ(scene.obstacles[0].law.range, 0.01);
}

TEST(Change, ThatLeadsNowhereIsRefusedWithWhatIsAllowed) {
  EXPECT_NE(complaint({{"obstacles.wal.law", "soft"}}).find("or one of wall, side"),
            std::string::npos);
  EXPECT_NE(complaint({{"robot.start.6", "1"}}).find("a number below 6"), std::string::npos);
  EXPECT_NE(complaint({{"robot.start.x", "1"}}).find("a number below 6"), std::string::npos);
  EXPECT_NE(complaint({{"laws.soft.rang", "1 mm"}}).find("did you mean 'range'?"),
            std::string::npos);
  for (const char* path : {"", ".", ".rate", "rate."}) {
    EXPECT_NE(complaint({{path, "1 Hz"}}).find("has no name at an end"), std::string::npos) << path;
  }
}

TEST(Change, IsNamedByTheErrorThatItCauses) {
  const std::string said = complaint({{"laws.soft.range", "-1 mm"}});
  EXPECT_EQ(said.find("scenes/test.yaml:9: 'range' is '-1 mm'"), 0) << said;
  EXPECT_NE(said.find("(with laws.soft.range set to '-1 mm')"), std::string::npos) << said;
}

}  // namespace change_test
}  // namespace repel::scene
