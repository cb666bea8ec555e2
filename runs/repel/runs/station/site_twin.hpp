// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The view of a site at its station: the scene, at the poses told by the site.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <repel/loop/tap.hpp>
#include <repel/runs/setup/prepared_run.hpp>
#include <repel/runs/station/station_side.hpp>
#include <repel/runs/wire/remote_values.hpp>
#include <repel/schedule/coprocessor.hpp>

namespace repel::runs {

/// The state of a station after a tick. Its vector has its size from set-up on.
struct StationShot {
  bool is_told = false;          ///< false: the site was never heard, `record` has no joints
  TickRecord record;             ///< as told by the site; tick, phase, masters, ledgers: as here
  TickTimes times;               ///< of the station
  std::vector<PartState> parts;  ///< what was told last of each, by Scene::loose
};

/// The record of the tick that `station` has made. Allocates nothing.
void note(const StationSide& station, std::int64_t tick, const TickTimes& times,
          StationShot& shot) noexcept;

/// The world of a scene with its arm, moving obstacles and parts at the poses told by the site, and
/// the near pairs there. Not for the tick: a picture costs the kinematics of the arm and an
/// evaluation of all near pairs. The twin knows no parts added by a camera or a page at the site.
/// It has no velocity of the arm, so its forces of single pairs are without damping.
class SiteTwin {
 public:
  /// Builds the scene anew. @throws SetupError for a scene that cannot be built
  SiteTwin(const scene::Scene& scene, const RunOptions& options);

  /// Room for what a station tells it.
  [[nodiscard]] StationShot room() const;
  /// Places everything as told, and shows it.
  void show(const StationShot& shot, Tap& tap) noexcept;

  [[nodiscard]] const PreparedRun& prepared() const noexcept { return *prepared_; }

 private:
  void place_arm(const TickRecord& told) noexcept;
  void place_part(const PartState& told) noexcept;

  std::unique_ptr<PreparedRun> prepared_;
  Coprocessor coprocessor_;
  TickRecord record_;
};

}  // namespace repel::runs
