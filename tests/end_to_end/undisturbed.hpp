// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Runs by the clock that the machine did not disturb.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

namespace repel::test {

/// Whether the machine let a loop run at all its due times, less than 50 ms late. One that stood
/// still has the force fade out and the arm stop. What a script does meanwhile is lost.
inline bool was_undisturbed(const nlohmann::json& report) {
  return report.at("skipped_ticks") == 0;
}

/// The reports of `trial()`. It runs programs by the clock and asserts the invariants. A trial that
/// the machine disturbed is repeated, twice at most. Empty if all were disturbed: then there is
/// nothing to say of what depends on the clock.
template <class Trial>
std::vector<nlohmann::json> undisturbed(Trial&& trial) {
  for (int run = 0; run < 3; ++run) {
    std::vector<nlohmann::json> reports = trial();
    bool all = true;
    for (const nlohmann::json& report : reports) all = all && was_undisturbed(report);
    if (all) return reports;
  }
  return {};
}

inline constexpr const char* stood_still = "the machine stood still in three runs of three";

}  // namespace repel::test
