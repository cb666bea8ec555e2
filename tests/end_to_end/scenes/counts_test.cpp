// SPDX-License-Identifier: BSD-3-Clause
// Operations that are forbidden in the tick, counted in every tick of every scene.
#include <gtest/gtest.h>

#include <repel/host/heap_guard.hpp>

#include "end_to_end/whole_run.hpp"
#include "realtime/clock.hpp"

namespace repel::test {
namespace counts_test {

using host::HeapGuard;
using runs::SystemCallGuard;

/// The report of a run of that scene.
nlohmann::json counted(const std::string& arguments) {
  const Folder folder;
  const Ending ending = teleop(arguments + " --report " + quoted(folder / "report.json"));
  EXPECT_EQ(ending.status, 0) << ending;
  return report_of(folder / "report.json");
}

/// Effects caused by the tick recur in every run. The kernel may once move a locked page or suspend
/// a thread, so these two counts must be zero in one of three runs.
bool is_at_rest(const nlohmann::json& report) {
  for (const char* key : {"page_faults_in_tick", "voluntary_context_switches_in_tick"}) {
    if (!report.at(key).is_null() && report.at(key) != 0) return false;
  }
  return true;
}

/// @param report of a first run; null: there was none
void expect_nothing_in_tick(const std::string& arguments, nlohmann::json report = {}) {
  SCOPED_TRACE(arguments);
  for (int run = 0; run < 3 && (run == 0 || !is_at_rest(report)); ++run) {
    if (run > 0 || report.is_null()) report = counted(arguments);
    EXPECT_GT(report.at("ticks"), 0);
    for (const char* key : {"allocations_in_tick", "system_calls_in_tick"}) {
      EXPECT_TRUE(report.at(key).is_null() || report.at(key) == 0) << key << report.at(key);
    }
  }
  EXPECT_TRUE(is_at_rest(report)) << "three times; page faults " << report.at("page_faults_in_tick")
                                  << ", voluntary switches "
                                  << report.at("voluntary_context_switches_in_tick");
  std::printf("%s: interrupted by the machine in %s of %s ticks\n", arguments.c_str(),
              report.at("involuntary_context_switches_in_tick").dump().c_str(),
              report.at("ticks").dump().c_str());
}

/// A count, whether it is available here, and if not, why.
struct Count {
  std::string key;
  bool possible;
  std::string reason;
  std::string disturbance;  ///< of disturbance.cpp
};
std::vector<Count> counts() {
  (void)clock_in_the_kernel();  // this tells whether system calls can be counted
  const auto report = counted("empty --fast --seconds 0.1");
  return {{"allocations_in_tick", HeapGuard::allocations() >= 0, "a sanitizer owns malloc",
           "allocation"},
          {"system_calls_in_tick", SystemCallGuard::calls() >= 0,
           "it takes Linux 5.11 on x86-64 and no sanitizer", "system call"},
          {"page_faults_in_tick", !report.at("page_faults_in_tick").is_null(),
           "memory cannot be locked; to allow it: ulimit -l unlimited", "page fault"},
          {"voluntary_context_switches_in_tick", true, "", "context switch"}};
}

TEST(Counts, AreNothingInEveryTickOfEveryScene) {
  const std::string source = clock_in_the_kernel();
  if (!source.empty()) GTEST_SKIP() << "asking the time is a system call here, clock " << source;
  for (const Count& count : counts()) {
    if (count.possible) continue;
    std::printf("skipped: %s: %s\n", count.key.c_str(), count.reason.c_str());
  }
  for (const std::string& scene : scene_names()) {
    expect_nothing_in_tick(scene + " --fast --seconds 20", whole_run_of(scene).report);
    expect_nothing_in_tick(scene + " --seconds 0.3");
    expect_nothing_in_tick(scene + " --fast --backend ideal --seconds 2");
  }
  for (const std::string scene : {"anderson_4x8", "two_arms"}) {
    expect_nothing_in_tick(scene + " --threads 2 --fast");
    expect_nothing_in_tick(scene + " --threads 2 --seconds 1");
  }
}

TEST(Counts, SeeWhatIsDoneInATick) {
  for (const Count& count : counts()) {
    if (!count.possible) continue;
    ASSERT_EQ(setenv("REPEL_DISTURBANCE", count.disturbance.c_str(), 1), 0);
    ASSERT_EQ(setenv("LD_PRELOAD", REPEL_DISTURBANCE, 1), 0);
    const auto report = counted("empty --fast --seconds 0.1");
    unsetenv("LD_PRELOAD");
    ASSERT_FALSE(report.at(count.key).is_null()) << "could be counted: " << count.key;
    EXPECT_GE(report.at(count.key), report.at("ticks")) << count.disturbance;
  }
}

}  // namespace counts_test
}  // namespace repel::test
