/// @file
/// What those who look on can do to a run: drive it, pause it, begin anew.
#pragma once

#include <atomic>
#include <cstdint>

#include <repel/base/mailbox.hpp>
#include <repel/base/spatial.hpp>

namespace repel::teleop {

/// Who has the controls.
enum class Driver { script, nobody, page, device };

/// What the one at the controls says, in the words of a rate-controlled master.
struct Grip {
  Driver driver = Driver::script;
  Twist rates;                       ///< [m/s, rad/s] of the tool
  bool in_tool = false;              ///< the axes of the rates are those of the tool, not the world
  double lever_rate = 0.0;           ///< [rad/s] at which the hand leads the lever
  Vec3 direction_W = Vec3::UnitX();  ///< unit: the way the lever drives the tool
};

/// Between the loop and one other thread, without a lock: that thread writes, the loop reads.
struct Controls {
  Mailbox<Grip> grip{Grip{}};  ///< a post says that the driver is there
  std::atomic<bool> paused{false};
  std::atomic<std::int64_t> steps{0};  ///< ticks to make all the same while paused
  std::atomic<bool> restart{false};    ///< end this run and begin another
  bool may_restart = true;             ///< not in the middle of a log; stands from set-up on
  bool over_device = false;            ///< a page may take them from a device; as above
  std::atomic<double> seek{-1.0};      ///< [s] of a replay: go there; negative: nowhere
  std::atomic<double> speed{1.0};      ///< of a replay, against the clock
};

}  // namespace repel::teleop
