/// @file
/// Says whether this machine can hold a rate.

#include <repel/base/setup_error.hpp>

#include "advice.hpp"
#include "command_line.hpp"
#include "trial.hpp"

namespace {

using namespace repel;

struct Arguments {
  host::TrialOptions trial{.rehearse = false};
  std::string json;
};

void describe(CLI::App& app, Arguments& a) {
  app.add_option("--rate", a.trial.rate_hz, "Tick rate [Hz]")
      ->capture_default_str()
      ->check(host::between(1.0, 1e5));
  app.add_option("--seconds", a.trial.seconds, "How long to try [s]; at least 100 ticks")
      ->capture_default_str()
      ->check(host::between(0.0, 1e6));
  app.add_option("--json", a.json, "Write the report as JSON to FILE");
  app.footer(
      "A thread sleeps until each tick is due and evaluates 32 pairs of boxes. A tick succeeds\n"
      "when it has finished one period after it was due; the machine holds the rate when no\n"
      "window of 100 ticks has a success rate below 0.95.\n\n"
      "Exit status: 0 it holds the rate, 1 it does not, 2 bad usage or file.");
}

bool holds(const host::Trial& trial) {
  return trial.windows.count > 0 && trial.windows.unsound == 0;
}

std::string verdict(const host::Trial& trial) {
  const std::string rate = to_text(trial.options.rate_hz) + " Hz";
  if (trial.windows.count == 0) return "NO VERDICT on " + rate + ": fewer than 100 ticks";
  const std::string count = std::to_string(trial.windows.count) + " windows of 100 ticks";
  if (!holds(trial)) {
    return "DOES NOT HOLD " + rate + ": warning, success rate below 0.95 in " +
           std::to_string(trial.windows.unsound) + " of " + count;
  }
  return "HOLDS " + rate + ": success rate of 0.95 or more in all " + count + ", " +
         std::to_string(trial.deadline.misses()) + " misses";
}

void write_json(const host::Trial& trial, const std::vector<host::Advice>& advice,
                std::ostream& file) {
  nlohmann::ordered_json report = host::to_json(trial);
  report["holds"] = holds(trial);
  report["verdict"] = verdict(trial);
  report["advice"] = nlohmann::ordered_json::array();
  for (const host::Advice& a : advice) {
    report["advice"].push_back({{"finding", a.finding}, {"command", a.command}});
  }
  file << report.dump(2) << '\n';
}

int run(const Arguments& arguments) {
  if (arguments.trial.rate_hz * arguments.trial.seconds < host::Windows::length) {
    throw SetupError("fewer than 100 ticks show nothing; allowed: more --seconds or --rate",
                     to_text(arguments.trial.seconds) + " s");
  }
  host::Output json(arguments.json);
  host::TrialDisplay display(arguments.trial);
  const host::Trial trial =
      host::run_trial(arguments.trial, host::interruption(), std::ref(display));
  display.clear();
  const std::vector<host::Advice> advice = host::advise(host::look_around(), trial);
  host::print(trial, stdout);
  if (!advice.empty()) std::puts("\nWhat would make it a better host:");
  for (const host::Advice& a : advice) {
    std::printf("  %s\n    %s\n", a.finding.c_str(), a.command.c_str());
  }
  std::printf("\n%s\n", verdict(trial).c_str());
  if (json.wanted()) {
    write_json(trial, advice, json.stream());
    json.close();
  }
  return holds(trial) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return host::start(argc, argv, "qualify", "Says whether this machine can hold a rate.", 2,
                     describe, run);
}
