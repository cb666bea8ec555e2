// SPDX-License-Identifier: BSD-3-Clause
#include <repel/host/trial/trial.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <future>

#include <repel/base/mailbox.hpp>
#include <repel/host/heap_guard.hpp>
#include <repel/host/metronome.hpp>
#include <repel/host/trial/boxes.hpp>

namespace repel::host {
namespace {

using std::chrono::nanoseconds;

/// Kernel counters of all processors since boot, in the kernel's unit.
struct ProcessorTime {
  double stolen = 0.0;
  double total = 0.0;
};

ProcessorTime processor_time() {
  std::ifstream file("/proc/stat");
  std::string name;
  std::array<double, 8> times{};  // user, nice, system, idle, iowait, irq, softirq, steal
  file >> name;
  ProcessorTime sum;
  for (double& time : times) {
    file >> time;
    sum.total += time;
  }
  sum.stolen = times.back();
  return sum;
}

double stolen_share(const ProcessorTime& before, const ProcessorTime& after) {
  const double total = after.total - before.total;
  return total > 0.0 ? (after.stolen - before.stolen) / total : 0.0;
}

/// Runs ticks in the calling thread until their number is reached or `stop`. Returns the end time.
nanoseconds tick_by_the_clock(Trial& trial, Boxes& boxes, const Beat& beat, HiccupWatch* watch,
                              const std::atomic<bool>& stop, Mailbox<TrialProgress>& progress) {
  // Warm up: fault in pages and fill caches, as in a program that has been running.
  for (int i = 0; i < 100; ++i) boxes.tick(0.0);
  const std::int64_t allocations = HeapGuard::allocations();
  Metronome metronome(beat, trial.options.rehearse ? Metronome::longest_spin : nanoseconds(0));
  std::int64_t ticks = 0;
  while (ticks < beat.ticks && !stop) {
    const nanoseconds late = metronome.wait([&] { boxes.rehearse(); });
    const double time = static_cast<double>(++ticks) / trial.options.rate_hz;
    const TickRecord* record = nullptr;
    const nanoseconds begin = steady_now();
    {
      const HeapGuard guard;
      record = &boxes.tick(time);
    }
    const nanoseconds end = steady_now();
    if (watch != nullptr) watch->ended(ticks);
    trial.deadline.record(late, end - begin);
    trial.totals.add(*record);
    const double success_rate = trial.deadline.success_rate();
    if (ticks >= Windows::length) trial.windows.record(success_rate);
    progress.draft() = {time, success_rate, trial.deadline.misses()};
    progress.post();
  }
  const nanoseconds over = std::min(steady_now(), beat.first + ticks * beat.period);
  if (watch != nullptr) watch->close(over);
  if (allocations >= 0) trial.allocations_in_tick = HeapGuard::allocations() - allocations;
  return over;
}

/// Fraction of `span` that was watched, 0 to 1. Clamped, since the watch learns of the end slightly
/// later.
double share(nanoseconds watched, nanoseconds span) {
  if (span <= nanoseconds(0)) return 0.0;
  return std::min(1.0, static_cast<double>(watched.count()) / static_cast<double>(span.count()));
}

/// The schedule of a trial. The first tick is due in 100 ms, so that the threads can start.
Beat beat_of(const TrialOptions& options) {
  const nanoseconds period(std::llround(1e9 / options.rate_hz));
  const std::int64_t ticks = std::llround(options.seconds * options.rate_hz);
  return {steady_now() + std::chrono::milliseconds(100), period, std::max<std::int64_t>(1, ticks)};
}

}  // namespace

void Windows::record(double success_rate) noexcept {
  ++count;
  sum += success_rate;
  worst = std::min(worst, success_rate);
  if (success_rate < sound) ++unsound;
}

double Windows::mean() const noexcept {
  return count > 0 ? sum / static_cast<double>(count) : 1.0;
}

Trial run_trial(const TrialOptions& options, const std::atomic<bool>& stop,
                const std::function<void(const TrialProgress&)>& show) {
  Trial trial;
  trial.options = options;
  Boxes boxes;
  trial.pairs = boxes.pairs();
  const Beat beat = beat_of(options);
  trial.deadline = DeadlineMonitor(beat.period);
  std::vector<int> others = allowed_processors();
  const int own = others.back();
  others.pop_back();
  std::optional<HiccupWatch> watch;
  if (!others.empty()) watch.emplace(others, beat);
  Mailbox<TrialProgress> progress({});
  const ProcessorTime before = processor_time();
  std::future<nanoseconds> ticking = std::async(std::launch::async, [&] {
    if (run_on({own})) trial.processor = own;
    trial.grant = request_real_time();
    return tick_by_the_clock(trial, boxes, beat, watch ? &*watch : nullptr, stop, progress);
  });
  while (ticking.wait_for(std::chrono::milliseconds(200)) != std::future_status::ready) {
    if (progress.take()) show(progress.newest());
  }
  const nanoseconds span = ticking.get() - beat.first;
  trial.stolen = stolen_share(before, processor_time());
  if (watch) {
    trial.hiccups = watch->stop();
    trial.hiccup_priority = watch->priority();
    trial.watched = share(trial.hiccups->watched(), span);
  }
  trial.interrupted = trial.deadline.ticks() < beat.ticks;
  return trial;
}

}  // namespace repel::host
