// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Measures the interruptions by the machine of a thread reading the clock.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include <repel/host/metronome.hpp>

namespace repel::host {

/// Counts the gaps of more than 10 us between two readings of the clock while ticks ran, and the
/// ticks with such a gap between due time and end. Parts of a gap before the first tick or after
/// the last do not count.
class Hiccups {
 public:
  using nanoseconds = std::chrono::nanoseconds;

  static constexpr nanoseconds threshold{10000};
  /// Lower edges of the bins [us]; the last bin is open.
  static constexpr std::array<int, 10> edges_us{10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000};

  Hiccups() = default;
  /// @param beat schedule of the ticks; time before the first one is due does not count
  explicit Hiccups(const Beat& beat) : beat_(beat) {}

  /// Records the interval between two consecutive readings.
  /// @param done number of ticks that had ended at the first reading
  /// @param until end of the ticks; time after it does not count
  void add(nanoseconds first, nanoseconds second, std::int64_t done, nanoseconds until) noexcept;

  [[nodiscard]] const std::array<std::int64_t, edges_us.size()>& bins() const { return bins_; }
  [[nodiscard]] std::int64_t count() const { return count_; }
  [[nodiscard]] nanoseconds total() const { return total_; }
  [[nodiscard]] nanoseconds longest() const { return longest_; }
  /// Ticks that met a hiccup, each counted once.
  [[nodiscard]] std::int64_t ticks() const { return ticks_; }
  /// Total time during which the clock was read while ticks ran, hiccups included.
  [[nodiscard]] nanoseconds watched() const { return watched_; }

 private:
  Beat beat_;
  std::array<std::int64_t, edges_us.size()> bins_{};
  std::int64_t count_ = 0;
  std::int64_t ticks_ = 0;
  std::int64_t judged_ = 0;  ///< ticks up to this one are counted, or had ended before a hiccup
  nanoseconds total_{0};
  nanoseconds longest_{0};
  nanoseconds watched_{0};
};

/// A thread reading the clock in a loop from construction on. In the real-time class of the ticks,
/// if granted, it sleeps 1 ms in every 10 ms: without sleep it would starve kernel threads.
class HiccupWatch {
 public:
  using nanoseconds = std::chrono::nanoseconds;

  /// Returns once the thread has started reading.
  /// @param processors the thread may run on
  HiccupWatch(const std::vector<int>& processors, const Beat& beat);

  /// Reports that the ticks up to this one, counted from 1, have ended. Wait-free.
  void ended(std::int64_t tick) noexcept { ended_.store(tick, std::memory_order_release); }
  /// Reports that no tick follows; readings beyond `time` do not count. Wait-free.
  void close(nanoseconds time) noexcept { until_.store(time, std::memory_order_release); }

  /// Ends the thread and returns what it measured.
  [[nodiscard]] const Hiccups& stop();
  /// SCHED_FIFO priority of the thread; 0: refused. Valid after stop().
  [[nodiscard]] int priority() const noexcept { return priority_; }

 private:
  void watch(const std::stop_token& stop) noexcept;

  Hiccups hiccups_;
  int priority_ = 0;
  // On separate cache lines, since different threads write them.
  alignas(64) std::atomic<bool> reads_{false};
  alignas(64) std::atomic<std::int64_t> ended_{0};
  std::atomic<nanoseconds> until_{nanoseconds::max()};
  alignas(64) std::jthread thread_;
};

}  // namespace repel::host
