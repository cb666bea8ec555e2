// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/station/station_view.hpp>

#include <pthread.h>

#include <chrono>

#include <repel/runs/records/heading.hpp>

namespace repel::runs {
namespace {

/// The names of the scene, with the modules on this side of its line.
Heading station_heading(const PreparedRun& prepared, const network::Network& network) {
  Heading heading = heading_of(prepared.scene, prepared.cell);
  std::vector<std::string>& modules = heading.arms.front().modules;
  modules.clear();
  for (const network::Node& node : network.nodes()) modules.push_back(node.name);
  return heading;
}

}  // namespace

StationControls::StationControls(const SessionOptions& session) {
  may_restart = may_change = false;
  over_device = session.page_drives;
  no_conduct = "the robot is elsewhere: from here it can be driven only";
}

StationView::StationView(const scene::Scene& scene, const RunOptions& options,
                         const SessionOptions& session, const std::string& device,
                         const StationSide& station, Controls& controls)
    : twin_(scene, options),
      tap_(twin_.prepared().cell.world()),
      last_(twin_.room()),
      shots_(last_),
      view_(open_view(twin_.prepared(), station_heading(twin_.prepared(), station.network()), false,
                      tap_, controls, session, device)),
      thread_([this](const std::stop_token& stop) {
        (void)pthread_setname_np(pthread_self(), "repel twin");
        auto next = std::chrono::steady_clock::now();
        while (!stop.stop_requested()) {
          next += TapOptions{}.picture_period;
          std::this_thread::sleep_until(next);
          if (shots_.take()) twin_.show(shots_.newest(), tap_);
        }
      }) {}

void StationView::note(const StationSide& station, std::int64_t tick,
                       const TickTimes& times) noexcept {
  runs::note(station, tick, times, last_);
  const TickRecord& record = last_.record;
  tap_.samples().draft() = {tick, record.pairs.nearest, record.virtual_force.force.norm(), times};
  (void)tap_.samples().post();
  shots_.draft() = last_;
  shots_.post();
}

}  // namespace repel::runs
