/// @file
/// The results of an exchange of the coprocessor: forces and totals of the pairs, and the lateness
/// of the workers.
#pragma once

#include <cstdint>

#include <repel/pairs/forces_and_totals.hpp>

namespace repel {

/// Lateness of the workers; all zero without threads.
struct WorkerReport {
  int stood_in = 0;                  ///< workers late at this tick, replaced by the caller
  std::int64_t silence = 0;          ///< [ticks] largest number of late ticks in a row of a worker
  std::int64_t ticks = 0;            ///< number of ticks since set-up with a late worker
  std::int64_t longest_silence = 0;  ///< [ticks] largest `silence` since set-up
};

}  // namespace repel
