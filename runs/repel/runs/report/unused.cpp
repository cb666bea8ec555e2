// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/report/unused.hpp>

#include <algorithm>
#include <functional>

#include <repel/scene/build_network.hpp>

namespace repel::runs {
namespace {

/// Whether `holds` is true of the scene's own setup or of a partner's.
bool any_setup(const scene::Scene& scene,
               const std::function<bool(const scene::ArmSetup&)>& holds) {
  return holds(scene) || std::any_of(scene.partners.begin(), scene.partners.end(), holds);
}

/// Whether the walls apply to any link of the arm.
bool has_links(const scene::ArmSetup& setup) {
  return scene::feels_links(setup) && (!setup.robot.links || !setup.robot.links->empty());
}

bool has_master(const scene::Scene& scene, network::Master master) {
  return any_setup(scene, [master](const scene::ArmSetup& setup) {
    return std::any_of(setup.script.begin(), setup.script.end(),
                       [&](const network::Phase& phase) { return phase.master == master; });
  });
}

/// Threads for which there are no pairs, or no processor, are not started.
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
      r.levels > 0 && r.totals().nearest <= 0.0 ? "" : "reduction levels",
      passable ? "" : "passable bodies",
      any_setup(r.scene, has_links) ? "" : "links of the arm",
      any_setup(r.scene, [](const auto& s) { return s.robot.self_law.has_value(); })
          ? ""
          : "pairs within an arm",
      has_master(r.scene, network::Master::torque_arm) ? "" : "torque arm",
      has_master(r.scene, network::Master::spaceball) ? "" : "space ball",
      r.scene.budget.work_units > 0 ? "" : "counted budget",
      by_wall ? "" : "wall-clock budget",
      r.options.fast ? "metronome and rehearsals" : "",
      r.options.backend == "ideal" ? "arm dynamics" : "",
      r.options.log.empty() ? "log" : ""};
  std::erase(parts, std::string());
  return parts;
}

}  // namespace repel::runs
