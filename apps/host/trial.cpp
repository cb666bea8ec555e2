#include "trial.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <future>

#include <repel/base/mailbox.hpp>

#include "boxes.hpp"
#include "metronome.hpp"
#include "times.hpp"

namespace repel::host {
namespace {

using std::chrono::nanoseconds;
using std::chrono::steady_clock;

/// What the kernel counts of all processors since it was started, in its own unit.
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

/// Ticks in the calling thread until the time is over.
void tick_by_the_clock(Trial& trial, const HiccupWatch* watch, const std::atomic<bool>& stop,
                       Mailbox<TrialProgress>& progress) {
  const TrialOptions& options = trial.options;
  const nanoseconds period(std::llround(1e9 / options.rate_hz));
  const auto ticks = static_cast<std::int64_t>(std::llround(options.seconds * options.rate_hz));
  trial.deadline = DeadlineMonitor(period);
  Boxes boxes;
  // Pages and caches are those of a program that has been running.
  for (int i = 0; i < 100; ++i) boxes.tick(0.0);
  Metronome metronome = options.rehearse ? Metronome(period) : Metronome(period, nanoseconds(0));
  for (std::int64_t k = 1; k <= ticks && !stop; ++k) {
    const nanoseconds late = metronome.wait([&] { boxes.rehearse(); });
    const nanoseconds begin = steady_clock::now().time_since_epoch();
    const double time = static_cast<double>(k) / options.rate_hz;
    boxes.tick(time);
    const nanoseconds end = steady_clock::now().time_since_epoch();
    trial.deadline.record(late, end - begin);
    if (watch != nullptr && watch->met(begin - late, end)) ++trial.ticks_in_hiccup;
    const double success_rate = trial.deadline.success_rate();
    if (k % Windows::length == 0) trial.windows.record(success_rate);
    progress.draft() = {time, success_rate, trial.deadline.misses()};
    progress.post();
    trial.skipped_ticks += metronome.catch_up();
  }
}

void print(const Hiccups& hiccups, std::FILE* out) {
  std::fprintf(out, "  hiccups over 10 us     %lld, together %.2f ms, longest %.2f us\n",
               static_cast<long long>(hiccups.count),
               1e-6 * static_cast<double>(hiccups.total.count()),
               1e-3 * static_cast<double>(hiccups.longest.count()));
  for (std::size_t bin = 0; bin < hiccups.bins.size(); ++bin) {
    if (hiccups.bins[bin] == 0) continue;
    std::fprintf(out, "    from %5d us %15lld\n", Hiccups::edges_us[bin],
                 static_cast<long long>(hiccups.bins[bin]));
  }
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
  std::vector<int> others = allowed_processors();
  const int own = others.back();
  others.pop_back();
  std::optional<HiccupWatch> watch;
  if (!others.empty()) watch.emplace(others);
  Mailbox<TrialProgress> progress({});
  const ProcessorTime before = processor_time();
  std::future<void> ticking = std::async(std::launch::async, [&] {
    if (run_on({own})) trial.processor = own;
    trial.grant = request_real_time();
    tick_by_the_clock(trial, watch ? &*watch : nullptr, stop, progress);
  });
  while (ticking.wait_for(std::chrono::milliseconds(200)) != std::future_status::ready) {
    if (progress.take()) show(progress.newest());
  }
  ticking.get();
  const ProcessorTime after = processor_time();
  if (after.total > before.total) {
    trial.stolen = (after.stolen - before.stolen) / (after.total - before.total);
  }
  if (watch) trial.hiccups = watch->stop();
  trial.interrupted = stop;
  return trial;
}

TrialDisplay::TrialDisplay(const TrialOptions& options)
    : options_(options), terminal_(isatty(STDERR_FILENO) != 0) {}

void TrialDisplay::operator()(const TrialProgress& p) {
  if (!terminal_ && p.seconds < next_) return;
  next_ = p.seconds + 5.0;
  std::fprintf(stderr, "%s%g Hz  %7.2f of %g s  misses %lld  success rate %.2f%s",
               terminal_ ? "\r" : "", options_.rate_hz, p.seconds, options_.seconds,
               static_cast<long long>(p.misses), p.success_rate, terminal_ ? "\033[K" : "\n");
}

void TrialDisplay::clear() const {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

std::string granted(const Trial& trial) {
  return to_text(trial.grant) + (trial.processor
                                     ? ", bound to processor " + std::to_string(*trial.processor)
                                     : ", bound to no processor");
}

nlohmann::ordered_json to_json(const Trial& t) {
  using nlohmann::ordered_json;
  return {
      {"rate_hz", t.options.rate_hz},
      {"seconds", t.options.seconds},
      {"ticks", t.deadline.ticks()},
      {"interrupted", t.interrupted},
      {"deadline_misses", t.deadline.misses()},
      {"skipped_ticks", t.skipped_ticks},
      {"success_rate_last_100", t.deadline.success_rate()},
      {"success_rate_lowest", t.deadline.lowest_success_rate()},
      {"windows_of_100",
       {{"count", t.windows.count},
        {"below_0_95", t.windows.unsound},
        {"worst", t.windows.worst},
        {"mean", t.windows.mean()}}},
      {"compute_us", percentiles(t.deadline.compute())},
      {"wakeup_us", percentiles(t.deadline.wakeup())},
      {"hiccups", t.hiccups ? to_json(*t.hiccups) : ordered_json(nullptr)},
      {"ticks_with_hiccup", t.hiccups ? ordered_json(t.ticks_in_hiccup) : ordered_json(nullptr)},
      {"stolen_share", t.stolen},
      {"granted",
       {{"fifo_priority", t.grant.priority},
        {"memory_locked", t.grant.memory_locked},
        {"processors_kept_awake", t.grant.kept_awake},
        {"processor", t.processor ? ordered_json(*t.processor) : ordered_json(nullptr)}}},
      {"machine", to_json(describe_machine(granted(t)))}};
}

void print(const Trial& t, std::FILE* out) {
  const auto count = [](std::int64_t n) { return static_cast<long long>(n); };
  std::fprintf(out, "\n%lld ticks at %g Hz, %s%s\n", count(t.deadline.ticks()), t.options.rate_hz,
               t.options.rehearse ? "rehearsed" : "sleeping in between",
               t.interrupted ? ", interrupted" : "");
  print_times("compute of the tick", t.deadline.compute(), out);
  print_times("wake-up lateness", t.deadline.wakeup(), out);
  std::fprintf(out, "  deadline misses        %lld, skipped ticks %lld\n",
               count(t.deadline.misses()), count(t.skipped_ticks));
  std::fprintf(out, "  windows of 100 ticks   %lld, success rate worst %.2f, mean %.4f\n",
               count(t.windows.count), t.windows.worst, t.windows.mean());
  if (t.hiccups) {
    print(*t.hiccups, out);
    std::fprintf(out, "  ticks with a hiccup    %lld\n", count(t.ticks_in_hiccup));
  } else {
    std::fputs("  hiccups                not watched: there is one processor only\n", out);
  }
  print_machine(describe_machine(granted(t)), out);
}

}  // namespace repel::host
