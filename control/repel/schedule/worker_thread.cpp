// SPDX-License-Identifier: BSD-3-Clause
#include <repel/schedule/worker_thread.hpp>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <thread>

namespace repel::detail {

void Pace::tick() noexcept {
  const std::int64_t now = Clock::now().time_since_epoch().count();
  const std::int64_t last = begun_.load(std::memory_order_relaxed);
  if (last != 0) interval_.store(std::min(now - last, longest), std::memory_order_relaxed);
  begun_.store(now, std::memory_order_relaxed);
}

Pace::Clock::time_point Pace::begun() const noexcept {
  return Clock::time_point(nanoseconds(begun_.load(std::memory_order_relaxed)));
}

Pace::nanoseconds Pace::interval() const noexcept {
  return nanoseconds(interval_.load(std::memory_order_relaxed));
}

std::uint64_t WorkerThread::beats() const noexcept {
  return beats_.load(std::memory_order_relaxed);
}

bool WorkerThread::has_ended() const noexcept {
  return has_ended_.load(std::memory_order_acquire);
}

void WorkerThread::pause() noexcept {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

void WorkerThread::sleep() noexcept {
  const nanoseconds interval = pace_->interval();
  const Clock::time_point due = pace_->begun() + interval;
  const Clock::time_point now = Clock::now();
  const Clock::time_point wake = due - std::min(interval / 2, awake_before);
  if (now + worth_sleeping < wake) {
    std::this_thread::sleep_until(wake);
  } else if (now > due + interval / 2 + patience) {
    std::this_thread::sleep_for(nap_);
    nap_ = std::min(2 * nap_, longest_nap);
  }
}

}  // namespace repel::detail
