// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/trial/hiccups.hpp>

#include <algorithm>

#include <repel/host/machine.hpp>

namespace repel::host {

void Hiccups::add(nanoseconds first, nanoseconds second, std::int64_t done,
                  nanoseconds until) noexcept {
  const bool is_hiccup = second - first > threshold;
  second = std::min(second, until);
  const nanoseconds gap = second - std::max(first, beat_.first);
  if (gap <= nanoseconds(0)) return;
  watched_ += gap;
  if (!is_hiccup) return;
  std::size_t bin = edges_us.size() - 1;
  while (bin > 0 && gap < std::chrono::microseconds(edges_us[bin])) --bin;
  ++bins_[bin];
  ++count_;
  total_ += gap;
  longest_ = std::max(longest_, gap);
  const std::int64_t due = beat_.due_before(second);
  ticks_ += std::max<std::int64_t>(0, due - std::max(done, judged_));
  judged_ = std::max(judged_, due);
}

HiccupWatch::HiccupWatch(const std::vector<int>& processors, const Beat& beat)
    : hiccups_(beat), thread_([this, processors](const std::stop_token& stop) {
        (void)run_on(processors);
        priority_ = follow_real_time();
        watch(stop);
      }) {
  while (!reads_.load(std::memory_order_acquire)) std::this_thread::yield();
}

const Hiccups& HiccupWatch::stop() {
  thread_ = {};
  return hiccups_;
}

void HiccupWatch::watch(const std::stop_token& stop) noexcept {
  constexpr std::chrono::milliseconds between_rests{9};
  // Read before the clock, so that a tick that ends between the two reads still counts as affected
  // by what follows the reading.
  std::int64_t done = ended_.load(std::memory_order_acquire);
  nanoseconds last = steady_now();
  nanoseconds rest_at = last + between_rests;
  reads_.store(true, std::memory_order_release);
  for (bool last_round = false; !last_round;) {
    last_round = stop.stop_requested();  // one more round: a hiccup may be in progress
    const std::int64_t next_done = ended_.load(std::memory_order_acquire);
    const nanoseconds reading = steady_now();
    hiccups_.add(last, reading, done, until_.load(std::memory_order_acquire));
    done = next_done;
    last = reading;
    if (priority_ == 0 || last < rest_at) continue;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    done = ended_.load(std::memory_order_acquire);
    last = steady_now();
    rest_at = last + between_rests;
  }
}

}  // namespace repel::host
