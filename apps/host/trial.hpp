/// @file
/// Ticks by the clock, and what the machine made of them.
#pragma once

#include <atomic>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>
#include <repel/loop/record.hpp>
#include <repel/schedule/deadline.hpp>

#include "hiccups.hpp"
#include "machine.hpp"

namespace repel::host {

struct TrialOptions {
  double rate_hz = 1000.0;  ///< [Hz]
  double seconds = 30.0;    ///< [s]
  bool rehearse = true;     ///< wakes early and keeps the caches warm, as teleop; else sleeps only
};

/// Success rates over all windows of 100 ticks in a row, of which each tick from the 100th on ends
/// one.
struct Windows {
  static constexpr std::int64_t length = 100;
  static constexpr double sound = 0.95;  ///< a window below does not hold the rate

  /// Takes the success rate of the last 100 ticks.
  void record(double success_rate) noexcept;
  [[nodiscard]] double mean() const noexcept;

  std::int64_t count = 0;
  std::int64_t unsound = 0;
  double worst = 1.0;
  double sum = 0.0;
};

/// Everything there is to say about a trial.
struct Trial {
  TrialOptions options;
  Grant grant;
  std::optional<int> processor;  ///< the ticks were bound to; none where that was not granted
  DeadlineMonitor deadline{std::chrono::nanoseconds{0}};
  Windows windows;
  RunTotals totals;
  int pairs = 0;
  std::int64_t allocations_in_tick = -1;  ///< -1: could not be counted
  std::optional<Hiccups> hiccups;         ///< none where the ticks have the only processor
  int hiccup_priority = 0;                ///< of SCHED_FIFO, of who watched for them; 0: refused
  double watched = 0.0;  ///< share of the time of the ticks that was watched, 0 to 1
  double stolen = 0.0;   ///< share of the processors' time a hypervisor took, 0 to 1
  bool interrupted = false;
};

/// What a trial shows of itself while it lasts.
struct TrialProgress {
  double seconds = 0.0;
  double success_rate = 1.0;  ///< of the last 100 ticks
  std::int64_t misses = 0;
};

/// Runs the tick of Boxes in a thread of its own, with a HiccupWatch beside it. Every tick is run,
/// however late. `show` is called a few times a second. Ends early when `stop` becomes true.
[[nodiscard]] Trial run_trial(const TrialOptions& options, const std::atomic<bool>& stop,
                              const std::function<void(const TrialProgress&)>& show);

/// One line on stderr that is written over on a terminal, and a line every five seconds elsewhere.
class TrialDisplay {
 public:
  explicit TrialDisplay(const TrialOptions& options);
  void operator()(const TrialProgress& progress);
  /// Makes room for what is printed next.
  void clear() const;

 private:
  TrialOptions options_;
  bool terminal_;
  double next_ = 0.0;
};

/// What was granted, in words.
[[nodiscard]] std::string granted(const Trial& trial);

[[nodiscard]] nlohmann::ordered_json to_json(const Trial& trial);

/// Prints everything there is to say but the machine, over several lines.
void print(const Trial& trial, std::FILE* out);

}  // namespace repel::host
