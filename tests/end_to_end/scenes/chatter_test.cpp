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
       {"plates --fast --seconds 4 --log " + quoted(file), "replay " + quoted(file)}) {
    const Ending ending =
        teleop(arguments + " --report " +
               quoted(folder / (arguments.starts_with("replay") ? "b.json" : "a.json")));
    ASSERT_EQ(ending.status, 0) << ending;
  }
  EXPECT_EQ(report_of(folder / "a.json").at("chatter"), report_of(folder / "b.json").at("chatter"));
}

/// The plates of the repository on a wrist of 2e-5 kg m^2 without friction, led by a soft hand.
std::string plates_on_a_light_wrist(const Folder& folder) {
  const auto change = [](std::string& text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    if (at != std::string::npos) text.replace(at, from.size(), to);
  };
  std::string robot = text_of(REPEL_SOURCE "/robots/puma560.urdf");
  change(robot, "damping=\"0.427283021\" friction=\"0.85444524\"", "damping=\"0\" friction=\"0\"");
  change(robot, "damping=\"0.215823253\" friction=\"0.55443978\"", "damping=\"0\" friction=\"0\"");
  change(robot, "<mass value=\"0.34\"/>", "<mass value=\"0.01\"/>");
  change(robot, "ixx=\"0.0003\" ixy=\"0\" ixz=\"0\" iyy=\"0.0004\" iyz=\"0\" izz=\"0.0003\"",
         "ixx=\"1e-5\" ixy=\"0\" ixz=\"0\" iyy=\"1e-5\" iyz=\"0\" izz=\"1e-5\"");
  change(robot, "<origin xyz=\"0 0 0.032\"", "<origin xyz=\"0 0 0\"");
  change(robot, "<mass value=\"0.09\"/>", "<mass value=\"0.005\"/>");
  change(robot, "ixx=\"0.00015\" ixy=\"0\" ixz=\"0\" iyy=\"0.00015\" iyz=\"0\" izz=\"0.00004\"",
         "ixx=\"6e-6\" ixy=\"0\" ixz=\"0\" iyy=\"6e-6\" iyz=\"0\" izz=\"6e-6\"");
  for (const std::string motor : {"motor_5", "motor_6"}) {
    change(robot, motor + "\">\n      <drake:rotor_inertia value=\"33e-6\"",
           motor + "\">\n      <drake:rotor_inertia value=\"1e-10\"");
  }
  std::string scene = text_of(REPEL_SOURCE "/scenes/plates.yaml");
  change(scene, "../robots/puma560.urdf", folder.with("light.urdf", robot));
  change(scene, "angular_stiffness: 30 N", "angular_stiffness: 2 N");
  change(scene, "angular_damping: 4 N", "angular_damping: 0.05 N");
  return folder.with("plates.yaml", scene.substr(0, scene.find("script:")) +
                                        "script:\n"
                                        "  - {name: tilt, device: spaceball, duration: 1 s, "
                                        "angular: 7 8 0 deg/s}\n"
                                        "  - {name: press, device: spaceball, duration: 2 s, "
                                        "linear: 0 0 -60 mm/s}\n");
}

// A contact patch is a spring against turning without a damping of its own: the plate rang with
// 2 rad/s while it was pressed flat on the other, and the torque changed by 4 N m from tick to
// tick.
TEST(Chatter, IsNoneWhereAPlateOnALightWristTurnsFlat) {
  const Folder folder;
  const std::string scene = quoted(plates_on_a_light_wrist(folder));
  for (const int rate : {200, 400, 1000}) {
    const LoggedRun run(scene + " --seconds 5 --rate " + std::to_string(rate));
    const std::vector<double>& v = run.log.at("v5_rad_s");
    const std::vector<double>& force = run.log.at("virtual_fz_n");
    double fastest = 0.0;
    double pressed = 0.0;
    for (std::size_t i = 2U * static_cast<std::size_t>(rate); i < v.size(); ++i) {
      fastest = std::max(fastest, std::abs(v[i]));
      pressed = std::max(pressed, force[i]);
    }
    EXPECT_GT(pressed, 100.0) << rate << " Hz";
    EXPECT_LT(fastest, 0.15) << rate << " Hz";
    EXPECT_LT(run.report.at("chatter").at("joints").at(4).at("rms_nm"), 0.05) << rate << " Hz";
  }
}

}  // namespace chatter_test
}  // namespace repel::test
