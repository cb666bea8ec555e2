// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Runs periodic ticks in real time and measures how well the machine keeps up.
#pragma once

#include <atomic>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>
#include <repel/common/deadline.hpp>
#include <repel/host/machine.hpp>
#include <repel/host/trial/hiccups.hpp>
#include <repel/loop/record.hpp>

namespace repel::host {

struct TrialOptions {
  double rate_hz = 1000.0;  ///< [Hz]
  double seconds = 30.0;    ///< [s]
  bool rehearse = true;     ///< wakes early, keeps the caches warm, as teleop; else sleeps only
};

/// Success rates over all windows of 100 consecutive ticks; from the 100th on, each tick ends one.
struct Windows {
  static constexpr std::int64_t length = 100;
  static constexpr double sound = 0.95;  ///< a window below this does not hold the rate

  /// Records the success rate of the last 100 ticks.
  void record(double success_rate) noexcept;
  [[nodiscard]] double mean() const noexcept;

  std::int64_t count = 0;
  std::int64_t unsound = 0;
  double worst = 1.0;
  double sum = 0.0;
};

/// The results of a trial.
struct Trial {
  TrialOptions options;
  Grant grant;
  std::optional<int> processor;  ///< to which the ticks were bound; none if refused
  DeadlineMonitor deadline{std::chrono::nanoseconds{0}};
  Windows windows;
  RunTotals totals;
  int pairs = 0;
  std::int64_t allocations_in_tick = -1;  ///< -1: could not be counted
  std::optional<Hiccups> hiccups;         ///< none if there is only one processor
  int hiccup_priority = 0;                ///< SCHED_FIFO priority of the HiccupWatch; 0: refused
  double watched = 0.0;  ///< fraction of the time of the ticks that was watched, 0 to 1
  double stolen = 0.0;   ///< fraction of processor time taken by a hypervisor, 0 to 1
  bool interrupted = false;
};

/// Intermediate state of a running trial.
struct TrialProgress {
  double seconds = 0.0;
  double success_rate = 1.0;  ///< of the last 100 ticks
  std::int64_t misses = 0;
};

/// Runs the tick of Boxes in its own thread, with a HiccupWatch beside it. No tick is skipped,
/// however late. `show` is called a few times per second. Ends early when `stop` becomes true.
[[nodiscard]] Trial run_trial(const TrialOptions& options, const std::atomic<bool>& stop,
                              const std::function<void(const TrialProgress&)>& show);

/// One status line on stderr, overwritten in place on a terminal; elsewhere a line every five
/// seconds.
class TrialDisplay {
 public:
  explicit TrialDisplay(const TrialOptions& options);
  void operator()(const TrialProgress& progress);
  /// Clears the status line, for what is printed next.
  void clear() const;

 private:
  TrialOptions options_;
  bool terminal_;
  double next_ = 0.0;
};

/// What was granted, as text.
[[nodiscard]] std::string granted(const Trial& trial);

[[nodiscard]] nlohmann::ordered_json to_json(const Trial& trial);

/// Prints the results, without the machine, over several lines.
void print(const Trial& trial, std::FILE* out);

}  // namespace repel::host
