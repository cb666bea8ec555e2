// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The thread that looks after the threads of the coprocessor.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <utility>

namespace repel::detail {

/// Calls a function every `interval`, in a thread of its own that has nothing to do with real time:
/// it may allocate and start threads.
class Supervisor {
 public:
  static constexpr std::chrono::milliseconds interval{50};

  template <class Tend>
  void start(Tend tend) {
    thread_ = std::jthread([this, tend = std::move(tend)](const std::stop_token& stop) mutable {
      std::unique_lock<std::mutex> lock(mutex_);
      while (!stop.stop_requested()) {
        (void)wake_.wait_for(lock, stop, interval, [] { return false; });
        if (!stop.stop_requested()) tend();
      }
    });
  }
  /// Returns when the function is not running and will not be called again.
  void stop() { thread_ = {}; }

 private:
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;
};

/// Whether something that ought to change has not changed for `limit` looks in a row. By looks, not
/// by the clock: after the whole process was stopped, nothing is overdue.
class Watch {
 public:
  static constexpr int limit = 10;

  /// @param value that changes while all is well @return true once, when it has stood for too long
  bool is_overdue(std::uint64_t value) noexcept;

 private:
  std::uint64_t last_ = 0;
  int stood_ = 0;
};

}  // namespace repel::detail
