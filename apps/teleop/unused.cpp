#include "unused.hpp"

#include <algorithm>

namespace repel::teleop {
namespace {

bool has_master(const network::Script& script, network::Master master) {
  return std::any_of(script.begin(), script.end(),
                     [&](const network::Phase& phase) { return phase.master == master; });
}

/// Threads that would find no block of pairs to work on are not begun.
std::string unused_threads(const RunResult& r) {
  if (r.threads == 0) return "coprocessor threads";
  const int unused = r.options.threads - r.threads;
  if (unused == 0) return {};
  return std::to_string(unused) + " of " + std::to_string(r.options.threads) +
         " coprocessor threads";
}

}  // namespace

std::vector<std::string> unused_parts(const RunResult& r) {
  const auto& obstacles = r.scene.obstacles;
  const bool passable =
      std::any_of(obstacles.begin(), obstacles.end(), [](const auto& o) { return o.law.passable; });
  const bool by_wall = r.scene.budget.wall_us > 0.0 && !r.options.fast;
  std::vector<std::string> parts = {
      unused_threads(r),
      r.pairs > 0 ? "" : "distance queries",
      r.totals.nearest > 0.0 ? "reduction levels" : "",
      passable ? "" : "passable bodies",
      has_master(r.scene.script, network::Master::torque_arm) ? "" : "torque arm",
      has_master(r.scene.script, network::Master::spaceball) ? "" : "space ball",
      r.scene.budget.work_units > 0 ? "" : "counted budget",
      by_wall ? "" : "wall-clock budget",
      r.options.fast ? "metronome and rehearsals" : "",
      r.options.backend == "ideal" ? "arm dynamics" : "",
      r.options.keep_records ? "" : "log"};
  std::erase(parts, std::string());
  return parts;
}

}  // namespace repel::teleop
