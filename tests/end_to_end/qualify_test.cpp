#include <algorithm>

#include "advice.hpp"
#include "end_to_end/trial_report.hpp"

namespace repel::test {
namespace {

Ending qualify(const std::string& arguments) {
  return run_program(REPEL_QUALIFY, arguments);
}

TEST(Qualify, VerdictReportAndExitStatusAgree) {
  const Folder folder;
  const Ending ending = qualify("--rate 500 --seconds 1 --json " + quoted(folder / "q.json"));
  const auto report = report_of(folder / "q.json");
  expect_trial(report, 500.0, 500);
  const bool holds = report.at("holds");
  EXPECT_EQ(holds, report.at("windows_of_100").at("below_0_95") == 0);
  EXPECT_EQ(holds, report.at("windows_of_100").at("worst") >= 0.95);
  EXPECT_EQ(ending.status, holds ? 0 : 1) << ending;
  EXPECT_TRUE(ending.says(report.at("verdict"))) << ending;
  EXPECT_TRUE(ending.says(holds ? "\nHOLDS 500 Hz" : "\nDOES NOT HOLD 500 Hz")) << ending;
  for (const auto& advice : report.at("advice")) {
    EXPECT_TRUE(ending.says(advice.at("finding"))) << advice << ending;
    EXPECT_TRUE(ending.says(advice.at("command"))) << advice << ending;
  }
}

TEST(Qualify, HelpNamesOptionsAndExitStatus) {
  const Ending ending = qualify("--help");
  EXPECT_EQ(ending.status, 0) << ending;
  for (const char* words : {"--rate", "--seconds", "--json", "Exit status", "0.95"}) {
    EXPECT_TRUE(ending.says(words)) << words << '\n' << ending;
  }
}

TEST(Qualify, BadUsageEndsWithTwoAndSaysWhy) {
  for (const char* arguments :
       {"--no-such-option", "--rate 0", "--rate fast", "--rate nan", "--seconds -1", "word",
        "--rate 400 --seconds 0.2", "--seconds 1 --json /no/such/folder/file"}) {
    const Ending ending = qualify(arguments);
    EXPECT_EQ(ending.status, 2) << arguments << '\n' << ending;
    EXPECT_FALSE(ending.err.empty()) << arguments;
  }
}

TEST(Windows, BelowPointNinetyFiveIsUnsound) {
  host::Windows windows;
  EXPECT_EQ(windows.mean(), 1.0) << "without a window";
  for (const double rate : {1.0, 0.95, 0.94, 0.91}) windows.record(rate);
  EXPECT_EQ(windows.count, 4);
  EXPECT_EQ(windows.unsound, 2);
  EXPECT_EQ(windows.worst, 0.91);
  EXPECT_DOUBLE_EQ(windows.mean(), 0.95);
}

TEST(Hiccups, FallIntoTheBinWhoseLowerEdgeTheyReach) {
  using std::chrono::nanoseconds;
  host::Hiccups hiccups;
  for (const int ns : {10001, 19999, 20000, 999999, 30000000}) hiccups.record(nanoseconds(ns));
  const std::array<std::int64_t, 10> bins{2, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_EQ(hiccups.bins, bins);
  EXPECT_EQ(hiccups.count, 5);
  EXPECT_EQ(hiccups.longest, nanoseconds(30000000));
  EXPECT_EQ(hiccups.total, nanoseconds(10001 + 19999 + 20000 + 999999 + 30000000));
}

// A reading this old can only be one that a hiccup still holds up.
TEST(Hiccups, OneThatStillLastsIsMet) {
  host::HiccupWatch watch(host::allowed_processors());
  const auto later = std::chrono::steady_clock::now().time_since_epoch() + std::chrono::hours(1);
  EXPECT_TRUE(watch.met(later, later));
  (void)watch.stop();
}

host::Surroundings sound_host() {
  return {.preempt_rt = true, .governors = {"performance"}};
}

host::Trial all_granted() {
  host::Trial trial;
  trial.grant = {.priority = 80, .memory_locked = true, .kept_awake = true};
  return trial;
}

TEST(Advice, SoundHostGetsNone) {
  EXPECT_TRUE(host::advise(sound_host(), all_granted()).empty());
}

TEST(Advice, EachIsGivenOnlyWhereItAppliesWithItsCommand) {
  const struct {
    const char* command;
    void (*spoil)(host::Surroundings&, host::Trial&);
  } cases[] = {{"linux-image-rt", [](auto& s, auto&) { s.preempt_rt = false; }},
               {"scaling_governor",
                [](auto& s, auto&) {
                  s.governors = {"performance", "powersave"};
                }},
               {"- rtprio 99\" | sudo tee -a /etc/security/limits.d/",
                [](auto&, auto& t) { t.grant.priority = 0; }},
               {"- memlock unlimited\" | sudo tee -a /etc/security/limits.d/",
                [](auto&, auto& t) { t.grant.memory_locked = false; }},
               {"--cap-add SYS_NICE",
                [](auto& s, auto& t) {
                  s.root = true;
                  t.grant.priority = 0;
                }},
               {"setfacl",
                [](auto& s, auto& t) {
                  s.can_stay_awake = true;
                  t.grant.kept_awake = false;
                }},
               {"vcpupin", [](auto& s, auto&) { s.virtual_machine = true; }},
               {"vcpupin", [](auto&, auto& t) { t.stolen = 0.01; }}};
  for (const auto& c : cases) {
    host::Surroundings surroundings = sound_host();
    host::Trial trial = all_granted();
    c.spoil(surroundings, trial);
    const std::vector<host::Advice> advice = host::advise(surroundings, trial);
    ASSERT_EQ(advice.size(), 1U) << c.command;
    EXPECT_NE(advice.front().command.find(c.command), std::string::npos) << advice.front().command;
    EXPECT_FALSE(advice.front().finding.empty());
  }
}

}  // namespace
}  // namespace repel::test
