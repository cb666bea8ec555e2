// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <cinttypes>

#include <repel/host/times.hpp>
#include <repel/host/trial/trial.hpp>

namespace repel::host {

using nlohmann::ordered_json;

namespace {

double in_us(std::chrono::nanoseconds time) {
  return 1e-3 * static_cast<double>(time.count());
}

/// The scheduling class of the HiccupWatch thread, as text.
std::string watcher(const Trial& t) {
  return t.hiccup_priority > 0 ? "SCHED_FIFO " + std::to_string(t.hiccup_priority) : "SCHED_OTHER";
}

ordered_json hiccups_to_json(const Trial& t) {
  if (!t.hiccups) return nullptr;
  ordered_json histogram = ordered_json::array();
  for (std::size_t bin = 0; bin < t.hiccups->bins().size(); ++bin) {
    histogram.push_back({{"from_us", Hiccups::edges_us[bin]}, {"count", t.hiccups->bins()[bin]}});
  }
  return {{"longer_than_us", in_us(Hiccups::threshold)},
          {"scheduler", watcher(t)},
          {"watched_share", t.watched},
          {"count", t.hiccups->count()},
          {"total_us", in_us(t.hiccups->total())},
          {"max_us", in_us(t.hiccups->longest())},
          {"histogram", histogram}};
}

void print_hiccups(const Trial& t, std::FILE* out) {
  if (!t.hiccups) {
    std::fputs("  hiccups                not watched: there is one processor only\n", out);
    return;
  }
  const Hiccups& h = *t.hiccups;
  std::fprintf(out, "  hiccups over 10 µs     %" PRId64 ", together %.2f ms, longest %.2f µs\n",
               h.count(), 1e-3 * in_us(h.total()), in_us(h.longest()));
  const auto& edges = Hiccups::edges_us;
  for (std::size_t bin = 0; bin < edges.size(); ++bin) {
    if (h.bins()[bin] == 0) continue;
    const bool open = bin + 1 == edges.size();
    const std::string to = open ? "µs or more" : "to " + std::to_string(edges[bin + 1]) + " µs";
    std::fprintf(out, "    %5d %-14s %" PRId64 "\n", edges[bin], to.c_str(), h.bins()[bin]);
  }
  std::fprintf(out, "  ticks with a hiccup    %" PRId64 " of %" PRId64 "\n", h.ticks(),
               t.deadline.ticks());
  std::fprintf(out, "  hiccups watched for    %.1f %% of the time, by a thread of %s%s\n",
               1e2 * t.watched, watcher(t).c_str(),
               t.hiccup_priority > 0 ? "" : ": turns of other programs count");
}

}  // namespace

TrialDisplay::TrialDisplay(const TrialOptions& options)
    : options_(options), terminal_(isatty(STDERR_FILENO) != 0) {}

void TrialDisplay::operator()(const TrialProgress& p) {
  if (!terminal_ && p.seconds < next_) return;
  next_ = p.seconds + 5.0;
  std::fprintf(stderr, "%s%g Hz  %7.2f of %g s  misses %" PRId64 "  success rate %.2f%s",
               terminal_ ? "\r" : "", options_.rate_hz, p.seconds, options_.seconds, p.misses,
               p.success_rate, terminal_ ? "\033[K" : "\n");
}

void TrialDisplay::clear() const {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

std::string granted(const Trial& trial) {
  return to_text(trial.grant) + (trial.processor
                                     ? ", bound to processor " + std::to_string(*trial.processor)
                                     : ", bound to no processor");
}

ordered_json to_json(const Trial& t) {
  ordered_json report = {{"rate_hz", t.options.rate_hz},
                         {"seconds", t.options.seconds},
                         {"by_the_clock", true},
                         {"rehearsed", t.options.rehearse},
                         {"threads", 0},
                         {"ticks", t.deadline.ticks()},
                         {"interrupted", t.interrupted}};
  report.update(to_json(t.deadline, 0));
  report["windows_of_100"] = {{"count", t.windows.count},
                              {"below_0_95", t.windows.unsound},
                              {"worst", t.windows.worst},
                              {"mean", t.windows.mean()}};
  report["hiccups"] = hiccups_to_json(t);
  report["ticks_with_hiccup"] = known(t.hiccups ? t.hiccups->ticks() : -1);
  report["stolen_share"] = t.stolen;
  report.update(to_json(t.totals, t.pairs));
  report["allocations_in_tick"] = known(t.allocations_in_tick);
  report["granted"] = {
      {"fifo_priority", t.grant.priority},
      {"memory_locked", t.grant.memory_locked},
      {"processors_kept_awake", t.grant.kept_awake},
      {"processor", t.processor ? ordered_json(*t.processor) : ordered_json(nullptr)}};
  report["machine"] = to_json(describe_machine(granted(t)));
  return report;
}

void print(const Trial& t, std::FILE* out) {
  std::fprintf(out, "\n%" PRId64 " ticks at %g Hz (%.2f s), %s%s\n", t.deadline.ticks(),
               t.options.rate_hz, static_cast<double>(t.deadline.ticks()) / t.options.rate_hz,
               t.options.rehearse ? "rehearsed" : "sleeping in between",
               t.interrupted ? ", interrupted" : "");
  print_times("compute of the tick", t.deadline.compute(), out);
  print_times("wake-up lateness", t.deadline.wakeup(), out);
  std::fprintf(out, "  deadline misses        %" PRId64 "\n", t.deadline.misses());
  std::fprintf(out, "  success rate           mean %.4f, worst %.2f over 100 ticks\n",
               t.windows.mean(), t.windows.worst);
  print_hiccups(t, out);
  print_pairs(t.totals, t.pairs, out);
  print_allocations(t.allocations_in_tick, out);
}

}  // namespace repel::host
