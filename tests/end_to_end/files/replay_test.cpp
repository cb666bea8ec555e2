// SPDX-License-Identifier: BSD-3-Clause
#include <set>

#include "end_to_end/teleop.hpp"

namespace repel::test {
namespace replay_test {

TEST(Replay, SameBitsEveryTimeAndWithAnyNumberOfThreads) {
  const Folder folder;
  for (const std::string backend : {"bullet", "ideal"}) {
    std::string first;
    for (const int threads : {0, 0, 1, 2}) {
      const std::string log = folder / "log.csv";
      const Ending ending =
          teleop("anderson_4x8 --fast --seconds 2.5 --backend " + backend + " --threads " +
                 std::to_string(threads) + " --log " + quoted(log));
      ASSERT_EQ(ending.status, 0) << ending;
      const std::string text = text_of(log);
      ASSERT_GT(text.size(), 100000U);
      if (first.empty()) first = text;
      EXPECT_TRUE(text == first) << backend << ", " << threads << " threads: another log";
    }
    // Check that the run contains events that could have differed.
    const Columns last = columns_of(folder / "log.csv");
    double peak = 0.0;
    for (const double f : last.at("virtual_fz_n")) {
      peak = std::max(peak, std::abs(f));
    }
    EXPECT_GT(peak, 1.0) << backend;
  }
}

TEST(Replay, SameBitsUnderACountedBudget) {
  const Folder folder;
  const std::string scene = folder.with(
      "scene.yaml", robot_text() + table_text() + push_text() + "budget: {work: 1, threads: 2}\n");
  std::string first;
  for (const int threads : {0, 2}) {
    const Ending ending = teleop(quoted(scene) + " --fast --seconds 2 --threads " +
                                 std::to_string(threads) + " --log " + quoted(folder / "log.csv"));
    ASSERT_EQ(ending.status, 0) << ending;
    const std::string text = text_of(folder / "log.csv");
    if (first.empty()) first = text;
    EXPECT_TRUE(text == first) << threads << " threads: another log";
  }
}

TEST(Replay, ReportHasEveryNumberAndTheTickTookNothingFromTheHeap) {
  const Folder folder;
  const Ending ending =
      teleop("anderson_4x8 --seconds 1 --report " + quoted(folder / "report.json"));
  ASSERT_EQ(ending.status, 0) << ending;
  const auto report = report_of(folder / "report.json");
  for (const char* key : {"scene",
                          "backend",
                          "rate_hz",
                          "ticks",
                          "deadline_misses",
                          "success_rate_last_100",
                          "compute_us",
                          "wakeup_us",
                          "pairs",
                          "pairs_evaluated_per_tick",
                          "pairs_stale",
                          "oldest_age_ticks",
                          "nearest_m",
                          "deepest_m",
                          "nearest_wall_m",
                          "deepest_wall_m",
                          "nearest_passable_m",
                          "deepest_passable_m",
                          "peak_force_n",
                          "chatter",
                          "allocations_in_tick",
                          "system_calls_in_tick",
                          "page_faults_in_tick",
                          "voluntary_context_switches_in_tick",
                          "machine"}) {
    EXPECT_TRUE(report.contains(key)) << key;
  }
  for (const char* times : {"compute_us", "wakeup_us"}) {
    for (const char* key : {"p50", "p99", "p99_9", "max"}) {
      EXPECT_TRUE(report.at(times).at(key).is_number()) << times << ' ' << key;
    }
    EXPECT_LE(report.at(times).at("p50"), report.at(times).at("p99"));
    EXPECT_LE(report.at(times).at("p99"), report.at(times).at("p99_9"));
    EXPECT_LE(report.at(times).at("p99_9"), report.at(times).at("max"));
  }
  for (const char* key : {"cpu", "kernel", "scheduler", "compiler", "instruction_set", "commit"}) {
    EXPECT_FALSE(report.at("machine").at(key).get<std::string>().empty()) << key;
  }
  EXPECT_EQ(report.at("scene"), "anderson_4x8");
  EXPECT_EQ(report.at("backend"), "bullet");
  EXPECT_EQ(report.at("rate_hz"), 400.0);
  EXPECT_GE(report.at("ticks").get<int>() + report.at("skipped_ticks").get<int>(), 400);
  EXPECT_EQ(report.at("pairs"), 120);  // 4 parts of the tool and 11 of the arm with 8 obstacles
  // null if a sanitizer's allocator is in use.
  const auto& allocations = report.at("allocations_in_tick");
  EXPECT_TRUE(allocations.is_null() || allocations == 0) << allocations;
}

TEST(Replay, ReportSaysWhatTheRunDidWithout) {
  const Folder folder;
  const auto skipped = [&](const std::string& arguments) {
    const Ending ending = teleop(arguments + " --report " + quoted(folder / "report.json"));
    EXPECT_EQ(ending.status, 0) << ending;
    const auto report = report_of(folder / "report.json");
    const auto parts = report.at("skipped").get<std::vector<std::string>>();
    for (const std::string& part : parts) EXPECT_TRUE(ending.says(part)) << part << ending;
    return std::set<std::string>(parts.begin(), parts.end());
  };
  const auto plates = skipped("plates --fast --seconds 0.1");
  for (const char* part : {"coprocessor threads", "passable bodies", "torque arm", "log",
                           "counted budget", "wall-clock budget"}) {
    EXPECT_TRUE(plates.contains(part)) << part;
  }
  const auto full =
      skipped("--coprocessor beside --budget 9 --seconds 0.1 --log " + quoted(folder / "log.csv"));
  for (const char* part : {"coprocessor threads", "passable bodies", "torque arm", "log",
                           "space ball", "counted budget"}) {
    EXPECT_FALSE(full.contains(part)) << part;
  }
  // There is no work for them.
  EXPECT_TRUE(skipped("empty --threads 2 --fast --seconds 0.1").contains("coprocessor threads"));
  EXPECT_TRUE(
      skipped("--tool-alone --threads 2 --fast --seconds 0.1").contains("coprocessor threads"));
  EXPECT_TRUE(skipped("--threads 2 --fast --seconds 0.1").contains("1 of 2 coprocessor threads"));
}

TEST(Replay, ThreadsHaveNames) {
  const std::string look =
      "while kill -0 $!; do cat /proc/$!/task/*/comm; sleep 0.1; done 2>/dev/null; ";
  const Ending ending = run_program(
      REPEL_TELEOP, "--threads 1 --seconds 2 >/dev/null 2>&1 & { " + look + "wait $!; }");
  for (const char* name : {"teleop\n", "repel pairs 0\n", "repel progress\n"}) {
    EXPECT_TRUE(ending.says(name)) << name << ending;
  }
}

TEST(Replay, ReportSaysHowTheWorkersKeptUp) {
  const Folder folder;
  for (const int threads : {0, 2}) {
    const Ending ending = teleop("anderson_4x8 --seconds 1 --threads " + std::to_string(threads) +
                                 " --report " + quoted(folder / "report.json"));
    ASSERT_EQ(ending.status, 0) << ending;
    EXPECT_EQ(ending.says("workers stood in for"), threads > 0);
    const auto report = report_of(folder / "report.json");
    const auto& workers = report.at("workers");
    EXPECT_EQ(workers.at("ticks_stood_in_for"), report.at("status_ticks").value("late_result", 0));
    EXPECT_LE(workers.at("longest_silence_ticks"), workers.at("ticks_stood_in_for"));
    EXPECT_LE(workers.at("silent_at_end"), threads);
  }
}

}  // namespace replay_test
}  // namespace repel::test
