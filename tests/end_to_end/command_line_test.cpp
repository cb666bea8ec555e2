// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>

#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace command_line_test {

TEST(CommandLine, HelpNamesScenesBackEndsDevicesAndExitStatus) {
  const Ending ending = teleop("--help");
  EXPECT_EQ(ending.status, 0) << ending;
  for (const char* words :
       {"anderson_4x8", "--tool-alone", "bullet",          "ode",         "reference",
        "ideal",        "spaceball",    "torque_arm",      "Exit status", "--fast",
        "--report",     "--log",        "--threads",       "--budget",    "i860",
        "--every-pair", "--contact",    "--plant-inertia", "--html",      "--site",
        "--station",    "--link"}) {
    EXPECT_TRUE(ending.says(words)) << words << '\n' << ending;
  }
}

TEST(CommandLine, VersionIsThatOfTheLibrary) {
  const Ending ending = teleop("--version");
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_EQ(ending.out.rfind("teleop " REPEL_VERSION ", commit ", 0), 0U) << ending;
}

TEST(CommandLine, ProgressSaysHowMuchIsDone) {
  // By the clock, for longer than it takes until the first line is shown.
  const Ending ending = teleop("empty --seconds 2");
  EXPECT_EQ(ending.status, 0) << ending;
  double percent = -1.0, seconds = -1.0;
  ASSERT_EQ(std::sscanf(ending.err.c_str(), "%lf %% %lf s", &percent, &seconds), 2) << ending;
  EXPECT_GT(seconds, 0.0);
  EXPECT_NEAR(percent, 50.0 * seconds, 1.0) << ending;
}

TEST(CommandLine, QuietSaysNothingButWhatWentWrong) {
  const Folder folder;
  const Ending ending =
      teleop("empty --fast --seconds 1 --quiet --report " + quoted(folder / "report.json"));
  EXPECT_EQ(ending.status, 0) << ending;
  EXPECT_EQ(ending.out + ending.err, "");
  EXPECT_EQ(report_of(folder / "report.json").at("ticks"), 400);
  const Ending refused = teleop("no_such_scene --quiet");
  EXPECT_EQ(refused.status, 1) << refused;
  EXPECT_FALSE(refused.err.empty());
}

TEST(CommandLine, ADashPrintsTheReportForAnotherProgram) {
  const Ending ending = teleop("empty --fast --seconds 1 --report -");
  EXPECT_EQ(ending.status, 0) << ending;
  const nlohmann::json report = nlohmann::json::parse(ending.out, nullptr, false);
  ASSERT_TRUE(report.is_object()) << ending;
  EXPECT_EQ(report.at("ticks"), 400);
}

TEST(CommandLine, BadUsageEndsWithTwoAndSaysWhy) {
  for (const char* arguments :
       {"--no-such-option", "--rate 0", "--rate fast", "--seconds -1", "--backend clay",
        "--threads 17", "--threads -1", "a b", "--budget", "--budget 0", "--budget -1",
        "--budget 1.5", "--budget '10 us'", "--budget i386", "--budget 1000000001"}) {
    const Ending ending = teleop(arguments);
    EXPECT_EQ(ending.status, 2) << arguments << '\n' << ending;
    EXPECT_FALSE(ending.err.empty()) << arguments;
  }
}

TEST(CommandLine, BudgetThatIsNoneSaysWhichThereAre) {
  const Ending ending = teleop("--budget i386");
  EXPECT_EQ(ending.status, 2) << ending;
  for (const char* words : {"i386", "i860", "none", "support pairs", "1000000000"}) {
    EXPECT_TRUE(ending.says(words)) << words << '\n' << ending;
  }
}

TEST(CommandLine, ContactOfABackEndThatHasNoneSaysWhichHaveIt) {
  for (const std::string backend : {"ideal", "reference"}) {
    const Ending ending = teleop("--contact --backend " + backend);
    EXPECT_EQ(ending.status, 2) << ending;
    for (const std::string words : {"--contact", backend.c_str(), "bullet, ode"}) {
      EXPECT_TRUE(ending.says(words)) << words << '\n' << ending;
    }
  }
}

