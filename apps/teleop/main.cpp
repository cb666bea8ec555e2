// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Runs a scene: an operator drives a simulated arm among virtual walls.

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <optional>
#include <random>
#include <sstream>

#include <repel/host/command_line.hpp>
#include <repel/host/figure.hpp>
#include <repel/runs/arms/arm_backend.hpp>
#include <repel/runs/engine/session.hpp>
#include <repel/runs/operator/device.hpp>
#include <repel/runs/options/budget.hpp>
#include <repel/runs/options/link_choice.hpp>
#include <repel/runs/options/listening.hpp>
#include <repel/runs/options/run_options.hpp>
#include <repel/runs/options/session_options.hpp>
#include <repel/runs/records/recording.hpp>
#include <repel/runs/report/html_report.hpp>
#include <repel/runs/report/report.hpp>
#include <repel/runs/report/results.hpp>
#include <repel/runs/setup/prepared_run.hpp>
#include <repel/runs/station/station.hpp>
#include <repel/runs/wire/station_program.hpp>
#include <repel/simulated/changed_arm.hpp>

namespace {

namespace fs = std::filesystem;
using namespace repel;

constexpr double until_stopped = 1e6;  ///< [s]

struct Arguments {
  std::string scene = "anderson_4x8";
  bool has_seconds = false;   ///< --seconds was given
  std::optional<bool> apart;  ///< as two programs; none: as the scene says
  double rate_hz = 0.0;       ///< 0: the scene's own
  int threads = -1;           ///< -1: the scene's own
  std::string coprocessor;    ///< empty: the scene's own
  runs::RunOptions run;
  runs::SessionOptions session;
  std::string replay;
  std::string report;
  std::string html;
  std::string log;
  bool is_quiet = false;
};

/// Folders in the source tree this was built in, and in the installation.
std::vector<fs::path> folders_of(const char* in_source, const char* installed) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  return {program / "../../.." / in_source, program / "../share/repel" / installed};
}

