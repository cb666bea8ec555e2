// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Deadline accounting: compute time, wake-up latency and deadline misses of ticks.
#pragma once

#include <array>
#include <bit>
#include <chrono>
#include <cstddef>
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
  [[nodiscard]] std::chrono::nanoseconds longest_response() const noexcept {
    return longest_response_;
  }
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

inline void DurationHistogram::record(std::chrono::nanoseconds duration) noexcept {
  const std::int64_t ns = duration.count() > 0 ? duration.count() : 0;
  ++bins_[bin_of(static_cast<std::uint64_t>(ns))];
  ++count_;
  if (ns > max_) max_ = ns;
}

inline void DurationHistogram::add(const DurationHistogram& other) noexcept {
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) bins_[bin] += other.bins_[bin];
  count_ += other.count_;
  if (other.max_ > max_) max_ = other.max_;
}

inline double DurationHistogram::percentile_us(double p) const noexcept {
  if (count_ == 0) return 0.0;
  const double wanted = p * static_cast<double>(count_);
  std::int64_t seen = 0;
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
    seen += bins_[bin];
    if (static_cast<double>(seen) >= wanted && seen > 0) {
      const double top = static_cast<double>(upper_edge(bin));
      return 1e-3 * (top < static_cast<double>(max_) ? top : static_cast<double>(max_));
    }
  }
  return max_us();
}

inline std::size_t DurationHistogram::bin_of(std::uint64_t ns) noexcept {
  if (ns < (1U << fine_bits)) return static_cast<std::size_t>(ns);
  const int shift = static_cast<int>(std::bit_width(ns)) - 1 - fine_bits;
  const std::size_t bin = (static_cast<std::size_t>(shift + 1) << fine_bits) +
                          static_cast<std::size_t>((ns >> shift) - (1U << fine_bits));
  return bin < bin_count ? bin : bin_count - 1;
}

inline std::uint64_t DurationHistogram::upper_edge(std::size_t bin) noexcept {
  if (bin < (1U << fine_bits)) return bin;
  const std::size_t shift = (bin >> fine_bits) - 1;
  return (((bin & ((1U << fine_bits) - 1)) + (1U << fine_bits) + 1) << shift) - 1;
}

inline void DeadlineMonitor::skip(std::int64_t ticks) noexcept {
  for (std::int64_t i = 0; i < ticks; ++i) count(true);
}

inline void DeadlineMonitor::record(std::chrono::nanoseconds lateness,
                                    std::chrono::nanoseconds compute) noexcept {
  wakeup_.record(lateness);
  compute_.record(compute);
  const std::chrono::nanoseconds response = lateness + compute;
  if (response > longest_response_) longest_response_ = response;
  count(response > period_);
}

inline double DeadlineMonitor::success_rate() const noexcept {
  const std::int64_t seen = ticks_ < window ? ticks_ : window;
  return seen == 0 ? 1.0 : 1.0 - static_cast<double>(recent_misses_) / static_cast<double>(seen);
}

inline void DeadlineMonitor::count(bool missed) noexcept {
  misses_ += missed ? 1 : 0;
  const std::size_t slot = static_cast<std::size_t>(ticks_ % window);
  recent_misses_ += (missed ? 1 : 0) - (recent_[slot] ? 1 : 0);
  recent_[slot] = missed;
  ++ticks_;
  const double rate = success_rate();
  if (rate < lowest_) lowest_ = rate;
}

}  // namespace repel
