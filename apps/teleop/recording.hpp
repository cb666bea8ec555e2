/// @file
/// A run that was recorded: what went into each of its ticks, and what came out.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <repel/loop/tap.hpp>
#include <repel/scene/scene.hpp>

#include "run_options.hpp"

namespace repel::teleop {

struct Recording {
  std::string file;
  scene::Scene scene;                         ///< the one that was recorded
  RunOptions options;                         ///< with which it ran
  std::vector<std::vector<TickRecord>> arms;  ///< by arm: its ticks
  std::vector<TickTimes> times;               ///< of each tick
  std::int64_t missing = 0;                   ///< ticks that were dropped while it was recorded
  std::string not_whole;                      ///< why it ends early; empty: it does not

  [[nodiscard]] std::size_t ticks() const { return times.size(); }
};

/// An arm that is where a recording says, whatever it is told.
class RecordedArm {
 public:
  explicit RecordedArm(const TickRecord& first) : now_(&first) {}

  /// What it reads from now on; must stand.
  void follow(const TickRecord& now) noexcept { now_ = &now; }

  void set_torques(std::span<const double> /*torques*/) noexcept {}
  void step(double /*period*/) noexcept {}
  void read_positions(std::span<double> q) const noexcept { read(now_->q_read, q); }
  void read_velocities(std::span<double> v) const noexcept { read(now_->v_read, v); }
  void enable() noexcept {}
  void stop() noexcept {}
  void engage_brakes(bool /*on*/) noexcept {}
  [[nodiscard]] ArmState state() const noexcept {
    const bool stopped = (now_->status & status::arm_stopped) != 0U;
    return stopped ? ArmState::stopped : ArmState::enabled;
  }

 private:
  static void read(std::span<const double> values, std::span<double> out) noexcept {
    std::copy_n(values.begin(), out.size(), out.begin());
  }

  const TickRecord* now_;
};

}  // namespace repel::teleop
