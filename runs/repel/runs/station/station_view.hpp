// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The live view at the operator's side of a divided scene.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include <repel/base/mailbox.hpp>
#include <repel/loop/tap.hpp>
#include <repel/runs/operator/controls.hpp>
#include <repel/runs/options/session_options.hpp>
#include <repel/runs/station/site_twin.hpp>
#include <repel/runs/view/view.hpp>

namespace repel::runs {

/// Controls for pages at a station: they drive, and nothing else.
struct StationControls : Controls {
  explicit StationControls(const SessionOptions& session);
};

/// Shows the twin of the site, placed in a thread of its own.
class StationView {
 public:
  /// @param controls must outlive this object, as must all named in `session`
  /// @param station for the names of its modules
  /// @param device name of the master driving while no page does; empty: none
  /// @throws SetupError for a scene that cannot be built, or as `open_view`
  StationView(const scene::Scene& scene, const RunOptions& options, const SessionOptions& session,
              const std::string& device, const StationSide& station, Controls& controls);
  StationView(const StationView&) = delete;
  StationView& operator=(const StationView&) = delete;
  ~StationView() = default;

  /// By the loop's thread after a tick, outside of the measured time: two copies of some 2 kB.
  void note(const StationSide& station, std::int64_t tick, const TickTimes& times) noexcept;

 private:
  SiteTwin twin_;
  Tap tap_;
  StationShot last_;  // of the loop's thread
  Mailbox<StationShot> shots_;
  std::unique_ptr<View> view_;
  std::jthread thread_;  // last member: joined before the others are destroyed
};

}  // namespace repel::runs
