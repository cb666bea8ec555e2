// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A run of an arm with a fault, or without, and what is to be said of it.
#pragma once

#include <string>

#include <repel/base/status.hpp>

#include "rig.hpp"

namespace repel::faults {

/// What truly happened from the fault's begin on.
struct Outcome {
  int begun = -1;            ///< tick in which it began; -1: it never came to the wall
  double deepest = 0.0;      ///< [m] into the wall, beyond that at the begin
  double tool_speed = 0.0;   ///< [m/s] greatest
  double joint_speed = 0.0;  ///< [rad/s] or [m/s] greatest
  bool unsound = false;      ///< a torque that was sent is no number or beyond its effort limit
  Status told = 0;           ///< the first bits that were not there before, of those that tell
  int told_after = -1;       ///< [ticks] since the begin; -1: never
  Status seen = 0;           ///< all bits
  Stop worst = Stop::running;
  bool ran_away = false;  ///< it was given up: 0.1 m deep or at 30 rad/s
};

/// Runs for 3 s after the fault began. @param fault null: none, over the same time
[[nodiscard]] Outcome run(const Setting& setting, const Fault* fault);

enum class Verdict { ok, excused, falls_short };

inline const char* to_text(Verdict verdict) {
  static constexpr const char* names[] = {"ok", "excused", "FALLS SHORT"};
  return names[static_cast<std::size_t>(verdict)];
}

/// @param without the same run without a fault: what a soft wall is compared with
[[nodiscard]] Verdict judge(const Fault& fault, const Setting& setting, const Outcome& outcome,
                            const Outcome& without);

/// What a sound arm met in 8 s before a hard wall.
struct Calm {
  int ticks = 0;
  int blind = 0;         ///< ticks in which readings were not believed
  int stopped = 0;       ///< ticks in which the operator was not in command
  double deepest = 0.0;  ///< [m]
  bool unsound = false;
  Status seen = 0;    ///< bits that remove the operator's force
  Status first = 0;   ///< the first of them
  int first_at = -1;  ///< its tick
};

[[nodiscard]] Calm run(const Setting& setting, const Sound& sound);
[[nodiscard]] Verdict judge(const Calm& calm);

}  // namespace repel::faults
