// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Conditions that every report of real-time trials must satisfy on any machine.
#pragma once

#include "end_to_end/program.hpp"

namespace repel::test {

inline void expect_ordered(const nlohmann::json& times, const char* what) {
  EXPECT_GE(times.at("p50"), 0.0) << what;
  EXPECT_LE(times.at("p50"), times.at("p99")) << what;
  EXPECT_LE(times.at("p99"), times.at("p99_9")) << what;
  EXPECT_LE(times.at("p99_9"), times.at("max")) << what;
}

inline void expect_hiccups(const nlohmann::json& report) {
  const nlohmann::json& hiccups = report.at("hiccups");
  if (hiccups.is_null()) {  // a single processor, occupied by the ticks
    EXPECT_TRUE(report.at("ticks_with_hiccup").is_null());
    return;
  }
  std::int64_t sum = 0;
  for (const auto& bin : hiccups.at("histogram")) sum += bin.at("count").get<std::int64_t>();
  EXPECT_EQ(sum, hiccups.at("count"));
  const double longest = hiccups.at("max_us");
  const double total = hiccups.at("total_us");
  EXPECT_GE(total, longest);
  EXPECT_EQ(sum > 0, longest > 0.0);
  EXPECT_GT(hiccups.at("watched_share"), 0.0);
  EXPECT_LE(hiccups.at("watched_share"), 1.0);
  EXPECT_GE(report.at("ticks_with_hiccup"), 0);
  EXPECT_LE(report.at("ticks_with_hiccup"), report.at("ticks"));
}

/// Every pair is evaluated in every tick, without heap allocation.
inline void expect_work(const nlohmann::json& report) {
  EXPECT_EQ(report.at("pairs"), 32);
  EXPECT_EQ(report.at("pairs_near_per_tick"), 32.0);
  EXPECT_EQ(report.at("pairs_evaluated_per_tick"), 32.0);
  EXPECT_EQ(report.at("pairs_stale"), 0);
  EXPECT_GT(report.at("peak_force_n"), 0.0);
  const nlohmann::json& allocations = report.at("allocations_in_tick");
  EXPECT_TRUE(allocations.is_null() || allocations == 0) << allocations;
}

/// @param ticks requested: all are run, even if late
inline void expect_trial(const nlohmann::json& report, double rate_hz, std::int64_t ticks) {
  EXPECT_EQ(report.at("rate_hz"), rate_hz);
  EXPECT_EQ(report.at("ticks"), ticks);
  EXPECT_FALSE(report.at("interrupted"));
  EXPECT_LE(report.at("deadline_misses"), ticks);
  EXPECT_EQ(report.at("skipped_ticks"), 0);
  EXPECT_EQ(report.at("windows_of_100").at("count"), ticks - 99);
  EXPECT_LE(report.at("windows_of_100").at("worst"), report.at("windows_of_100").at("mean"));
  EXPECT_LE(report.at("success_rate_lowest"), report.at("success_rate_last_100"));
  expect_ordered(report.at("compute_us"), "compute");
  EXPECT_GT(report.at("compute_us").at("p50"), 0.0);
  expect_ordered(report.at("wakeup_us"), "lateness");
  expect_hiccups(report);
  expect_work(report);
  for (const char* what :
       {"fifo_priority", "memory_locked", "processors_kept_awake", "processor"}) {
    EXPECT_TRUE(report.at("granted").contains(what)) << what;
  }
  EXPECT_FALSE(report.at("machine").at("scheduler").get<std::string>().empty());
}

}  // namespace repel::test
