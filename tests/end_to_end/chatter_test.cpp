// SPDX-License-Identifier: BSD-3-Clause
// The chatter of walls, joints and lever in every report, against the log of the same run.
#include <algorithm>
#include <cmath>

#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace chatter_test {

using nlohmann::json;

/// A run that is not by the clock, with all it writes.
struct LoggedRun {
  explicit LoggedRun(const std::string& arguments)
      : ending(teleop(arguments + " --fast --report " + quoted(folder / "report.json") + " --log " +
                      quoted(folder / "log.csv") + " --html " + quoted(folder / "page.html"))) {
    EXPECT_EQ(ending.status, 0) << ending;
    if (ending.status != 0) return;
    report = report_of(folder / "report.json");
    log = columns_of(folder / "log.csv");
    page = text_of(folder / "page.html");
  }

  /// The largest change of a column from one row to the next.
  [[nodiscard]] double jump(const std::string& column) const {
    const std::vector<double>& values = log.at(column);
    double most = 0.0;
    for (std::size_t i = 1; i < values.size(); ++i) {
      most = std::max(most, std::abs(values[i] - values[i - 1]));
    }
    return most;
  }
  [[nodiscard]] double worst_jump(const std::string& begin, const std::string& end) const {
    return std::max({jump(begin + "x" + end), jump(begin + "y" + end), jump(begin + "z" + end)});
  }

  Folder folder;
  Ending ending;
  json report;
  Columns log;
  std::string page;
};

/// `prefix` is that of the columns of the arm.
void expect_like_log(const LoggedRun& run, const json& chatter, const std::string& prefix) {
  EXPECT_EQ(chatter.at("above_hz"), 30.0);
  const json& walls = chatter.at("walls");
  EXPECT_EQ(walls.at("force_jump_n"), run.worst_jump(prefix + "virtual_f", "_n"));
  EXPECT_EQ(walls.at("torque_jump_nm"), run.worst_jump(prefix + "virtual_t", "_nm"));
  EXPECT_EQ(chatter.at("lever").at("jump_nm"), run.jump(prefix + "lever_torque_nm"));
  const json& joints = chatter.at("joints");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const std::string unit = joints[i].contains("jump_n") ? "_n" : "_nm";
    const std::string column = prefix + "tau" + std::to_string(i + 1) + unit;
    ASSERT_EQ(run.log.count(column), 1U) << column;
    EXPECT_EQ(joints[i].at("jump" + unit), run.jump(column)) << column;
    EXPECT_GT(joints[i].at("rms" + unit), 0.0) << column;
    EXPECT_LT(joints[i].at("rms" + unit), joints[i].at("jump" + unit)) << column;
    EXPECT_TRUE(run.ending.says(joints[i].at("name"))) << run.ending;
    EXPECT_NE(run.page.find(joints[i].at("name").get<std::string>()), std::string::npos);
  }
}

TEST(Chatter, OfEveryArmIsInEveryReportAndAsInItsLog) {
  for (const std::string scene : {"plates --seconds 4", "two_arms --seconds 8"}) {
    SCOPED_TRACE(scene);
    const LoggedRun run(scene);
    expect_like_log(run, run.report.at("chatter"), "");
    for (const json& partner : run.report.at("partners")) {
      expect_like_log(run, partner.at("chatter"), partner.at("name").get<std::string>() + "/");
      EXPECT_TRUE(run.ending.says("chatter of " + partner.at("name").get<std::string>()));
    }
    const json& walls = run.report.at("chatter").at("walls");
    for (const char* key : {"force_rms_n", "force_jump_n", "torque_rms_nm", "torque_jump_nm"}) {
      EXPECT_TRUE(walls.at(key).is_number()) << key;
      EXPECT_GT(walls.at(key), 0.0) << key;
    }
    for (const char* words : {"walls, force", "walls, torque", "lever", "above 30 Hz", "N m"}) {
      EXPECT_TRUE(run.ending.says(words)) << words << run.ending;
      EXPECT_NE(run.page.find(words), std::string::npos) << words;
    }
  }
}

TEST(Chatter, WithoutWallsIsNoneOfThem) {
  const LoggedRun run("empty --seconds 4");
  for (const auto& [key, value] : run.report.at("chatter").at("walls").items()) {
    EXPECT_EQ(value, 0.0) << key;
  }
  EXPECT_EQ(run.report.at("chatter").at("joints").size(), 6U);
}

TEST(Chatter, OfAJointThatSlidesIsAForce) {
  const LoggedRun run("storage_tank --seconds 4");
  const json& joints = run.report.at("chatter").at("joints");
  ASSERT_EQ(joints.size(), 7U);
  EXPECT_TRUE(joints[0].contains("rms_n")) << joints[0];
  EXPECT_TRUE(joints[1].contains("rms_nm")) << joints[1];
  expect_like_log(run, run.report.at("chatter"), "");
}

TEST(Chatter, WithoutALeverThereIsNoneOfIt) {
  const Folder folder;
  const std::string scene = folder.with(
      "ball.yaml",
      robot_text() + table_text() +
          "network:\n  - {module: ground}\n  - {module: spaceball}\n  - {module: kbb2}\n"
          "  - {module: obstacle}\n  - {module: puma_kin}\n"
          "  - {module: puma_joints}\n" +
          push_text());
  const LoggedRun run(quoted(scene) + " --seconds 2");
  EXPECT_TRUE(run.report.at("chatter").at("lever").is_null());
  EXPECT_FALSE(run.ending.says("    lever")) << run.ending;
}

// What is above 30 Hz needs a rate above 60 Hz.
TEST(Chatter, AtALowRateTheRootMeanSquareIsNotKnown) {
  const LoggedRun run("empty --seconds 4 --rate 50");
  EXPECT_TRUE(run.report.at("chatter").at("walls").at("torque_rms_nm").is_null());
  EXPECT_EQ(run.report.at("chatter").at("walls").at("torque_jump_nm"), 0.0);
  EXPECT_TRUE(run.report.at("chatter").at("joints").at(0).at("rms_nm").is_null());
  EXPECT_GT(run.report.at("chatter").at("joints").at(0).at("jump_nm"), 0.0);
  EXPECT_TRUE(run.ending.says("not known")) << run.ending;
}

TEST(Chatter, OfAReplayIsThatOfItsRecording) {
  const Folder folder;
  const std::string file = folder / "run.mcap";
  for (const std::string& arguments :
       {"plates --fast --seconds 4 --log " + quoted(file), "--replay " + quoted(file)}) {
    const Ending ending = teleop(arguments + " --report " +
                                 quoted(folder / (arguments[0] == '-' ? "b.json" : "a.json")));
    ASSERT_EQ(ending.status, 0) << ending;
  }
  EXPECT_EQ(report_of(folder / "a.json").at("chatter"), report_of(folder / "b.json").at("chatter"));
}

}  // namespace chatter_test
}  // namespace repel::test
