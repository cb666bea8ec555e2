// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/options/budget.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace repel::runs {
namespace {

constexpr std::int64_t most_units = 1'000'000'000;

/// 0 for anything but a whole number from 1 to most_units.
std::int64_t units_in(const std::string& digits) {
  std::int64_t units = 0;
  const char* const end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, units);
  const bool sound = error == std::errc() && rest == end && units >= 1 && units <= most_units;
  return sound ? units : 0;
}

}  // namespace

std::string budget_complaint(const std::string& name) {
  if (name == "i860" || name == "none" || units_in(name) > 0) return {};
  return "'" + name + "' is not a budget; allowed: i860, none, or support pairs per tick, 1 to " +
         std::to_string(most_units);
}

scene::Budget budget_of(const scene::Scene& scene, const std::string& name, double rate_hz) {
  scene::Budget budget = scene.budget;
  if (name.empty()) return budget;
  budget.wall_us = 0.0;
  budget.work_units = name == "i860"
                          ? std::max<std::int64_t>(1, std::llround(i860_units_per_second / rate_hz))
                          : units_in(name);
  return budget;
}

}  // namespace repel::runs
