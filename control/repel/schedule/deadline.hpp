// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Deadline accounting: compute time, wake-up latency and deadline misses of ticks.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>

namespace repel {

/// A log-scale histogram of durations with 64 bins per octave: every percentile is accurate to
/// 1.6 % from 64 ns to 4 s, in 16 kB and without storing the samples. The maximum is exact.
class DurationHistogram {
 public:
  /// Adds a sample; one below zero counts as zero.
  void record(std::chrono::nanoseconds duration) noexcept;

  /// Adds the samples of another one.
  void add(const DurationHistogram& other) noexcept;

  /// The `p` quantile (0 to 1) of the samples [us]; 0 without samples.
  [[nodiscard]] double percentile_us(double p) const noexcept;
  /// [us] The longest; 0 without samples.
  [[nodiscard]] double max_us() const noexcept { return 1e-3 * static_cast<double>(max_); }
  [[nodiscard]] std::int64_t count() const noexcept { return count_; }  ///< number of samples

 private:
  static constexpr int fine_bits = 6;
  static constexpr std::size_t bin_count = std::size_t{32} << fine_bits;

  // Values below 64 have a bin each; above, the leading bit and the next six bits select the bin.
  [[nodiscard]] static std::size_t bin_of(std::uint64_t ns) noexcept;
  [[nodiscard]] static std::uint64_t upper_edge(std::size_t bin) noexcept;

  std::array<std::int64_t, bin_count> bins_{};
  std::int64_t count_ = 0;
  std::int64_t max_ = 0;
};

/// Counts deadline misses: a tick misses its deadline if it finishes later than one period after it
/// was due.
class DeadlineMonitor {
 public:
  /// No ticks yet. @param period between two ticks.
  explicit DeadlineMonitor(std::chrono::nanoseconds period) noexcept : period_(period) {}

  /// Counts `ticks` that were due but skipped: each is a deadline miss.
  void skip(std::int64_t ticks) noexcept;

  /// @param lateness start of the tick minus its due time: wake-up latency
  /// @param compute execution time of the tick
  void record(std::chrono::nanoseconds lateness, std::chrono::nanoseconds compute) noexcept;

  /// Executed plus skipped ticks.
  [[nodiscard]] std::int64_t ticks() const noexcept { return ticks_; }
  /// Ticks that finished late, and skipped ones.
  [[nodiscard]] std::int64_t misses() const noexcept { return misses_; }
  /// Fraction of the last 100 ticks (of all ticks while there are fewer) that met their deadline.
  [[nodiscard]] double success_rate() const noexcept;
  /// The lowest `success_rate` so far.
  [[nodiscard]] double lowest_success_rate() const noexcept { return lowest_; }
  /// The longest time from when a tick was due to its end; skipped ticks have none.
  [[nodiscard]] std::chrono::nanoseconds longest_response() const noexcept;
  /// Of executed ticks.
  [[nodiscard]] const DurationHistogram& compute() const noexcept { return compute_; }
  /// Lateness of executed ticks.
  [[nodiscard]] const DurationHistogram& wakeup() const noexcept { return wakeup_; }

 private:
  static constexpr std::int64_t window = 100;

  void count(bool missed) noexcept;

  std::chrono::nanoseconds period_;
  std::chrono::nanoseconds longest_response_{0};
  std::int64_t ticks_ = 0;
  std::int64_t misses_ = 0;
  std::int64_t recent_misses_ = 0;
  double lowest_ = 1.0;
  std::array<bool, window> recent_{};
  DurationHistogram compute_;
  DurationHistogram wakeup_;
};

}  // namespace repel
