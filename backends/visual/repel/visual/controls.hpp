// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// User control of a run: drive the arm, pause, step, restart, seek.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <repel/base/mailbox.hpp>
#include <repel/base/spatial.hpp>
#include <repel/network/operator.hpp>
#include <repel/schedule/world_changes.hpp>

namespace repel::visual {

/// The source of the operator's commands.
enum class Driver { script, nobody, page, device };

/// Command of the current driver, in the terms of a rate-controlled master.
struct DriverInput {
  Driver driver = Driver::script;    ///< whose command this is
  Twist rates;                       ///< [m/s, rad/s] of the tool
  bool in_tool = false;              ///< the rates are in tool axes, not world axes
  double lever_rate = 0.0;           ///< [rad/s] commanded motion of the lever
  Vec3 direction_W = Vec3::UnitX();  ///< unit: direction in which the lever drives the tool
  Twist second;                      ///< [m/s, rad/s] of a second hand with six axes
  bool second_in_tool = false;       ///< likewise
  // What is switched stays so. As in a network::Phase:
  double scale = 0.0;                           ///< HandInput::scale of both hands; 0: as before
  std::int32_t guides = network::as_before;     ///< HandInput::guides
  double guide_strength = -1.0;                 ///< HandInput::guide_strength; below 0: as before
  std::int32_t compliant = network::as_before;  ///< HandInput::compliant
};

/// Where parts can be asked for while a run lasts. A lock keeps the cell in place, not the tick.
class ChangesPort {
 public:
  /// Of the cell that runs now; null: none.
  void open(WorldChanges* changes) {
    const std::lock_guard lock(mutex_);
    changes_ = changes;
  }
  /// Calls ask(changes) if there is a cell. Returns what it returns, false otherwise.
  template <class Ask>
  bool with(const Ask& ask) {
    const std::lock_guard lock(mutex_);
    return changes_ != nullptr && ask(*changes_);
  }

 private:
  std::mutex mutex_;
  WorldChanges* changes_ = nullptr;
};

/// What is new, by key, for a display that asks now and then: the last value of each. Not for the
/// loop.
template <class Key, class Value>
class Newest {
 public:
  /// Takes a lock and allocates.
  void note(const Key& key, Value value) {
    const std::lock_guard lock(mutex_);
    values_.insert_or_assign(key, std::move(value));
  }
  /// Those noted since the last call.
  [[nodiscard]] std::map<Key, Value> take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(values_, {});
  }

 private:
  std::mutex mutex_;
  std::map<Key, Value> values_;
};

/// The last image of a depth camera, for displays.
struct DepthView {
  int width = 0;                     ///< [px]
  int height = 0;                    ///< [px]
  std::vector<std::uint16_t> depth;  ///< [mm] row by row; 0: nothing was measured
};

/// Lock-free interface between the loop, reading, and one other thread, writing.
struct Controls {
  Mailbox<DriverInput> input{DriverInput{}};  ///< each post also tells that the driver is alive
  std::atomic<bool> paused{false};            ///< the loop waits, but for single steps
  std::atomic<std::int64_t> steps{0};         ///< single ticks to run while paused
  std::atomic<bool> restart{false};           ///< end this run and start another
  bool may_restart = true;                ///< false while a log is written; constant after set-up
  bool over_device = false;               ///< a page may override a device; constant after set-up
  bool may_change = true;                 ///< false while a recording is written; likewise
  std::string no_driving;                 ///< why no page can drive; empty: it may; likewise
  std::string no_conduct;                 ///< why none can pause, step, restart or change parts
  ChangesPort changes;                    ///< not for the loop
  Newest<std::int32_t, Shape> shapes;     ///< that parts have got, by PartId::index
  Newest<std::string, DepthView> depths;  ///< by the name of the camera
  std::atomic<double> seek{-1.0};         ///< [s] replay: time to jump to; negative: none
  std::atomic<double> speed{1.0};         ///< replay: factor on real time
};

}  // namespace repel::visual
