// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Runs a scene, in real time or as fast as possible.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <span>

#include <repel/loop/tap.hpp>
#include <repel/network/operator.hpp>
#include <repel/network/remote/link.hpp>
#include <repel/runs/engine/progress_thread.hpp>
#include <repel/runs/operator/controls.hpp>
#include <repel/runs/operator/device.hpp>
#include <repel/runs/options/hand_track.hpp>
#include <repel/runs/records/dated.hpp>
#include <repel/runs/records/recording.hpp>
#include <repel/runs/report/results.hpp>
#include <repel/runs/setup/prepared_run.hpp>

namespace repel::runs {

/// Optional connections of a run. All may be null.
struct Attachments {
  Tap* tap = nullptr;            ///< receives every tick; of the same scene
  Controls* controls = nullptr;  ///< for the first arm, and for pausing, restarting and seeking
  devices::DeviceLink* device = nullptr;  ///< drives the first arm and feels its forces
  const Recording* recording = nullptr;   ///< to replay, instead of simulated arms and operators
  network::RemoteLink* remote = nullptr;  ///< over which the operator of the arm is
  const std::atomic<bool>* at_once = nullptr;  ///< request to end without fading the forces
  BesideTicks* beside = nullptr;               ///< receives what a recording shows of cameras
  /// SessionOptions::on_tick
  std::function<void(const Cell&, std::span<const TickRecord* const>)> on_tick{};
  std::span<const std::optional<network::Command>> hands{};  ///< SessionOptions::hands
  std::span<const HandTrack> tracks{};                       ///< SessionOptions::tracks
};

/// Runs a prepared scene, once. `show` is called from a separate thread, a few times a second. When
/// `stop` becomes true the operators go to rest, and the run ends as soon as the fail-safe has
/// faded the forces, see FadeOut; a replay ends at once. It also ends early when the controls
/// request a restart.
/// @throws SetupError for an arm that cannot be simulated
[[nodiscard]] RunResult run(PreparedRun& prepared, const Attachments& attached,
                            const std::atomic<bool>& stop,
                            const std::function<void(const Progress&)>& show);

}  // namespace repel::runs
