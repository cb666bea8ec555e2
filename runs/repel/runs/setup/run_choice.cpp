// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/setup/run_choice.hpp>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <repel/common/complaint.hpp>
#include <repel/host/command_line.hpp>
#include <repel/runs/arms/arm_backend.hpp>
#include <repel/runs/faults/choice.hpp>
#include <repel/runs/options/budget.hpp>
#include <repel/runs/setup/prepared_run.hpp>
#include <repel/simulated/changed_arm.hpp>

namespace repel::runs {
namespace {

/// The names of the simulated arms that satisfy `wanted`.
template <class Wanted>
std::vector<std::string> backend_names(const Wanted& wanted) {
  std::vector<std::string> names;
  for (const ArmBackend& backend : arm_backends()) {
    if (wanted(backend)) names.emplace_back(backend.name);
  }
  return names;
}

bool has_contact(const ArmBackend& backend) {
  return backend.has_contact;
}
bool has_gravity(const ArmBackend& backend) {
  return backend.has_gravity;
}

/// The names of these arms, as a sentence has them: "a, b or c".
template <class Wanted>
std::string backends_in_words(const Wanted& wanted) {
  std::string words = CLI::detail::join(backend_names(wanted), ", ");
  const std::size_t last = words.rfind(", ");
  return last == std::string::npos ? words : words.replace(last, 2, " or ");
}

/// How long and how fast.
void describe_pace(CLI::App& app, Choosing what, RunChoice& c) {
  app.option_defaults()->group("Run");
  app.add_option("--rate", c.rate_hz, "Tick rate [Hz] (default: the scene's)")
      ->check(host::between(1.0, 1e5));
  if (what == Choosing::check) return;
  app.add_option(
         "--seconds", c.run.seconds,
         "Scene time to run [s]; if not given, --view, --device and a site run until stopped")
      ->capture_default_str()
      ->each([&c](const std::string&) { c.has_seconds = true; })
      ->check(host::between(0.0, 1e6));
  if (what != Choosing::run) return;
  app.add_flag(
      "--fast", c.run.fast,
      "As fast as it goes, not by the clock; bitwise repeatable. Wall-clock budgets of the "
      "scene do not apply, counted ones do");
  app.add_option("--hand", c.hands,
                 "The operator's hand, in place of the script: a table of its rates by time "
                 "(docs/recording.md). Once more for each further arm")
      ->type_name("FILE.csv")
      ->allow_extra_args(false);
}

/// What is otherwise than in the scene file.
void describe_changes(CLI::App& app, RunChoice& c) {
  app.add_option(
         "--set",
         [&c](const std::vector<std::string>& words) {
           for (const std::string& word : words) {
             const std::size_t equals = word.find('=');
             if (equals == std::string::npos || equals == 0) {
               throw CLI::ValidationError("--set", "'" + word + "'; allowed: PATH=VALUE");
             }
             c.changes.push_back({word.substr(0, equals), word.substr(equals + 1)});
           }
           return true;
         },
         "PATH=VALUE, another value than that of the scene file, as laws.wall.damping='80 N s/m'; "
         "may be repeated (scenes/README.md)")
      ->type_name("CHANGE")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->allow_extra_args(false);
}

/// How the pairs are computed.
void describe_coprocessor(CLI::App& app, RunChoice& c) {
  app.add_option("--threads", c.threads,
                 "Coprocessor threads; 0: in the tick's own thread (default: the scene's)")
      ->check(CLI::Range(0, 16));
  app.add_option("--coprocessor", c.coprocessor,
                 "Work of its threads, at least one: together, they share the pairs of a tick with "
                 "its own thread; beside, they answer the last tick during this one, as in the "
                 "paper (default: the scene's)")
      ->check(CLI::IsMember({"together", "beside"}));
  app.add_option("--budget", c.run.budget,
                 "In place of the scene's budget: support pairs per tick, none, or i860 (the "
                 "processor of 1993, for 4 by 8 parts at 400 Hz)")
      ->check(CLI::Validator(budget_complaint, "UNITS, i860 or none"));
  app.add_flag("--every-pair", c.run.every_pair,
               "Evaluate pairs out of range, too, for comparison");
}

/// The simulated arm.
void describe_arm(CLI::App& app, RunChoice& c) {
  app.option_defaults()->group("Arm");
  app.add_option("--backend", c.run.backend,
                 "Simulated arm: " + backends_in_words(has_contact) +
                     " (dynamics, gravity, friction, stops), reference (the same without stops, by "
                     "a higher order, slow) or ideal (free joints)")
      ->capture_default_str()
      ->check(CLI::IsMember(backend_names([](const auto&) { return true; })));
  app.add_flag("--contact", c.run.contact,
               "With " + backends_in_words(has_contact) +
                   ": impassable obstacles are also solid in the simulation, beside their virtual "
                   "force");
  app.add_option("--plant-inertia", c.run.plant_inertia,
                 "With " + backends_in_words(has_gravity) +
                     ": inertia of the simulated arm relative to its model, at the same weight; "
                     "tests the controller against errors of the model")
      ->capture_default_str()
      ->type_name("FACTOR")
      ->check(host::between(least_inertia_factor, most_inertia_factor));
  app.add_flag("!--no-prediction", c.run.prediction,
               "Solve the network for the measured rates, without the mass of the arm, for "
               "comparison; arms with light wrists become unstable");
}

/// The faults that are injected.
void describe_faults(CLI::App& app, RunChoice& c) {
  const auto complaint = [](const std::string& text) {
    return complaint_of([&] { (void)faults::choice_in(text); });
  };
  app.option_defaults()->group("Arm");
  app.add_option_function<std::vector<std::string>>(
         "--fault",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& each : all) c.run.faults.push_back(faults::choice_in(each));
         },
         "Fault between the first arm and its controller, from a scene time [s] on, as 'frame "
         "frozen@2.5'; may be repeated. Their names: teleop list --faults")
      ->allow_extra_args(false)
      ->type_name("NAME@SECONDS")
      ->check(CLI::Validator(complaint, ""));
}

