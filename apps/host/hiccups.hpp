/// @file
/// What the machine does to a program that only reads the clock.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include "metronome.hpp"

namespace repel::host {

/// Gaps of more than 10 us between two readings of the clock while ticks ran, and how many ticks
/// met one between the time they were due and their end. Of a gap that began earlier or ends later
/// the part in between counts.
class Hiccups {
 public:
  using nanoseconds = std::chrono::nanoseconds;

  static constexpr nanoseconds threshold{10000};
  /// Lower edges of the bins [us]; the last bin is open.
  static constexpr std::array<int, 10> edges_us{10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000};

  Hiccups() = default;
  /// @param beat of the ticks; time before the first one is due does not count
  explicit Hiccups(const Beat& beat) : beat_(beat) {}

  /// Takes the time between two readings that follow each other.
  /// @param done how many ticks had ended at the first reading
  /// @param until the ticks were over; time after it does not count
  void add(nanoseconds first, nanoseconds second, std::int64_t done, nanoseconds until) noexcept;

  [[nodiscard]] const std::array<std::int64_t, edges_us.size()>& bins() const { return bins_; }
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] nanoseconds total() const { return total_; }
  [[nodiscard]] nanoseconds longest() const { return longest_; }
  /// Ticks that met a hiccup, each counted once.
  [[nodiscard]] std::int64_t ticks() const { return ticks_; }
  /// How long the clock was read while ticks ran, hiccups included.
  [[nodiscard]] nanoseconds watched() const { return watched_; }

 private:
  Beat beat_;
  std::array<std::int64_t, edges_us.size()> bins_{};
  std::int64_t count_ = 0;
  std::int64_t ticks_ = 0;
  std::int64_t judged_ = 0;  ///< ticks up to here met a hiccup or had ended before it
  nanoseconds total_{0};
  nanoseconds longest_{0};
  nanoseconds watched_{0};
};

/// A thread that reads the clock in a loop, from construction on. It has the scheduling class of
/// the ticks where that is granted, and then rests for a millisecond in ten: a thread of real-time
/// priority that never sleeps would starve the kernel's own.
class HiccupWatch {
 public:
  using nanoseconds = std::chrono::nanoseconds;

  /// Returns once it reads.
  /// @param processors it may run on
  HiccupWatch(const std::vector<int>& processors, const Beat& beat);

  /// The ticks up to this one, counted from 1, have ended. Wait-free.
  void ended(std::int64_t tick) noexcept { ended_.store(tick, std::memory_order_release); }
  /// No tick follows; what is read from now on does not count beyond `time`. Wait-free.
  void close(nanoseconds time) noexcept { until_.store(time, std::memory_order_release); }

  /// Ends the thread; what it saw.
  [[nodiscard]] const Hiccups& stop();
  /// Of SCHED_FIFO; 0: refused. Known after stop().
  [[nodiscard]] int priority() const noexcept { return priority_; }

 private:
  void watch(const std::stop_token& stop) noexcept;

  Hiccups hiccups_;
  int priority_ = 0;
  // Each is written by another thread than its neighbours.
  alignas(64) std::atomic<bool> reads_{false};
  alignas(64) std::atomic<std::int64_t> ended_{0};
  std::atomic<nanoseconds> until_{nanoseconds::max()};
  alignas(64) std::jthread thread_;
};

}  // namespace repel::host
