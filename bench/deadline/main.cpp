/// @file
/// How ticks meet their deadlines on this machine, at several rates, beside what the machine does
/// meanwhile to a thread that only reads the clock.

#include "command_line.hpp"
#include "trial.hpp"

namespace {

using namespace repel;

struct Arguments {
  std::vector<double> rates_hz = {400.0, 1000.0, 4000.0, 10000.0};
  double seconds = 60.0;
  std::string json;
};

void describe(CLI::App& app, Arguments& a) {
  app.add_option("--rate", a.rates_hz, "Tick rates [Hz], one after the other")
      ->capture_default_str()
      ->check(host::between(1.0, 1e5));
  app.add_option("--seconds", a.seconds, "How long to run each rate [s]")
      ->capture_default_str()
      ->check(host::between(0.001, 1e6));
  app.add_option("--json", a.json,
                 "Write the report as JSON to FILE: an object for one rate, else a list of them");
  app.footer(
      "A tick evaluates 32 pairs of boxes, and is woken and rehearsed as in teleop. A hiccup is\n"
      "more than 10 us between two readings of the clock in another thread, of ordinary priority;\n"
      "ticks that met one are counted and stay in all figures.\n\n"
      "Exit status: 0 it ran, 1 bad file, 2 bad usage.");
}

void print_table(const std::vector<host::Trial>& trials) {
  std::printf("\n%8s %9s %8s | %27s | %35s | %9s %9s\n", "", "", "", "compute [us]",
              "lateness [us]", "", "ticks with");
  std::printf("%8s %9s %8s | %6s %6s %6s %6s | %8s %8s %8s %8s | %9s %9s\n", "rate", "ticks",
              "misses", "p50", "p99", "p99.9", "max", "p50", "p99", "p99.9", "max", "hiccups",
              "a hiccup");
  for (const host::Trial& t : trials) {
    const DurationHistogram& compute = t.deadline.compute();
    const DurationHistogram& late = t.deadline.wakeup();
    std::printf("%8g %9lld %8lld | %6.1f %6.1f %6.1f %6.0f | %8.1f %8.1f %8.1f %8.0f | ",
                t.options.rate_hz, static_cast<long long>(t.deadline.ticks()),
                static_cast<long long>(t.deadline.misses()), compute.percentile_us(0.5),
                compute.percentile_us(0.99), compute.percentile_us(0.999), compute.max_us(),
                late.percentile_us(0.5), late.percentile_us(0.99), late.percentile_us(0.999),
                late.max_us());
    if (t.hiccups) {
      std::printf("%9lld %9lld\n", static_cast<long long>(t.hiccups->count),
                  static_cast<long long>(t.ticks_in_hiccup));
    } else {
      std::printf("%9s %9s\n", "unknown", "unknown");
    }
  }
}

int run(const Arguments& arguments) {
  host::Output json(arguments.json);
  std::vector<host::Trial> trials;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  const std::atomic<bool>& stop = host::interruption();
  for (const double rate_hz : arguments.rates_hz) {
    if (stop) break;
    const host::TrialOptions options{.rate_hz = rate_hz, .seconds = arguments.seconds};
    host::TrialDisplay display(options);
    trials.push_back(host::run_trial(options, stop, std::ref(display)));
    display.clear();
    host::print(trials.back(), stdout);
    list.push_back(host::to_json(trials.back()));
  }
  print_table(trials);
  if (json.wanted()) {
    json.stream() << (list.size() == 1 ? list.front() : list).dump(2) << '\n';
    json.close();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return host::start(argc, argv, "deadline", "How ticks meet their deadlines on this machine.", 1,
                     describe, run);
}
