// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <repel/host/command_line.hpp>

#include "end_to_end/teleop.hpp"
#include "end_to_end/whole_run.hpp"

namespace repel::test {
namespace command_line_test {

struct Complaint {
  const char* arguments;
  const char* words;  ///< the first ones, if they begin with the name of the program
  int status = 2;
};

/// teleop ends with the status of each and says its words.
void expect_complaints(const std::vector<Complaint>& all) {
  for (const auto& [arguments, words, status] : all) {
    const Ending ending = teleop(arguments);
    EXPECT_EQ(ending.status, status) << arguments << '\n' << ending;
    const bool first = std::string_view(words).starts_with("teleop: ");
    EXPECT_TRUE(first ? ending.err.starts_with(words) : ending.says(words)) << arguments << '\n'
                                                                            << ending;
  }
}

TEST(CommandLine, HelpNamesCommandsCommonUsageAndWhatASceneIsRunWith) {
  const Ending ending = teleop("--help");
  EXPECT_EQ(ending.status, 0) << ending;
  for (const char* words :
       {"\nCommands:\n  run ", "\n  replay ", "\n  site ", "\n  station ", "\n  check ",
        "\n  list ", "teleop plates --view", "--report", "--rate", "anderson_4x8", "bullet", "ode",
        "reference", "ideal", "spaceball", "torque_arm", "six_axes"}) {
    EXPECT_TRUE(ending.says(words)) << words << '\n' << ending;
  }
}

TEST(CommandLine, HelpOfRunNamesScenesBackEndsDevicesAndExitStatusInGroups) {
  for (const char* arguments : {"run --help", "plates --help", "--fast --help"}) {
    const Ending ending = teleop(arguments);
    EXPECT_EQ(ending.status, 0) << ending;
    for (const char* words :
         {"anderson_4x8", "--tool-alone", "bullet",          "ode",         "reference",
          "ideal",        "spaceball",    "torque_arm",      "Exit status", "--fast",
          "--report",     "--log",        "--threads",       "--budget",    "i860",
          "--every-pair", "--contact",    "--plant-inertia", "--html",      "--programs",
          "--walls",      "--link",       "--device",        "\nRun:\n",    "\nArm:\n",
          "\nWalls:\n",   "\nView:\n",    "\nLink:\n",       "\nFiles:\n"}) {
      EXPECT_TRUE(ending.says(words)) << words << '\n' << ending;
    }
    for (const char* words : {"--hold", "--apart", "--together", "--station", "--impaired"}) {
      EXPECT_FALSE(ending.says(words)) << words << '\n' << ending;
    }
  }
}

TEST(CommandLine, HelpIsAtMost100ColumnsWide) {
  for (const std::string command : {"", "run", "replay", "site", "station", "check", "list"}) {
    const Ending ending = teleop(command + " --help");
    EXPECT_EQ(ending.status, 0) << ending;
    std::istringstream lines(ending.out);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
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

TEST(CommandLine, AnEmptyNameIsNotTakenForNoFile) {
  expect_complaints({{"empty --log ''", "teleop: --log: the value is empty"},
                     {"empty --report ''", "teleop: --report: the value is empty"},
                     {"empty --hand ''", "teleop: --hand: the value is empty"},
                     {"check ''", "teleop: scene: the value is empty"}});
}

TEST(CommandLine, AChangeThatIsNoneSaysWhichFormItHas) {
  expect_complaints({{"--set foo", "teleop: --set: 'foo'; allowed: PATH=VALUE"},
                     {"--set =1", "teleop: --set: '=1'; allowed: PATH=VALUE"}});
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

TEST(CommandLine, TheClosestWordIsTheOneOfFewestStepsIfTheyAreFew) {
  const std::vector<std::string> words{"list", "lost", "check", "--backend"};
  EXPECT_EQ(host::closest("list", words), "list");
  EXPECT_EQ(host::closest("lsit", words), "list") << "a swap is one step";
  EXPECT_EQ(host::closest("lst", words), "list") << "the first of several";
  EXPECT_EQ(host::closest("losst", words), "lost");
  EXPECT_EQ(host::closest("xheck", words), "check");
  EXPECT_EQ(host::closest("xheckk", words), "check") << "two steps in six letters";
  EXPECT_EQ(host::closest("xhekk", words), "") << "two steps in five";
  EXPECT_EQ(host::closest("--bac", words), "");
  EXPECT_EQ(host::closest("", words), "");
}

TEST(CommandLine, WhatIsMistypedIsToldWhatWasMeant) {
  expect_complaints(
      {{"--bakend ode", "teleop: unknown option --bakend; did you mean --backend?\n"},
       {"plates --fats", "teleop: unknown option --fats; did you mean --fast?\n"},
       {"run plates --bakend=ode", "teleop: unknown option --bakend; did you mean --backend?\n"},
       {"station delayed --impared", "did you mean --impaired?\n"},
       {"--zzzzzzzzzzz", "teleop: unknown option --zzzzzzzzzzz\n"},
       {"chek plates", "teleop: unknown command chek; did you mean check?\n"},
       {"lsit", "teleop: unknown command lsit; did you mean list?\n"},
       {"plate --fast", "plate: no such scene (did you mean plates?)", 1}});
}

TEST(CommandLine, AnOptionOfAnotherCommandIsToldWhereItBelongs) {
  expect_complaints({
      {"check plates --domain 3", "--domain belongs to: teleop run, teleop site, teleop station\n"},
      {"plates --domain 3", "--domain belongs to: teleop site, teleop station"},
      {"plates --impaired", "--impaired belongs to: teleop site, teleop station\n"},
      {"replay x.mcap --walls hard", "--walls belongs to: teleop run, teleop site, teleop check\n"},
      {"replay x.mcap --seconds=3", "--seconds belongs to: teleop run, teleop site"},
      {"station delayed --html x.html",
       "--html belongs to: teleop run, teleop replay, teleop site\n"},
      {"list --fast", "--fast belongs to: teleop run\n"},
  });
}

TEST(CommandLine, OldSpellingsOfOptionsWorkAndSayTheNewOnes) {
  const Ending soft = teleop("two_arms --fast --seconds 2 --quiet --report - --hold soft");
  ASSERT_EQ(soft.status, 0) << soft;
  EXPECT_EQ(soft.err, "teleop: --hold is --walls by now\n");
  const Ending hard = teleop("two_arms --fast --seconds 2 --quiet --report - --hold=hard");
  ASSERT_EQ(hard.status, 0) << hard;
  EXPECT_EQ(hard.err, "teleop: --hold is --walls by now\n");
  const auto hardness = [](const Ending& ending) {
    return nlohmann::json::parse(ending.out).at("obstacles").at(0).at("hold");
  };
  EXPECT_EQ(hardness(soft), "soft");
  EXPECT_EQ(hardness(hard), "hard");
  EXPECT_EQ(teleop("plates --hold firm").status, 2);
  const Ending one = teleop("remote --together --seconds 0.1 --quiet");
  EXPECT_EQ(one.status, 0) << one;
  EXPECT_EQ(one.err, "teleop: --together is --programs one by now\n");
  const Ending two = teleop("plates --apart");
  EXPECT_EQ(two.status, 1) << two;
  EXPECT_TRUE(two.says("teleop: --apart is --programs two by now\n")) << two;
  EXPECT_TRUE(two.says("two programs need a module 'line'")) << two;
}

TEST(CommandLine, OptionsThatAreCommandsByNowAreAnsweredWithThem) {
  expect_complaints({
      {"--replay run.mcap", "teleop: --replay FILE is by now: teleop replay FILE\n"},
      {"--replay=run.mcap --view", "teleop: --replay FILE is by now: teleop replay FILE\n"},
      {"delayed --site --seconds 1", "teleop: --site is by now: teleop site SCENE\n"},
      {"delayed --station", "teleop: --station is by now: teleop station SCENE\n"},
  });
}

TEST(CommandLine, RunIsTheCommandWhereNoneIsNamed) {
  const std::string how = " --fast --seconds 0.1 --report -";
  for (const std::string& arguments : {"run empty" + how, "empty" + how, how + " empty"}) {
    const Ending ending = teleop(arguments);
    ASSERT_EQ(ending.status, 0) << ending;
    EXPECT_EQ(nlohmann::json::parse(ending.out).at("scene"), "empty");
  }
  // The command wins over a file of its name, which run takes.
  const Folder folder;
  (void)folder.with("list", robot_text() + "obstacles: []\n");
  const std::string there = "cd " + quoted(folder / "") + " && $T ";
  EXPECT_EQ(shell(there + "list").out, teleop("list").out);
  const Ending run = shell(there + "run list --fast --seconds 0.1 --report -");
  ASSERT_EQ(run.status, 0) << run;
  EXPECT_EQ(nlohmann::json::parse(run.out).at("ticks"), 40);
}

TEST(CommandLine, ListSaysOfEachSceneWhatItIsAbout) {
  const Ending ending = teleop("list");
  EXPECT_EQ(ending.status, 0) << ending;
  std::istringstream lines(ending.out);
  std::map<std::string, std::string> about;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find(' ');
    about[line.substr(0, end)] =
        line.substr(std::min(line.size(), line.find_first_not_of(' ', end)));
  }
  std::set<std::string> names;
  for (const auto& [name, text] : about) {
    names.insert(name);
    EXPECT_FALSE(text.empty()) << name;
  }
  EXPECT_EQ(names, scene_names());
  EXPECT_EQ(about["anderson_4x8"], "The experiment of Anderson (1993), section 4");
  EXPECT_EQ(about["empty"], "A robot in an empty room");
}

TEST(CommandLine, ListSaysWhichFaultsThereAreAndOfWhichKind) {
  const Ending ending = teleop("list --faults");
  EXPECT_EQ(ending.status, 0) << ending;
  for (const char* line :
       {"readings    frame frozen\n", "kinematics  pose NaN\n", "clock       clock stopped\n",
        "drive       drive dead, wrist\n", "operator    device silent\n"}) {
    EXPECT_TRUE(ending.says(line)) << line << ending;
  }
  EXPECT_FALSE(ending.says("brake")) << "no run can have those";
}

TEST(CommandLine, FaultsAreInjectedReportedAndReplayed) {
  const Folder folder;
  const std::string log = quoted(folder / "run.mcap");
  const std::string report = " --report " + quoted(folder / "report.json");
  const Ending ending = teleop(
      "plates --fast --seconds 2 --backend ideal --fault 'frame frozen@1' --fault='pose NaN "
      "once@0.5' --log " +
      log + report);
  EXPECT_EQ(ending.status, 5) << ending;
  EXPECT_TRUE(ending.says("injected fault         frame frozen (readings), from 1 s on\n"));
  const nlohmann::json faults = report_of(folder / "report.json").at("faults");
  const nlohmann::json wanted = {
      {{"name", "frame frozen"}, {"kind", "readings"}, {"begin_s", 1.0}},
      {{"name", "pose NaN once"}, {"kind", "kinematics"}, {"begin_s", 0.5}}};
  EXPECT_EQ(faults, wanted);
  EXPECT_EQ(report_of(folder / "report.json").at("status_ticks").at("bad_pose"), 1);
  const Ending replay = teleop("replay " + log + report);
  EXPECT_EQ(replay.status, 5) << replay;
  EXPECT_EQ(report_of(folder / "report.json").at("faults"), wanted);
  EXPECT_EQ(report_of(folder / "report.json").at("replay").at("same"), 800);
}

TEST(CommandLine, AReportSaysWhatIsNotAsInTheScene) {
  const Folder folder;
  const Ending ending = teleop(
      "plates --fast --seconds 0.1 --set laws.default.surface_force='30 N' --fault 'frame "
      "frozen@0.09' --report " +
      quoted(folder / "report.json") + " --html " + quoted(folder / "page.html"));
  const nlohmann::json wanted = {{{"path", "laws.default.surface_force"}, {"value", "30 N"}}};
  EXPECT_EQ(report_of(folder / "report.json").at("changes"), wanted);
  EXPECT_TRUE(ending.says("changed in the scene   laws.default.surface_force: 30 N\n")) << ending;
  const std::string page = text_of(folder / "page.html");
  for (const char* line : {"<p>Changed in the scene: laws.default.surface_force: 30 N</p>",
                           "<p>Injected fault: frame frozen, from 0.09 s on</p>"}) {
    EXPECT_NE(page.find(line), std::string::npos) << line;
  }
}

TEST(CommandLine, FaultsThatCannotBeHadAreRefused) {
  expect_complaints(
      {{"plates --fault 'frozn frame@1'",
        "teleop: --fault: no fault is called 'frozn frame' (did you mean 'frame frozen', "},
       {"plates --fault 'frame frozen'", "lacks the time at which it begins"},
       {"plates --fault 'frame frozen@soon'", "begins at 'soon'; allowed: 0 to 1e+06 s\n"},
       {"plates --fault 'brake drags, wrist@1'", "allowed of its kind: 'drive dead, shoulder', "},
       {"delayed --programs two --fault 'hand turns round@1'",
        "is of the operator, who is in another program", 1},
       {"site delayed --fault 'frame frozen@1'", "--fault belongs to: teleop run\n"}});
}

TEST(CommandLine, CheckSaysThatASceneIsSoundAndHowLargeItIs) {
  const std::string count = " [0-9]+ parts, [0-9]+ pairs, ";
  EXPECT_TRUE(std::regex_match(teleop("check empty").out,
                               std::regex(".*empty\\.yaml: sound: 1 arm, [0-9]+ parts, 0 pairs, "
                                          "400 Hz\n")));
  const Ending two = teleop("check two_arms --rate 1000");
  EXPECT_EQ(two.status, 0) << two;
  EXPECT_TRUE(std::regex_match(
      two.out, std::regex(".*two_arms\\.yaml: sound: 2 arms," + count + "1000 Hz\n")))
      << two;
  const Folder folder;
  const Ending run =
      teleop("anderson_4x8 --fast --seconds 0 --quiet --report " + quoted(folder / "report.json"));
  ASSERT_EQ(run.status, 0) << run;
  const Ending checked = teleop("check");
  EXPECT_TRUE(checked.says(" " + report_of(folder / "report.json").at("pairs").dump() + " pairs"))
      << checked;
  for (const std::string& name : scene_names()) {
    const Ending ending = teleop("check " + name);
    EXPECT_EQ(ending.status, 0) << ending;
    EXPECT_TRUE(ending.says(": sound: ")) << ending;
  }
}

TEST(CommandLine, CheckPrintsASchemaThatKnowsUnitsWordsAndModules) {
  const Ending ending = teleop("check --schema");
  ASSERT_EQ(ending.status, 0) << ending;
  const auto schema = nlohmann::json::parse(ending.out);
  const auto& keys = schema.at("properties");
  EXPECT_EQ(schema.at("additionalProperties"), false);
  EXPECT_EQ(keys.at("start_inside").at("enum"), nlohmann::json({"refuse", "push_out"}));
  const auto& law = keys.at("laws").at("additionalProperties").at("properties");
  const std::regex range(law.at("range").at("pattern").get<std::string>());
  for (const char* right : {"20 mm", "0.02 m", "2e1mm", ".5 cm"}) {
    EXPECT_TRUE(std::regex_match(right, range)) << right;
  }
  for (const char* wrong : {"20", "20 N", "20 mm 3", "x mm"}) {
    EXPECT_FALSE(std::regex_match(wrong, range)) << wrong;
  }
  std::set<std::string> kinds;
  for (const auto& each : keys.at("network").at("items").at("allOf")) {
    const auto& own = each.at("then").at("properties");
    EXPECT_TRUE(own.contains("module") && own.contains("to")) << each;
    const std::string kind = each.at("if").at("properties").at("module").at("const");
    EXPECT_EQ(own.contains("angular_shunt"), kind == "kbb2");
    kinds.insert(kind);
  }
  EXPECT_EQ(kinds.size(), 21U);
  EXPECT_TRUE(kinds.contains("force_sensor"));
}

TEST(CommandLine, CheckSaysWhatIsWrongAndWhere) {
  const Folder folder;
  const std::string bad = quoted(folder.with(
      "bad.yaml", robot_text() + "obstacles:\n  - {name: b, shape: sphere, radius: 0.1}\n"));
  const Ending unread = teleop("check " + bad);
  EXPECT_EQ(unread.status, 1) << unread;
  EXPECT_TRUE(unread.says("bad.yaml:9: ")) << unread;
  EXPECT_EQ(unread.out, "");
  // What is found by building the cell, and what is in another file.
  std::string text = robot_text() + "obstacles: []\n";
  text.replace(text.find("0 45 -180 0 -45 0 deg"), 21, "0 45 -180 0 -45 400 deg");
  const Ending unbuilt = teleop("check " + quoted(folder.with("start.yaml", text)));
  EXPECT_EQ(unbuilt.status, 1) << unbuilt;
  EXPECT_TRUE(unbuilt.says("start.yaml") && unbuilt.says("start")) << unbuilt;
  const Ending absent = teleop(
      "check " + quoted(folder.with("absent.yaml", robot_text("no.urdf") + "obstacles: []\n")));
  EXPECT_EQ(absent.status, 1) << absent;
  EXPECT_TRUE(absent.says("no.urdf")) << absent;
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