void describe_walls(CLI::App& app, RunChoice& c) {
  app.option_defaults()->group("Walls");
  app.add_option(
         "--walls", c.run.hold,
         "hard: no push enters a wall; soft: walls are springs (default: by the laws of the scene)")
      ->check(CLI::IsMember({"hard", "soft"}));
  app.add_flag("--tool-alone", c.run.tool_alone,
               "Keep only the tools off the obstacles, not the links of the arms, as in the paper");
  std::vector<std::string> names;
  names.reserve(std::size(all_measures));
  for (const Measure measure : all_measures) names.emplace_back(to_text(measure));
  app.add_option("--measure", c.run.measure,
                 "Measure of the depth of an overlap: the deepest common point, the reduction of "
                 "the paper, or exact (default: the scene's)")
      ->check(CLI::IsMember(names));
  app.add_option("--levels", c.run.levels,
                 "Steps of the reduction of shapes, if the measure needs it (default: the scene's)")
      ->check(CLI::Range(1, ReductionOptions::most_levels));
}

/// The options alone, as an application.
struct Words {
  Words() : app("", "teleop run") { describe(app, Choosing::run, choice); }
  RunChoice choice;
  CLI::App app;
};

}  // namespace

void describe(CLI::App& app, Choosing what, RunChoice& choice) {
  describe_pace(app, what, choice);
  describe_changes(app, choice);
  if (what == Choosing::station) return;
  if (what != Choosing::check) describe_coprocessor(app, choice);
  describe_arm(app, choice);
  if (what == Choosing::run) describe_faults(app, choice);
  describe_walls(app, choice);
}

void require_able(const RunChoice& choice) {
  const ArmBackend& chosen = arm_backend(choice.run.backend);
  const auto require = [&](const char* option, const char* trouble, auto&& able) {
    if (able(chosen)) return;
    throw CLI::ValidationError(option,
                               "backend " + choice.run.backend + " " + trouble +
                                   "; allowed: " + CLI::detail::join(backend_names(able), ", "));
  };
  if (choice.run.contact) require("--contact", "knows no contact", has_contact);
  if (choice.run.plant_inertia != 1.0) {
    require("--plant-inertia", "has links without mass", has_gravity);
  }
}

scene::Scene scene_of(const RunChoice& choice, const std::string& path) {
  return scene::load(path, {}, choice.changes);
}

RunOptions options_of(const RunChoice& choice, const scene::Scene& scene) {
  RunOptions options = choice.run;
  const RunOptions asked = options_of(scene);
  options.rate_hz = choice.rate_hz > 0.0 ? choice.rate_hz : asked.rate_hz;
  const auto mode = coprocessor_mode_named(choice.coprocessor);
  options.coprocessor = mode.value_or(asked.coprocessor);
  const int threads = std::max(asked.threads, mode ? 1 : 0);
  options.threads = choice.threads >= 0 ? choice.threads : threads;
  return options;
}

RunChoice choice_of(std::vector<std::string> words) {
  Words all;
  std::reverse(words.begin(), words.end());  // as CLI11 wants them
  try {
    all.app.parse(std::move(words));
    host::refuse_empty(all.app);
    require_able(all.choice);
  } catch (const CLI::ParseError& error) {
    throw SetupError(error.what());
  }
  return std::move(all.choice);
}

std::vector<std::string> names_of_choice() {
  std::vector<std::string> names;
  Words all;
  for (const CLI::Option* option : all.app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

}  // namespace repel::runs
