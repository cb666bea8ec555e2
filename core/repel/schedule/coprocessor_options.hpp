/// @file
/// The budget of the coprocessor per tick, and its options.
#pragma once

#include <chrono>
#include <cstdint>

namespace repel {

/// Budget for the pair evaluations of one tick. A pair that could not be evaluated keeps its last
/// answer, with its distance reduced by the motion since.
struct Budget {
  std::int64_t work_units = 0;  ///< support-map pairs per tick, all blocks together; 0 = no limit.
                                ///< Each block finishes the pair it has begun
  std::chrono::nanoseconds wall{0};  ///< per tick and thread; 0 = no limit
  /// [ticks] A near pair without a new answer for longer than this is expired: its force fades out
  /// linearly and is zero after twice that time.
  std::int64_t max_age = 100;
};

/// How a coprocessor works.
struct CoprocessorOptions {
  int threads = 0;  ///< 0: the caller evaluates all pairs; else twice the memory is allocated
  Budget budget;    ///< per tick; the caller has one thread's budget for each late worker
  std::chrono::nanoseconds period{2500000};   ///< between ticks, so that idle workers can sleep
  std::chrono::nanoseconds patience{500000};  ///< timeout of the caller for an answer; this and
                                              ///< the period are clamped to 0 to 1 s
  void (*on_thread_start)(int index) noexcept = nullptr;  ///< called in each worker: priority etc.
  bool every_pair = false;  ///< no broad phase: evaluate all pairs, as a reference for comparison
  bool lock_step = false;   ///< wait for every answer (up to 1 s) and never sleep: for replays
};

}  // namespace repel
