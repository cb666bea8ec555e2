/// @file
/// One near pair as the last tick saw it: for displays and logs.
#pragma once

#include <cstdint>

#include <repel/base/ids.hpp>
#include <repel/reduction/answer.hpp>

namespace repel {

/// A pair that may be within range of its law, what is known of it and how hard it pushes.
struct NearPair {
  PairId pair;
  Separation separation;  ///< the last answer; of an older tick where the pair is stale
  double force = 0.0;     ///< [N] on A along the extraction direction, the opposite on B
  bool stale = false;     ///< it was not asked at this tick: the force is that of the old answer,
                          ///< widened by the motion since
  std::int64_t age = 0;   ///< [ticks] that it has waited for an answer
};

}  // namespace repel
