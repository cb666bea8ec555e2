// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/deadline.hpp>

#include <bit>
#include <chrono>
#include <cstdint>

namespace repel {

void DurationHistogram::record(std::chrono::nanoseconds duration) noexcept {
  const std::int64_t ns = duration.count() > 0 ? duration.count() : 0;
  ++bins_[bin_of(static_cast<std::uint64_t>(ns))];
  ++count_;
  if (ns > max_) max_ = ns;
}

void DurationHistogram::add(const DurationHistogram& other) noexcept {
  for (std::size_t bin = 0; bin < bins_.size(); ++bin) bins_[bin] += other.bins_[bin];
  count_ += other.count_;
  if (other.max_ > max_) max_ = other.max_;
}

double DurationHistogram::percentile_us(double p) const noexcept {
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

std::size_t DurationHistogram::bin_of(std::uint64_t ns) noexcept {
  if (ns < (1U << fine_bits)) return static_cast<std::size_t>(ns);
  const int shift = static_cast<int>(std::bit_width(ns)) - 1 - fine_bits;
  const std::size_t bin = (static_cast<std::size_t>(shift + 1) << fine_bits) +
                          static_cast<std::size_t>((ns >> shift) - (1U << fine_bits));
  return bin < bin_count ? bin : bin_count - 1;
}

std::uint64_t DurationHistogram::upper_edge(std::size_t bin) noexcept {
  if (bin < (1U << fine_bits)) return bin;
  const std::size_t shift = (bin >> fine_bits) - 1;
  return (((bin & ((1U << fine_bits) - 1)) + (1U << fine_bits) + 1) << shift) - 1;
}

void DeadlineMonitor::skip(std::int64_t ticks) noexcept {
  for (std::int64_t i = 0; i < ticks; ++i) count(true);
}

void DeadlineMonitor::record(std::chrono::nanoseconds lateness,
                             std::chrono::nanoseconds compute) noexcept {
  wakeup_.record(lateness);
  compute_.record(compute);
  const std::chrono::nanoseconds response = lateness + compute;
  if (response > longest_response_) longest_response_ = response;
  count(response > period_);
}

double DeadlineMonitor::success_rate() const noexcept {
  const std::int64_t seen = ticks_ < window ? ticks_ : window;
  return seen == 0 ? 1.0 : 1.0 - static_cast<double>(recent_misses_) / static_cast<double>(seen);
}

std::chrono::nanoseconds DeadlineMonitor::longest_response() const noexcept {
  return longest_response_;
}

void DeadlineMonitor::count(bool missed) noexcept {
  misses_ += missed ? 1 : 0;
  const std::size_t slot = static_cast<std::size_t>(ticks_ % window);
  recent_misses_ += (missed ? 1 : 0) - (recent_[slot] ? 1 : 0);
  recent_[slot] = missed;
  ++ticks_;
  const double rate = success_rate();
  if (rate < lowest_) lowest_ = rate;
}

}  // namespace repel
