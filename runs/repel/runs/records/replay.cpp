// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/records/replay.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace repel::runs {
namespace {

using std::chrono::nanoseconds;

template <class Values>
bool same_bits(const Values& a, const Values& b) {
  return std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

/// Unlike ==, tells 0 from -0 and takes a NaN for equal to itself.
bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

bool same_bits(const Wrench& a, const Wrench& b) {
  return same_bits(a.force, b.force) && same_bits(a.torque, b.torque);
}

}  // namespace

void compare(const Recording& recording, std::size_t tick,
             std::span<const TickRecord* const> records, ReplayReport& report) {
  bool same = true;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const TickRecord& then = recording.arms[i][tick];
    const TickRecord& now = *records[i];
    same = same && same_bits(then.virtual_force, now.virtual_force) &&
           same_bits(then.coupling, now.coupling) && same_bits(then.torques, now.torques) &&
           same_bits(then.lever_torque, now.lever_torque) && same_bits(then.gain, now.gain);
    report.force_difference = std::max(report.force_difference,
                                       (then.virtual_force.force - now.virtual_force.force).norm());
  }
  ++report.ticks;
  report.same += same ? 1 : 0;
  if (!same && report.first_difference < 0) report.first_difference = records.front()->tick;
}

nanoseconds RegularClock::next(std::size_t tick) noexcept {
  if (recording_ == nullptr) return now_ += period_;
  const TickRecord& then = recording_->arms.front()[tick];
  // A clock that jumped to its end was recorded as so many periods.
  const bool has_room = then.elapsed <= (nanoseconds::max() - now_) / period_;
  now_ = has_room ? now_ + then.elapsed * period_ : nanoseconds::max();
  const bool stood = (then.status & status::clock_fault) != 0U;
  return stood ? nanoseconds::min() : now_;
}

}  // namespace repel::runs
