// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Shows the progress of a run from a thread of its own.
#pragma once

#include <pthread.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include <repel/base/mailbox.hpp>
#include <repel/base/status.hpp>
#include <repel/common/complaint.hpp>

namespace repel::runs {

/// Intermediate state of a run.
struct Progress {
  double time = 0.0;  ///< [s]
  std::int32_t phase = 0;
  double nearest = 0.0;  ///< [m] in this tick
  double force = 0.0;    ///< [N]
  Status status = 0;
  std::int64_t misses = 0;
};

/// A slow terminal cannot delay a tick.
class ProgressThread {
 public:
  ProgressThread(Mailbox<Progress>& box, const std::function<void(const Progress&)>& show)
      : thread_([&box, &show](const std::stop_token& stop) {
          (void)pthread_setname_np(pthread_self(), "repel progress");
          std::mutex mutex;
          std::unique_lock lock(mutex);
          std::condition_variable_any ending;
          while (!stop.stop_requested()) {
            (void)ending.wait_for(lock, stop, std::chrono::milliseconds(200), [] { return false; });
            if (!box.take()) continue;
            const std::string why = complaint_of([&] { show(box.newest()); });
            if (why.empty()) continue;
            std::fprintf(stderr, "Progress is not shown any more, the run goes on: %s\n",
                         why.c_str());
            return;
          }
        }) {}

 private:
  std::jthread thread_;
};

}  // namespace repel::runs
