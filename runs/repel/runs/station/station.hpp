// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The operator's side of a scene divided between two programs.
#pragma once

#include <atomic>
#include <functional>
#include <ostream>

#include <repel/runs/engine/run.hpp>
#include <repel/runs/options/run_options.hpp>
#include <repel/runs/options/session_options.hpp>
#include <repel/runs/report/results.hpp>
#include <repel/runs/wire/link_result.hpp>
#include <repel/scene/scene.hpp>

namespace repel::runs {

/// Measurements of a station.
struct StationResult {
  RunOptions options;
  scene::Scene scene;
  std::int64_t ticks = 0;
  DeadlineMonitor deadline{std::chrono::nanoseconds{2500000}};
  std::int64_t skipped_ticks = 0;
  std::int64_t allocations_in_tick = -1;
  std::int64_t system_calls_in_tick = -1;
  LinkResult link;
  double linked = 0.0;              ///< [s] with the site heard
  double peak_lever_torque = 0.0;   ///< [N m] felt by the operator
  bool has_handle = false;          ///< the operator holds a master of six axes
  double peak_hand_force = 0.0;     ///< [N] felt by the operator at it
  double peak_hand_torque = 0.0;    ///< [N m]
  double peak_virtual_force = 0.0;  ///< [N] on the tool, as the site says
  double nearest = 1e9;             ///< [m] as the site says
  std::vector<ModuleResult> modules;
  bool interrupted = false;
  host::Machine machine;
};

/// Runs the part of the network on the operator's side of its line: by the clock, with the script
/// of the scene, the device or a page, until the script and the time are over or `stop`. It has no
/// arm: near pairs are known at the site only, and a view shows those told by it. Parameters as of
/// run_session.
/// @throws SetupError for an indivisible scene, or a link, a device or an address not available
[[nodiscard]] StationResult run_station(const scene::Scene& scene, const RunOptions& options,
                                        const SessionOptions& session,
                                        const std::atomic<bool>& stop,
                                        const std::function<void(const Progress&)>& show);

void print_station(const StationResult& result, std::FILE* out);
void write_station_json(const StationResult& result, std::ostream& out);

}  // namespace repel::runs