/// Where scenes are searched by name.
std::vector<fs::path> scene_folders() {
  return folders_of("scenes", "scenes");
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

/// Options on access to the live view.
void describe_pages(CLI::App& app, Arguments& a, CLI::Option* view) {
  CLI::Option* file =
      app.add_option("--secret", a.session.secret_file,
                     "What a page must present, #secret=... behind its address: the first line of "
                     "FILE, 16 characters or more. Wanted where other machines reach the view")
          ->needs(view)
          ->type_name("FILE");
  app.add_option("--secret-env", a.session.secret_env,
                 "The same from the environment variable NAME")
      ->needs(view)
      ->excludes(file)
      ->type_name("NAME");
  CLI::Option* only = app.add_flag("--view-only", a.session.view_only,
                                   "Pages look on: they do not drive, pause, step or restart")
                          ->needs(view);
  app.add_flag("--page-drives", a.session.page_drives,
               "With --device, while which pages look on: they may take the controls from it")
      ->needs(view)
      ->excludes(only);
}

/// The options of a scene that is divided between two programs.
void describe_sides(CLI::App& app, Arguments& a) {
  CLI::Option* station =
      app.add_flag_callback(
             "--station", [&a] { a.session.link.side = link::Side::station; },
             "Only the operator's side of the network, up to its line; the robot is at a site. "
             "With --view, what the site tells is shown")
          ->excludes("--fast", "--log", "--html", "--backend", "--contact", "--plant-inertia",
                     "--no-prediction", "--threads", "--coprocessor", "--budget", "--measure",
                     "--levels", "--every-pair", "--tool-alone", "--hold");
  app.add_flag_callback(
         "--site", [&a] { a.session.link.side = link::Side::site; },
         "Only the robot's side; the operator is at a station, with the same "
         "scene file. Until it is stopped, unless --seconds is given")
      ->excludes("--fast", "--device")
      ->excludes(station);
  CLI::Option* apart =
      app.add_flag_callback(
             "--apart", [&a] { a.apart = true; },
             "Run both sides as two programs that are joined by the link, on which packets are "
             "delayed and lost as by the line of the scene (default: if the scene says so, and it "
             "is neither --fast nor recorded)")
          ->excludes(station, "--site", "--fast");
  app.add_flag_callback(
         "--together", [&a] { a.apart = false; }, "Run one program in any case")
      ->excludes(station, "--site", apart);
  app.add_flag("--impaired", a.session.link.is_impaired,
               "With --site or --station: delay and lose what is sent as the line of the scene "
               "does, to try a far link nearby")
      ->excludes(apart);
  app.add_option("--domain", a.session.link.domain,
                 "DDS domain of the link, the same on both sides (default: 0; with --apart a "
                 "random one)")
      ->check(CLI::Range(0, 230));
  app.add_option("--link", a.session.link.where,
                 "What joins them: dds, dds:INTERFACE or dds:INTERFACE,PEER (Cyclone DDS), udp or "
                 "udp:ADDRESS:PORT (where the site listens). Without more it is on this machine. "
                 "Who reaches it can drive the robot: docs/two_machines.md")
      ->default_str(runs::default_link())
      ->type_name("LINK")
      ->check(CLI::Validator(runs::link_complaint, "LINK"));
}

/// Text below the options of --help.
std::string footer() {
  return "Scenes:" + scene_list() +
         "\n\nBack ends:\n  bullet, ode, reference, ideal\n\nDevices (chosen phase by phase in the "
         "scene):\n"
         "  spaceball   six rates, scripted\n  torque_arm  force-reflecting lever, scripted\n"
         "  six_axes    six rates of a hand, with force feedback, scripted\n"
         "or, in place of the script, the page of --view and what --device names\n\n"
         "What is written stands beside its place as FILE.part until it is whole. Ctrl-C, SIGTERM "
         "and\n"
         "SIGHUP fade the forces, then the run ends with its report; a second Ctrl-C ends it at "
         "once.\n\n"
         "Exit status: 0 it ran, 1 bad scene or file, 2 bad usage, 3 a replay came out otherwise,\n"
         "4 it ran, but a file or the output could not be written whole, 5 it ran, but an arm "
         "gained\n"
         "energy from its own control, or had a fault in more than a tenth of its ticks.";
}

/// The names of the simulated arms that satisfy `wanted`.
template <class Wanted>
std::vector<std::string> backend_names(const Wanted& wanted) {
  std::vector<std::string> names;
  for (const runs::ArmBackend& backend : runs::arm_backends()) {
    if (wanted(backend)) names.emplace_back(backend.name);
  }
  return names;
}

/// @throws CLI::ValidationError if an option asks the back end for what it does not simulate
void require_able(const Arguments& a) {
  const runs::ArmBackend& chosen = runs::arm_backend(a.run.backend);
  const auto require = [&](const char* option, const char* trouble, auto&& able) {
    if (able(chosen)) return;
    throw CLI::ValidationError(option, "backend " + a.run.backend + " " + trouble + "; allowed: " +
                                           CLI::detail::join(backend_names(able), ", "));
  };
  if (a.run.contact) {
    require("--contact", "knows no contact",
            [](const auto& backend) { return backend.has_contact; });
  }
  if (a.run.plant_inertia != 1.0) {
    require("--plant-inertia", "has links without mass",
            [](const auto& backend) { return backend.has_gravity; });
  }
}

/// The options of the simulated arm.
void describe_arm(CLI::App& app, Arguments& a) {
  app.add_option(
         "--backend", a.run.backend,
         "Simulated arm: bullet or ode (dynamics, gravity, friction, stops), reference (the "
         "same without stops, by a higher order, slow) or ideal (free joints)")
      ->capture_default_str()
      ->check(CLI::IsMember(backend_names([](const auto&) { return true; })));
  app.add_flag("--contact", a.run.contact,
               "Of bullet and ode: obstacles that are not passable stop the arm by themselves, "
               "too, where no virtual force does it first");
  app.add_option("--plant-inertia", a.run.plant_inertia,
                 "Of bullet, ode and reference: how many times the inertia of its model a "
                 "simulated arm has, at the same weight; to test the controller, which knows the "
                 "model")
      ->capture_default_str()
      ->type_name("FACTOR")
      ->check(host::between(least_inertia_factor, most_inertia_factor));
  app.add_flag("!--no-prediction", a.run.prediction,
               "Solve the network for the measured rates, without the mass of the arm: to compare "
               "with; arms with light wrists then explode");
}

/// The options of overlaps.
void describe_measure(CLI::App& app, Arguments& a) {
  std::vector<std::string> names;
  names.reserve(std::size(all_measures));
  for (const Measure measure : all_measures) names.emplace_back(to_text(measure));
  app.add_option("--measure", a.run.measure,
                 "How the depth of an overlap is measured: by the deepest common point, by the "
                 "reduction, which is the paper's way, or exactly (default: the scene's)")
      ->check(CLI::IsMember(names));
  app.add_option("--levels", a.run.levels,
                 "Steps in which shapes are reduced, where the measure needs them (default: the "
                 "scene's)")
      ->check(CLI::Range(1, ReductionOptions::most_levels));
}

/// The files that a run writes.
void describe_files(CLI::App& app, Arguments& a) {
  app.add_option("--report", a.report,
                 "Write the report as JSON to FILE; -: print it, in place of the text")
      ->transform(CLI::Validator(
          [&a](std::string& file) {
            if (file == "-") {
              file = "/dev/stdout";
              a.is_quiet = true;
            }
            return std::string();
          },
          ""));
  app.add_option("--html", a.html, "Write the report as a page with curves to FILE");
  app.add_option("--log", a.log,
                 "Write every tick to FILE: a recording if its name ends in .mcap, else CSV");
}

void describe(CLI::App& app, Arguments& a) {
  app.add_option("scene", a.scene, "Scene file, or the name of one below")->capture_default_str();
  app.add_option("--seconds", a.run.seconds,
                 "Scene time to run [s]; with --view until it is stopped, unless it is given")
      ->capture_default_str()
      ->each([&a](const std::string&) { a.has_seconds = true; })
      ->check(host::between(0.0, 1e6));
  app.add_option("--rate", a.rate_hz, "Tick rate [Hz] (default: the scene's)")
      ->check(host::between(1.0, 1e5));
  app.add_flag("--quiet", a.is_quiet, "No progress and no report on the terminal");
  app.add_flag(
      "--fast", a.run.fast,
      "As fast as it goes, not by the clock; bitwise repeatable. Wall-clock budgets of the "
      "scene do not apply, counted ones do");
  describe_arm(app, a);
  app.final_callback([&a, &app] {
    for (const char* option : {"--link", "--domain", "--impaired"}) {
      if (app.count(option) == 0 || a.session.link.side || a.apart.value_or(false)) continue;
      throw CLI::RequiresError(option, "--site or --station");
    }
    const std::string insecure = runs::settle_secret(a.session);
    if (!insecure.empty()) throw CLI::ValidationError(insecure);
    require_able(a);
  });
  app.add_option("--threads", a.threads,
                 "Coprocessor threads; 0: in the tick's own thread (default: the scene's)")
      ->check(CLI::Range(0, 16));
  app.add_option("--coprocessor", a.coprocessor,
                 "What its threads do, at least one then: together, share the pairs of a tick with "
                 "the tick's own thread, or beside, answer the last tick while this one goes on: "
                 "the paper's way (default: the scene's)")
      ->check(CLI::IsMember({"together", "beside"}));
  app.add_option("--budget", a.run.budget,
                 "In place of the scene's budget: support pairs per tick, none, or i860, the "
                 "processor of 1993, on which 4 by 8 parts all but fit at 400 Hz")
      ->check(CLI::Validator(runs::budget_complaint, "UNITS, i860 or none"));
  describe_measure(app, a);
  app.add_flag("--every-pair", a.run.every_pair,
               "Ask also the pairs that cannot be within range: to compare with");
  app.add_flag("--tool-alone", a.run.tool_alone,
               "Keep only the tools off the obstacles, not the links of the arms: the paper's way");
  app.add_option("--hold", a.run.hold,
                 "hard: no wall may be entered, whoever pushes; soft: walls are springs (default: "
                 "as the laws of the scene say)")
      ->check(CLI::IsMember({"hard", "soft"}));
  describe_files(app, a);
  CLI::Option* view = app.add_flag("--view", a.session.view,
                                   "Serve the live view: a page to look on and to drive from");
  app.add_option("--listen", a.session.listen, "ADDRESS:PORT of the live view; port 0: any")
      ->capture_default_str()
      ->needs(view)
      ->check(CLI::Validator(runs::listen_complaint, "ADDRESS:PORT"));
  describe_pages(app, a, view);
  app.add_option("--device", a.session.device,
                 "In place of the script: the master that drives, spacenav (a six-axis mouse, "
                 "through spacenavd), evdev:PATH (a motorised lever) or haply[:URL] (an Inverse3, "
                 "through its service). Until it is stopped, unless --seconds is given")
      ->check(CLI::Validator(runs::device_complaint, "spacenav, evdev:PATH or haply[:URL]"));
  app.get_option("--page-drives")->needs("--device");
  describe_sides(app, a);
  app.add_option("--replay", a.replay,
                 "In place of a scene: go through the recording FILE again and compare the forces")
      ->excludes("scene", "--seconds", "--rate", "--fast", "--backend", "--contact", "--threads",
                 "--coprocessor", "--budget", "--measure", "--levels", "--every-pair",
                 "--tool-alone", "--hold", "--plant-inertia", "--no-prediction", "--device",
                 "--site", "--station", "--apart");
  app.footer(footer());
}

/// The scene or recording to run, and how to run it.
struct Work {
  scene::Scene scene;
  runs::RunOptions options;
  std::optional<runs::Recording> recording;
};

Work work_of(const Arguments& arguments) {
  Work work;
  if (!arguments.replay.empty()) {
    work.recording = runs::load_recording(arguments.replay, find_scene);
    work.scene = work.recording->scene;
    work.options = work.recording->options;
  } else {
    work.scene = scene::load(find_scene(arguments.scene));
    work.options = arguments.run;
    const runs::RunOptions asked = runs::options_of(work.scene);
    work.options.rate_hz = arguments.rate_hz > 0.0 ? arguments.rate_hz : asked.rate_hz;
    const auto mode = coprocessor_mode_named(arguments.coprocessor);
    work.options.coprocessor = mode.value_or(asked.coprocessor);
    const int threads = std::max(asked.threads, mode ? 1 : 0);
    work.options.threads = arguments.threads >= 0 ? arguments.threads : threads;
    const bool is_driven = arguments.session.view || !arguments.session.device.empty() ||
                           arguments.session.link.side == link::Side::site;
    if (is_driven && !arguments.has_seconds) work.options.seconds = until_stopped;
  }
  work.options.keep_records = !arguments.html.empty();
  work.options.log = arguments.log;
  return work;
}

/// One line of progress, overwritten in place on a terminal; elsewhere a line every five seconds.
class StatusLine {
 public:
  StatusLine(const Arguments& arguments, const Work& work)
      : work_(work), is_quiet_(arguments.is_quiet) {
    if (arguments.session.view || !arguments.session.device.empty()) after_ = "by hand, or at rest";
  }

  void show(const runs::Progress& p) {
    if (is_quiet_ || (!is_terminal_ && p.time < next_)) return;
    next_ = p.time + 5.0;
    const network::Script& script = work_.scene.script;
    const auto phase = static_cast<std::size_t>(p.phase);
    const std::string name = phase < script.size() ? script[phase].name : after_;
    std::string misses;
    if (!work_.options.fast) misses.append("misses ").append(std::to_string(p.misses)).append("  ");
    std::fprintf(stderr, "%s%s%7.2f s  %-28.28s force %7s N  %s%-12s%s", is_terminal_ ? "\r" : "",
                 share(p.time).c_str(), p.time, name.c_str(), host::figure(p.force, 2).c_str(),
                 misses.c_str(), to_text(p.status).c_str(), is_terminal_ ? "\033[K" : "\n");
  }
  void clear() const {
    if (is_terminal_ && !is_quiet_) std::fputs("\r\033[K", stderr);
  }

 private:
  /// How much of the run is done; empty for one that lasts until it is stopped.
  [[nodiscard]] std::string share(double time) const {
    if (work_.options.seconds >= until_stopped) return {};
    const double percent = std::min(100.0, 100.0 * time / std::max(1e-3, work_.options.seconds));
    return host::figure(percent, 0) + " % ";
  }

  const Work& work_;
  bool is_quiet_;
  const char* after_ = "script over";  ///< while no phase of the script is played
  bool is_terminal_ = isatty(STDERR_FILENO) != 0;
  double next_ = 0.0;  ///< [s]
};

/// @throws SetupError if a file to write is also read, or written twice
void require_files_apart(const Arguments& arguments, const Work& work) {
  std::vector<host::NamedFile> read{{"the scene file", work.scene.file},
                                    {"the recording", arguments.replay}};
  const auto add = [&read](const scene::RobotChoice& robot) {
    read.push_back({"the robot", robot.urdf});
    read.push_back({"the robot's srdf file", robot.srdf});
  };
  add(work.scene.robot);
  for (const scene::OtherArm& partner : work.scene.partners) add(partner.robot);
  for (const scene::StaticModel& model : work.scene.models) read.push_back({"a model", model.file});
  host::require_apart(
      read, {{"--log", arguments.log}, {"--report", arguments.report}, {"--html", arguments.html}});
}

/// Writes a report file after the run. On failure prints it on stderr and returns false.
template <class Result, class Write>
bool wrote(host::Output& file, const Result& result, Write&& write) {
  if (!file.wanted()) return true;
  try {
    std::ostringstream text;
    write(result, text);
    file.stream() << text.str();
    file.close();
    return true;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "teleop: %s\n", error.what());
    return false;
  }
}

