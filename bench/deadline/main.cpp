// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How well ticks meet their deadlines on this machine, at several rates, compared with the jitter
/// of a thread that only reads the clock.

#include <cinttypes>

#include <repel/host/command_line.hpp>
#include <repel/host/times.hpp>
#include <repel/host/trial/trial.hpp>

#include "trials_page.hpp"

namespace {

using namespace repel;

struct Arguments {
  std::vector<double> rates_hz = {400.0, 1000.0, 4000.0, 10000.0};
  double seconds = 60.0;
  std::string json;
  std::string html;
};

void describe(CLI::App& app, Arguments& a) {
  app.add_option("--rate", a.rates_hz, "Tick rates [Hz], one after the other")
      ->capture_default_str()
      ->check(host::between(1.0, 1e5));
  app.add_option("--seconds", a.seconds, "How long to run each rate [s]")
      ->capture_default_str()
      ->check(host::between(0.001, 1e6));
  app.add_option("--json", a.json,
                 "Write the report as JSON to FILE: an object for one rate, else a list of them")
      ->type_name("FILE");
  app.add_option("--html", a.html, "Write the report as a page with curves to FILE")
      ->type_name("FILE");
  app.footer(
      "A tick evaluates 32 pairs of boxes, and is woken and rehearsed as in teleop. A hiccup is\n"
      "more than 10 µs between two readings of the clock in another thread on another processor,\n"
      "of the ticks' scheduling class where that is granted. Ticks that met one are counted and\n"
      "stay in all figures. Ctrl-C ends the run early with what is measured.\n\n"
      "Exit status: 0 it ran, 1 bad file, 2 bad usage.");
}

void print_row(const host::Trial& t) {
  const DurationHistogram& compute = t.deadline.compute();
  const DurationHistogram& late = t.deadline.wakeup();
  std::printf(
      "%9g %9" PRId64 " %8" PRId64 " | %7.1f %7.1f %7.1f %8.1f | %7.1f %7.1f %8.1f %8.1f | ",
      t.options.rate_hz, t.deadline.ticks(), t.deadline.misses(), compute.percentile_us(0.5),
      compute.percentile_us(0.99), compute.percentile_us(0.999), compute.max_us(),
      late.percentile_us(0.5), late.percentile_us(0.99), late.percentile_us(0.999), late.max_us());
  if (t.hiccups) {
    std::printf("%8" PRId64 " %8" PRId64 "\n", t.hiccups->count(), t.hiccups->ticks());
  } else {
    std::printf("%8s %8s\n", "unknown", "unknown");
  }
}

void print_table(const std::vector<host::Trial>& trials) {
  std::printf("\n%28s | %32s | %33s | %8s %8s\n", "", "compute [us]", "wake-up lateness [us]", "",
              "ticks");
  std::printf("%9s %9s %8s | %7s %7s %7s %8s | %7s %7s %8s %8s | %8s %8s\n", "rate [Hz]", "ticks",
              "misses", "p50", "p99", "p99.9", "max", "p50", "p99", "p99.9", "max", "hiccups",
              "with one");
  for (const host::Trial& trial : trials) print_row(trial);
}

int run(const Arguments& arguments) {
  host::Output json(arguments.json);
  host::Output html(arguments.html);
  std::vector<host::Trial> trials;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const std::atomic<bool>& stop = host::interruption();
  for (const double rate_hz : arguments.rates_hz) {
    if (stop && !trials.empty()) break;
    const host::TrialOptions options{.rate_hz = rate_hz, .seconds = arguments.seconds};
    host::TrialDisplay display(options);
    trials.push_back(host::run_trial(options, stop, std::ref(display)));
    display.clear();
    host::print(trials.back(), stdout);
    std::fflush(stdout);
    list.push_back(host::to_json(trials.back()));
  }
  print_table(trials);
  std::putchar('\n');
  host::print_machine(host::describe_machine(host::granted(trials.front())), stdout);
  host::write(arguments.rates_hz.size() == 1 ? list.front() : list, json);
  if (html.wanted()) {
    write_page(trials, html.stream());
    html.close();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return host::start(argc, argv, "deadline", "How ticks meet their deadlines on this machine.", 1,
                     describe, run);
}
