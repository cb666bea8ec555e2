// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Determines whether this machine can hold a tick rate.

#include <repel/base/setup_error.hpp>
#include <repel/host/command_line.hpp>
#include <repel/host/times.hpp>
#include <repel/host/trial/advice.hpp>
#include <repel/host/trial/trial.hpp>

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
  app.add_option("--json", a.json, "Write the report as JSON to FILE")->type_name("FILE");
  app.footer(
      "A thread sleeps until each tick is due and evaluates 32 pairs of boxes. A tick succeeds\n"
      "if it ends within one period of its due time; the machine holds the rate if the success\n"
      "rate of the last 100 ticks is never below 0.95. Ctrl-C ends the trial early, with a\n"
      "verdict on the ticks so far.\n\n"
      "Exit status: 0 it holds the rate, 1 it does not, 2 bad usage or file, 3 no verdict (ended\n"
      "before the 100th tick).");
}

enum class Outcome { holds = 0, does_not_hold = 1, unknown = 3 };

Outcome judge(const host::Trial& trial) {
  if (trial.windows.count == 0) return Outcome::unknown;
  return trial.windows.unsound == 0 ? Outcome::holds : Outcome::does_not_hold;
}

std::string verdict(const host::Trial& trial) {
  const std::string rate = to_text(trial.options.rate_hz) + " Hz";
  const Outcome outcome = judge(trial);
  if (outcome == Outcome::unknown) return "NO VERDICT on " + rate + ": fewer than 100 ticks";
  char worst[16];
  std::snprintf(worst, sizeof worst, "%.2f", trial.windows.worst);
  const std::string misses = "; " + std::to_string(trial.deadline.misses()) + " of " +
                             std::to_string(trial.deadline.ticks()) + " ticks missed";
  if (outcome == Outcome::holds) {
    return "HOLDS " + rate + ": success rate over 100 ticks never below " + worst + misses;
  }
  return "DOES NOT HOLD " + rate + ": warning, success rate over 100 ticks fell to " + worst +
         ", below 0.95" + misses;
}

nlohmann::ordered_json report_of(const host::Trial& trial,
                                 const std::vector<host::Advice>& advice) {
  nlohmann::ordered_json report = host::to_json(trial);
  const Outcome outcome = judge(trial);
  report["holds"] = nullptr;
  if (outcome != Outcome::unknown) report["holds"] = outcome == Outcome::holds;
  report["verdict"] = verdict(trial);
  report["advice"] = nlohmann::ordered_json::array();
  for (const host::Advice& a : advice) {
    report["advice"].push_back({{"finding", a.finding}, {"command", a.command}});
  }
  return report;
}

int run(const Arguments& arguments) {
  if (arguments.trial.rate_hz * arguments.trial.seconds < host::Windows::length) {
    throw SetupError("fewer than 100 ticks in " + to_text(arguments.trial.seconds) + " s at " +
                     to_text(arguments.trial.rate_hz) +
                     " Hz show nothing; allowed: more --seconds or a higher --rate");
  }
  host::Output json(arguments.json);
  host::TrialDisplay display(arguments.trial);
  const host::Trial trial =
      host::run_trial(arguments.trial, host::interruption(), std::ref(display));
  display.clear();
  const std::vector<host::Advice> advice = host::advise(host::look_around(), trial);
  host::print(trial, stdout);
  host::print_machine(host::describe_machine(host::granted(trial)), stdout);
  if (!advice.empty()) std::puts("\nWhat would make it a better host:");
  for (const host::Advice& a : advice) {
    std::printf("  %s\n    %s\n", a.finding.c_str(), a.command.c_str());
  }
  std::printf("\n%s\n", verdict(trial).c_str());
  host::write(report_of(trial, advice), json);
  return static_cast<int>(judge(trial));
}

}  // namespace

int main(int argc, char** argv) {
  return host::start(argc, argv, "qualify", "Says whether this machine can hold a rate.", 2,
                     describe, run);
}