/// The operator's side alone.
int run_station(const Arguments& arguments, const Work& work) {
  host::Output report(arguments.report);
  runs::SessionOptions session = arguments.session;
  StatusLine status(arguments, work);
  const runs::StationResult result =
      runs::run_station(work.scene, work.options, session, host::interruption(),
                        [&](const runs::Progress& p) { status.show(p); });
  status.clear();
  if (!arguments.is_quiet) runs::print_station(result, stdout);
  const bool is_printed = host::has_printed();
  if (!is_printed) std::fputs("teleop: the report could not be printed whole\n", stderr);
  return wrote(report, result, runs::write_station_json) && is_printed ? 0 : 4;
}

/// Whether to run the scene as two programs.
bool is_apart(const Arguments& arguments, const Work& work) {
  if (arguments.session.link.side || work.recording || work.options.fast) return false;
  return arguments.apart.value_or(work.scene.apart && !work.options.log.ends_with(".mcap"));
}

/// Starts the operator's side as a program of its own, for this one to be the site.
std::unique_ptr<runs::StationProgram> station_beside(const Work& work,
                                                     runs::SessionOptions& session) {
  if (!runs::has_line(work.scene)) {
    throw SetupError("two programs need a module 'line' in the network, to part it there",
                     work.scene.file);
  }
  session.link.is_impaired = true;
  if (session.link.domain == 0) session.link.domain = 1 + std::random_device()() % 100;
  if (session.link.where.empty()) session.link.where = runs::default_link();
  std::vector<std::string> words{work.scene.file,
                                 "--station",
                                 "--impaired",
                                 "--link",
                                 session.link.where,
                                 "--domain",
                                 std::to_string(session.link.domain),
                                 "--rate",
                                 std::to_string(work.options.rate_hz),
                                 "--seconds",
                                 "1e6"};
  if (!session.device.empty()) {
    words.insert(words.end(), {"--device", session.device});
    session.device.clear();
  }
  session.link.side = link::Side::site;
  return std::make_unique<runs::StationProgram>(std::move(words));
}

