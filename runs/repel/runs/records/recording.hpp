// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A recorded run: the inputs and outputs of each tick, read from a file for replay.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <repel/loop/tap.hpp>
#include <repel/runs/options/run_options.hpp>
#include <repel/scene/scene.hpp>

namespace repel::runs {

struct Recording {
  std::string file;
  scene::Scene scene;                         ///< the one that was recorded
  std::vector<std::string> urdf_parts;        ///< lists of parts of meshes in its URDF files
  RunOptions options;                         ///< of the recorded run
  std::vector<std::vector<TickRecord>> arms;  ///< the ticks of each arm
  std::vector<TickTimes> times;               ///< of each tick
  std::int64_t missing = 0;                   ///< ticks dropped while recording
  std::string not_whole;                      ///< why the file is incomplete; empty: it is complete

  [[nodiscard]] std::size_t ticks() const { return times.size(); }
};

/// Reads a file of mcap_log, up to the first missing tick: what follows cannot be replayed.
/// @param find returns the path of the scene of that name; its robots are in the same folder
/// @throws SetupError if the file is no such recording, or a file it needs has changed since
[[nodiscard]] Recording load_recording(const std::string& path,
                                       const std::function<std::string(const std::string&)>& find);

/// @param lists paths of the lists of parts of meshes in URDF files, as used now
/// @throws SetupError unless they are the recorded ones
void require_recorded_lists(const Recording& recording, const std::vector<std::string>& lists);

/// An arm that reports the recorded state and ignores torques.
class RecordedArm final : public TorqueDrivenArm {
 public:
  explicit RecordedArm(const TickRecord& first) : now_(&first) {}

  /// From now on reports the state of `now`, which must stay valid.
  void follow(const TickRecord& now) noexcept { now_ = &now; }

  void set_torques(std::span<const double> /*torques*/) noexcept override {}
  void step(double /*period*/) noexcept override {}
  void read_positions(std::span<double> q) const noexcept override { read(now_->q_read, q); }
  void read_velocities(std::span<double> v) const noexcept override { read(now_->v_read, v); }
  [[nodiscard]] ArmState state() const noexcept override {
    const bool stopped = (now_->status & status::arm_stopped) != 0U;
    return stopped ? ArmState::stopped : ArmState::enabled;
  }
  [[nodiscard]] std::optional<Wrench> read_wrench() const noexcept override {
    return now_->wrench_read;
  }

 private:
  static void read(std::span<const double> values, std::span<double> out) noexcept {
    std::copy_n(values.begin(), out.size(), out.begin());
  }

  const TickRecord* now_;
};

}  // namespace repel::runs
