/// @file
/// Runs a scene: an operator drives a simulated arm through a world of virtual walls.

#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "budget.hpp"
#include "command_line.hpp"
#include "log.hpp"
#include "report.hpp"
#include "run.hpp"

namespace {

namespace fs = std::filesystem;
using namespace repel;

struct Arguments {
  std::string scene = "anderson_4x8";
  double rate_hz = 0.0;  ///< 0: the scene's own
  int threads = -1;      ///< -1: the scene's own
  teleop::RunOptions run;
  std::string report;
  std::string log;
};

/// Folders in which a scene is looked for by name: beside the source this was built in, or where
/// it was installed.
std::vector<fs::path> scene_folders() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  return {program / "../../../scenes", program / "../share/repel/scenes"};
}

std::string scene_list() {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::path& folder : scene_folders()) {
    for (const auto& entry : fs::directory_iterator(folder, error)) {
      if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
    }
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  std::string text;
  for (const std::string& name : names) text += "\n  " + name;
  return text;
}

std::string find_scene(const std::string& name) {
  if (fs::exists(name)) return name;
  std::error_code error;
  for (const fs::path& folder : scene_folders()) {
    const fs::path path = folder / (name + ".yaml");
    if (fs::exists(path, error)) return fs::weakly_canonical(path).string();
  }
  throw SetupError("no such scene; allowed: a file or one of" + scene_list(),
                   name.empty() ? "''" : name);
}

void describe(CLI::App& app, Arguments& a) {
  app.add_option("scene", a.scene, "Scene file, or the name of one below")->capture_default_str();
  app.add_option("--seconds", a.run.seconds, "Scene time to run [s]")
      ->capture_default_str()
      ->check(host::between(0.0, 1e6));
  app.add_option("--rate", a.rate_hz, "Tick rate [Hz] (default: the scene's)")
      ->check(host::between(1.0, 1e5));
  app.add_flag(
      "--fast", a.run.fast,
      "As fast as it goes, not by the clock; bitwise repeatable. Wall-clock budgets of the "
      "scene do not apply, counted ones do");
  app.add_option(
         "--backend", a.run.backend,
         "Simulated arm: bullet or ode (dynamics, gravity, friction, stops), reference (the "
         "same without stops, by a higher order, slow) or ideal (free joints)")
      ->capture_default_str()
      ->check(CLI::IsMember({"bullet", "ode", "reference", "ideal"}));
  app.add_flag("--contact", a.run.contact,
               "Of bullet and ode: obstacles that are not passable stop the arm by themselves, "
               "too, where no virtual force does it first");
  app.final_callback([&a] {
    if (!a.run.contact || a.run.backend == "bullet" || a.run.backend == "ode") return;
    throw CLI::ValidationError(
        "--contact", "backend " + a.run.backend + " knows no contact; allowed: bullet, ode");
  });
  app.add_option("--threads", a.threads,
                 "Coprocessor threads; 0: in the tick's own thread (default: the scene's)")
      ->check(CLI::Range(0, 16));
  app.add_option("--budget", a.run.budget,
                 "In place of the scene's budget: support pairs per tick, none, or i860, the "
                 "processor of 1993, on which 4 by 8 parts just fit at 400 Hz")
      ->check(CLI::Validator(teleop::budget_complaint, "UNITS, i860 or none"));
  app.add_flag("--every-pair", a.run.every_pair,
               "Ask also the pairs that cannot be within range: to compare with");
  app.add_flag("--tool-alone", a.run.tool_alone,
               "Keep only the tools off the obstacles, not the links of the arms: the paper's way");
  app.add_option("--report", a.report, "Write the report as JSON to FILE");
  app.add_option("--log", a.log, "Write every tick as CSV to FILE");
  app.footer(
      "Scenes:" + scene_list() +
      "\n\nBack ends:\n  bullet, ode, reference, ideal\n\nDevices (chosen phase by phase in the "
      "scene):\n"
      "  spaceball   six rates, scripted\n  torque_arm  force-reflecting lever, scripted\n\n"
      "Exit status: 0 it ran, 1 bad scene or file, 2 bad usage.");
}

/// One line that is written over on a terminal, and a line every five seconds elsewhere.
void show(const scene::Scene& scene, const teleop::Progress& p, bool terminal) {
  static double next = 0.0;
  if (!terminal && p.time < next) return;
  next = p.time + 5.0;
  const auto phase = static_cast<std::size_t>(p.phase);
  const std::string name = phase < scene.script.size() ? scene.script[phase].name : "script over";
  std::fprintf(stderr, "%s%7.2f s  %-28.28s force %7.2f N  misses %lld  %-12s%s",
               terminal ? "\r" : "", p.time, name.c_str(), p.force,
               static_cast<long long>(p.misses), to_text(p.status).c_str(),
               terminal ? "\033[K" : "\n");
}

int run(const Arguments& arguments) {
  const scene::Scene scene = scene::load(find_scene(arguments.scene));
  teleop::RunOptions options = arguments.run;
  options.rate_hz = arguments.rate_hz > 0.0 ? arguments.rate_hz : scene.rate_hz;
  options.threads = arguments.threads >= 0 ? arguments.threads : scene.budget.threads;
  options.keep_records = !arguments.log.empty();
  host::Output report(arguments.report);
  host::Output log(arguments.log);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  const teleop::RunResult result =
      teleop::run(scene, options, host::interruption(),
                  [&](const teleop::Progress& p) { show(scene, p, terminal); });
  if (terminal) std::fputs("\r\033[K", stderr);
  teleop::print_report(result, stdout);
  if (report.wanted()) {
    teleop::write_json(result, report.stream());
    report.close();
  }
  if (log.wanted()) {
    teleop::write_csv(result, log.stream());
    log.close();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return host::start(argc, argv, "teleop",
                     "Drives a simulated arm through a world of virtual walls.", 1, describe, run);
}
