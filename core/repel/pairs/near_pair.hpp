// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One near pair as the last tick evaluated it: for displays and logs.
#pragma once

#include <cstdint>

#include <repel/base/ids.hpp>
#include <repel/reduction/separation_result.hpp>

namespace repel {

/// A pair that may be within the range of its law, its last answer and its force.
struct NearPair {
  PairId pair;              ///< which of the world
  Separation separation;    ///< the last answer; of an older tick if the pair is stale
  double force = 0.0;       ///< [N] on A along the extraction direction, the opposite on B
  bool stale = false;       ///< not evaluated at this tick: the force is computed from the old
                            ///< answer, with its distance reduced by the motion since
  std::int64_t age = 0;     ///< [ticks] how long it has waited for an evaluation
  bool has_patch = false;   ///< the force acts on a contact patch, not at the nearest points
  bool is_watched = false;  ///< out of its range, before a hard wall, and not evaluated at this
                            ///< tick: what counts is the direction of its separation
};

}  // namespace repel
