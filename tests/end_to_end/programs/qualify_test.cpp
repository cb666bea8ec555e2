// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <sstream>
#include <thread>

#include <repel/host/times.hpp>
#include <repel/host/trial/advice.hpp>

#include "end_to_end/trial_report.hpp"

namespace repel::test {
namespace qualify_test {

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

TEST(Qualify, AMistypedOptionIsToldWhichOneWasMeant) {
  const Ending ending = qualify("--rat 500");
  EXPECT_EQ(ending.status, 2) << ending;
  EXPECT_EQ(ending.err.rfind("qualify: unknown option --rat; did you mean --rate?\n", 0), 0U)
      << ending;
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
        "--rate 400 --seconds 0.2", "--json /no/such/folder/file"}) {
    const Ending ending = qualify(arguments);
    EXPECT_EQ(ending.status, 2) << arguments << '\n' << ending;
    EXPECT_FALSE(ending.err.empty()) << arguments;
  }
}

TEST(Qualify, NoVerdictWhenItEndsBeforeThe100thTick) {
  const Folder folder;
  const Ending ending =
      run_program("timeout", "--preserve-status -s INT 3 " + quoted(REPEL_QUALIFY) +
                                 " --rate 2 --seconds 60 --json " + quoted(folder / "q.json"));
  EXPECT_EQ(ending.status, 3) << ending;
  EXPECT_TRUE(ending.says("\nNO VERDICT on 2 Hz")) << ending;
  const auto report = report_of(folder / "q.json");
  EXPECT_TRUE(report.at("holds").is_null());
  EXPECT_TRUE(report.at("interrupted"));
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

using std::chrono::nanoseconds;
using namespace std::chrono_literals;

constexpr nanoseconds open_end = nanoseconds::max();

// Ticks due at 1 ms, 2 ms, 3 ms and 4 ms.
host::Hiccups four_ticks() {
  return host::Hiccups(host::Beat{.first = 1ms, .period = 1ms, .ticks = 4});
}

TEST(Beat, CountsTheTicksThatAreDueBeforeATime) {
  const host::Beat beat{.first = 1ms, .period = 1ms, .ticks = 4};
  EXPECT_EQ(beat.due_before(0ns), 0);
  EXPECT_EQ(beat.due_before(1ms), 0);
  EXPECT_EQ(beat.due_before(1ms + 1ns), 1);
  EXPECT_EQ(beat.due_before(2ms), 1);
  EXPECT_EQ(beat.due_before(4ms + 1ns), 4);
  EXPECT_EQ(beat.due_before(1s), 4);
}

TEST(Hiccups, FallIntoTheBinWhoseLowerEdgeTheyReach) {
  host::Hiccups hiccups;
  for (const nanoseconds gap : {10000ns, 10001ns, 19999ns, 20000ns, 999999ns, 30000000ns}) {
    hiccups.add(1s, 1s + gap, 0, open_end);
  }
  const std::array<std::int64_t, 10> bins{2, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  EXPECT_EQ(hiccups.bins(), bins);
  EXPECT_EQ(hiccups.count(), 5);
  EXPECT_EQ(hiccups.longest(), 30ms);
  EXPECT_EQ(hiccups.total(), 10001ns + 19999ns + 20000ns + 999999ns + 30000000ns);
  EXPECT_EQ(hiccups.watched(), hiccups.total() + 10000ns);
}

TEST(Hiccups, OnlyTheirPartWhileTicksRanCounts) {
  host::Hiccups hiccups = four_ticks();
  hiccups.add(0ns, 1ms, 0, open_end);  // before
  EXPECT_EQ(hiccups.count(), 0);
  hiccups.add(0ns, 1ms + 30us, 0, open_end);
  EXPECT_EQ(hiccups.count(), 1);
  EXPECT_EQ(hiccups.total(), 30us);
  hiccups.add(4ms, 7ms, 4, 4ms + 20us);
  EXPECT_EQ(hiccups.count(), 2);
  EXPECT_EQ(hiccups.total(), 50us);
  hiccups.add(7ms, 9ms, 4, 4ms + 20us);  // after
  EXPECT_EQ(hiccups.count(), 2);
  EXPECT_EQ(hiccups.longest(), 30us);
}

TEST(Hiccups, TickIsMetFromTheTimeItIsDueToItsEnd) {
  host::Hiccups ended = four_ticks();
  ended.add(1ms + 50us, 1ms + 90us, 1, open_end);  // between the first two
  EXPECT_EQ(ended.ticks(), 0);
  EXPECT_EQ(ended.count(), 1);

  host::Hiccups late = four_ticks();
  late.add(1ms + 50us, 1ms + 90us, 0, open_end);  // the first has not ended
  EXPECT_EQ(late.ticks(), 1);

  host::Hiccups over_three = four_ticks();
  over_three.add(1ms + 50us, 3ms + 1ns, 0, open_end);
  EXPECT_EQ(over_three.ticks(), 3);
}

TEST(Hiccups, TickThatMeetsTwoCountsOnce) {
  host::Hiccups hiccups = four_ticks();
  hiccups.add(1ms + 50us, 1ms + 90us, 0, open_end);
  hiccups.add(1ms + 90us, 1ms + 120us, 0, open_end);
  EXPECT_EQ(hiccups.count(), 2);
  EXPECT_EQ(hiccups.ticks(), 1);
  hiccups.add(1ms + 120us, 2ms + 10us, 0, open_end);
  EXPECT_EQ(hiccups.ticks(), 2);
}

// The tick that runs when a hiccup begins counts as hit, however soon it ends.
TEST(Hiccups, OneThatBeginsJustBeforeTheEndIsMet) {
  host::Hiccups hiccups = four_ticks();
  hiccups.add(4ms + 19us, 5ms, 3, 4ms + 20us);
  EXPECT_EQ(hiccups.ticks(), 1);
  EXPECT_EQ(hiccups.total(), 1us);
}

TEST(HiccupWatch, SeesTheTimeBetweenTheFirstTickAndTheClose) {
  const nanoseconds begin = host::steady_now();
  host::HiccupWatch watch(host::allowed_processors(),
                          host::Beat{.first = begin + 5ms, .period = 5ms, .ticks = 4});
  watch.close(begin + 25ms);
  // A busy machine may come to the line above after the 25 ms: what was read until then counts.
  const nanoseconds closed = std::max(begin + 25ms, host::steady_now());
  std::this_thread::sleep_for(40ms);
  watch.ended(4);
  const host::Hiccups& hiccups = watch.stop();
  EXPECT_GT(hiccups.watched(), 0ns);
  EXPECT_LE(hiccups.watched(), closed - (begin + 5ms));
  EXPECT_LE(hiccups.total(), hiccups.watched());
  EXPECT_LE(hiccups.ticks(), 4);
}

TEST(Report, NumberThatIsNotFiniteIsNull) {
  std::ostringstream file;
  host::write(host::to_json(RunTotals{}, 0), file);
  const auto report = nlohmann::json::parse(file.str());
  EXPECT_TRUE(report.at("nearest_m").is_null());
  EXPECT_EQ(report.at("deepest_m"), 0.0);
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

}  // namespace qualify_test
}  // namespace repel::test