int run(const Arguments& arguments) {
  const Work work = work_of(arguments);
  require_files_apart(arguments, work);
  if (arguments.session.link.side == link::Side::station) return run_station(arguments, work);
  const runs::Recording* recording = work.recording ? &*work.recording : nullptr;
  runs::SessionOptions session = arguments.session;
  host::Output report(arguments.report);
  host::Output html(arguments.html);
  StatusLine status(arguments, work);
  std::unique_ptr<runs::StationProgram> station;
  if (is_apart(arguments, work)) station = station_beside(work, session);
  runs::RunResult result =
      runs::run_session(work.scene, work.options, session, recording, host::interruption(),
                        host::insistence(), [&](const runs::Progress& p) {
                          // The robot would only hold. What went wrong with the other program is
                          // printed at the end.
                          if (station && station->has_ended()) (void)std::raise(SIGTERM);
                          status.show(p);
                        });
  if (station) result.station = station->stop();
  status.clear();
  if (!arguments.is_quiet) {
    runs::print_report(result, stdout);
    if (result.station) std::fputs(result.station->printed.c_str(), stdout);
    if (recording != nullptr) runs::print_replay(*recording, result, stdout);
  }
  if (result.station && result.station->status != 0) {
    std::fputs(result.station->complaints.c_str(), stderr);
  }
  bool is_whole = result.log_trouble.empty();
  if (!host::has_printed()) {
    std::fputs("teleop: the report could not be printed whole\n", stderr);
    is_whole = false;
  }
  is_whole = wrote(report, result, runs::write_json) && is_whole;
  is_whole = wrote(html, result, runs::write_html) && is_whole;
  if (result.station && result.station->status != 0) return 1;
  const runs::ReplayReport& replay = result.replay;
  if (replay.same != replay.ticks) return 3;
  if (!is_whole) return 4;
  return runs::gained_energy(result) || runs::was_often_at_fault(result) ? 5 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  return host::start(argc, argv, "teleop",
                     "Drives a simulated arm through a world of virtual walls.", 1, describe, run);
}