TEST(CommandLine, MissingSceneEndsWithOneAndNamesThePath) {
  const Ending ending = teleop("no/such/scene.yaml");
  EXPECT_EQ(ending.status, 1) << ending;
  EXPECT_TRUE(ending.says("no/such/scene.yaml")) << ending;
  EXPECT_TRUE(ending.says("anderson_4x8")) << "the scenes there are\n" << ending;
}

TEST(CommandLine, BadSceneEndsWithOneAndNamesFileAndLine) {
  const Folder folder;
  const struct {
    const char* what;
    std::string text;
    const char* place;
  } scenes[] = {
      {"not YAML", robot_text() + "obstacles: [\n", "bad.yaml:"},
      {"unknown key", robot_text() + "obstacles: []\nobstacle: 1\n", "bad.yaml:9: "},
      {"negative radius",
       robot_text() + "obstacles:\n  - {name: ball, shape: sphere, radius: -10 mm}\n",
       "bad.yaml:9: "},
      {"no unit", robot_text() + "obstacles:\n  - {name: ball, shape: sphere, radius: 0.1}\n",
       "bad.yaml:9: "},
      {"empty", "", "bad.yaml"}};
  for (const auto& scene : scenes) {
    const Ending ending = teleop(quoted(folder.with("bad.yaml", scene.text)) + " --fast");
    EXPECT_EQ(ending.status, 1) << scene.what << '\n' << ending;
    EXPECT_TRUE(ending.says(scene.place)) << scene.what << '\n' << ending;
  }
}

TEST(CommandLine, StartThatDoesNotFitTheRobotEndsWithOne) {
  const Folder folder;
  for (const char* start : {"0 0 0 deg", "0 45 -180 0 -45 400 deg"}) {
    std::string text = robot_text() + "obstacles: []\n";
    text.replace(text.find("0 45 -180 0 -45 0 deg"), 21, start);
    const Ending ending = teleop(quoted(folder.with("start.yaml", text)) + " --fast");
    EXPECT_EQ(ending.status, 1) << ending;
    EXPECT_TRUE(ending.says("start.yaml") && ending.says("start")) << ending;
  }
}

TEST(CommandLine, RobotWithAShapeThatWouldBeLostEndsWithOneAndNamesTheLink) {
  const Folder folder;
  const std::string robot = text_of(REPEL_SOURCE "/robots/puma560.urdf");
  const std::string link = "<link name=\"link_4\">";
  ASSERT_NE(robot.find(link), std::string::npos);
  for (const char* shape :
       {"<torus radius=\"0.1\"/>", "<box size=\"1 2\"/>", "<mesh filename=\"a\"/>"}) {
    std::string text = robot;
    text.insert(text.find(link) + link.size(),
                std::string("<collision><geometry>") + shape + "</geometry></collision>");
    const std::string urdf = folder.with("robot.urdf", text);
    const std::string scene = folder.with("scene.yaml", robot_text(urdf) + "obstacles: []\n");
    const Ending ending = teleop(quoted(scene) + " --fast");
    EXPECT_EQ(ending.status, 1) << shape << '\n' << ending;
    EXPECT_TRUE(ending.says("link_4")) << shape << '\n' << ending;
    EXPECT_TRUE(ending.says("robot.urdf")) << shape << '\n' << ending;
  }
}

TEST(CommandLine, ReportThatCannotBeWrittenEndsWithOneAndNamesThePath) {
  for (const char* option : {"--report", "--log"}) {
    const Ending ending =
        teleop(std::string("empty --fast --seconds 0.1 ") + option + " /no/such/folder/file");
    EXPECT_EQ(ending.status, 1) << ending;
    EXPECT_TRUE(ending.says("/no/such/folder/file")) << ending;
  }
}

TEST(CommandLine, NoSecondsIsARunWithoutTicks) {
  const Folder folder;
  const Ending ending =
      teleop("empty --fast --seconds 0 --report " + quoted(folder / "report.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const auto report = report_of(folder / "report.json");
  EXPECT_EQ(report.at("ticks"), 0);
  EXPECT_TRUE(report.at("nearest_m").is_null());
}

}  // namespace command_line_test
}  // namespace repel::test
