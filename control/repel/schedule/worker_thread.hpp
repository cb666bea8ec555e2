// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A thread of the coprocessor, and how it passes the time between ticks.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <utility>

#include <repel/schedule/coprocessor_options.hpp>
#include <repel/schedule/thread_usage.hpp>

namespace repel::detail {

/// When the last tick with work began and how long after the one before: so a thread knows when it
/// is wanted next. Written by one thread, read by all; wait-free.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;
  using nanoseconds = std::chrono::nanoseconds;

  /// @param period [ns] the interval until two ticks have been seen
  explicit Pace(nanoseconds period) noexcept : interval_(period.count()) {}

  /// A tick with work begins. Reads the clock.
  void tick() noexcept;
  [[nodiscard]] Clock::time_point begun() const noexcept;
  [[nodiscard]] nanoseconds interval() const noexcept;

 private:
  static constexpr std::int64_t longest = 1'000'000'000;

  std::atomic<std::int64_t> begun_{0};
  std::atomic<std::int64_t> interval_;
};

/// A thread that calls a function again and again; when that finds nothing to do, it waits: it
/// sleeps until shortly before the next tick is due, spins for it, and sleeps longer and longer
/// while none comes. Nobody has to wake it, since that would be a system call in the tick.
class WorkerThread {
 public:
  WorkerThread(const CoprocessorOptions& options, int index, const Pace& pace) noexcept
      : options_(options), index_(index), pace_(&pace) {}

  /// Starts the thread. @param work `bool work() noexcept`, false if there was nothing to do;
  /// called in the thread, until `stop`
  template <class Work>
  void start(Work work) {
    thread_ = std::jthread([this, work = std::move(work)](const std::stop_token& stop) mutable {
      usage_.attach_to_this_thread();
      if (options_.on_thread_start != nullptr) options_.on_thread_start(index_);
      serve(stop, work);
      has_ended_.store(true, std::memory_order_release);
    });
  }
  /// Asks the thread to end; it does so when `work` returns.
  void request_stop() noexcept { thread_.request_stop(); }
  /// Joins the thread: blocks for ever if it is stalled for ever, but not if it was killed.
  void stop() { thread_ = {}; }

  /// Grows while the thread is alive and not within `work`.
  [[nodiscard]] std::uint64_t beats() const noexcept;
  /// The thread will not do any more work.
  [[nodiscard]] bool has_ended() const noexcept;
  /// Page faults and switches since the start. Not for the tick.
  [[nodiscard]] const ThreadUsage::Counts& look_at_usage() noexcept { return usage_.look(); }

  /// One iteration of a spin wait.
  static void pause() noexcept;

 private:
  using Clock = std::chrono::steady_clock;
  using nanoseconds = std::chrono::nanoseconds;

  template <class Work>
  void serve(const std::stop_token& stop, Work& work) noexcept {
    nap_ = shortest_nap;
    for (unsigned spins = 1; !stop.stop_requested(); ++spins) {
      beats_.store(beats_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
      if (work()) {
        spins = 0;
        nap_ = shortest_nap;
        continue;
      }
      pause();
      // In lock step there may be more threads than processors, and the ticks do not come by the
      // clock.
      if (options_.lock_step) {
        if (spins % 4096 == 0) std::this_thread::yield();
      } else if (spins % 64 == 0) {
        sleep();
      }
    }
  }

  void sleep() noexcept;

  static constexpr nanoseconds awake_before{200'000};
  static constexpr nanoseconds worth_sleeping{50'000};
  static constexpr nanoseconds patience{300'000};
  static constexpr nanoseconds shortest_nap{250'000};
  static constexpr nanoseconds longest_nap{4'000'000};

  CoprocessorOptions options_;
  int index_;
  const Pace* pace_;
  nanoseconds nap_ = shortest_nap;
  ThreadUsage usage_;
  std::atomic<std::uint64_t> beats_{0};
  std::atomic<bool> has_ended_{false};
  std::jthread thread_;  // last member: joined before the data it uses is destroyed
};

}  // namespace repel::detail
