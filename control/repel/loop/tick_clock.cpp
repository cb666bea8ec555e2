// SPDX-License-Identifier: BSD-3-Clause
#include <repel/loop/tick_clock.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

namespace repel {

std::chrono::nanoseconds in_nanoseconds(double seconds) noexcept {
  return std::chrono::nanoseconds(std::llround(1e9 * seconds));
}

Status TickClock::step(nanoseconds now) noexcept {
  elapsed_ = 1;
  const bool runs = now > last_;
  if (runs && has_begun_) {
    const std::int64_t index = (now - first_ + period_ / 4) / period_;
    elapsed_ = std::max<std::int64_t>(1, index - index_);
    index_ += elapsed_;
  } else {
    first_ = now;  // the grid starts here: at the first tick, or again after a fault
    index_ = 0;
  }
  has_begun_ = runs;
  last_ = now;
  if (!runs) return status::clock_fault;
  return elapsed_ * period_ > longest_gap_ ? status::clock_gap : 0U;
}

std::int64_t TickClock::elapsed() const noexcept {
  return elapsed_;
}

}  // namespace repel
