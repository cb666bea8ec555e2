// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Runs a scene: an operator drives a simulated arm among virtual walls.

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <optional>
#include <random>
#include <sstream>

#include <repel/host/command_line.hpp>
#include <repel/host/figure.hpp>
#include <repel/runs/engine/session.hpp>
#include <repel/runs/faults/choice.hpp>
#include <repel/runs/faults/exchange.hpp>
#include <repel/runs/options/link_choice.hpp>
#include <repel/runs/options/run_options.hpp>
#include <repel/runs/options/session_options.hpp>
#include <repel/runs/records/recording.hpp>
#include <repel/runs/report/html_report.hpp>
#include <repel/runs/report/report.hpp>
#include <repel/runs/report/results.hpp>
#include <repel/runs/setup/prepared_run.hpp>
#include <repel/runs/station/station.hpp>
#include <repel/runs/wire/station_program.hpp>

#include "options.hpp"
#include "scenes.hpp"

namespace repel::teleop {
namespace {

constexpr double until_stopped = 1e6;  ///< [s]

/// The scene or recording to run, and how to run it.
struct Work {
  scene::Scene scene;
  runs::RunOptions options;
  std::optional<runs::Recording> recording;
};

Work work_of(const Arguments& arguments) {
  Work work;
  if (!arguments.recording.empty()) {
    work.recording = runs::load_recording(arguments.recording, find_scene);
    work.scene = work.recording->scene;
    work.options = work.recording->options;
  } else {
    work.scene = runs::scene_of(arguments.choice, find_scene(arguments.scene));
    work.options = runs::options_of(arguments.choice, work.scene);
    const bool is_driven = arguments.session.view || !arguments.session.device.empty() ||
                           arguments.session.link.side == link::Side::site;
    if (is_driven && !arguments.choice.has_seconds) work.options.seconds = until_stopped;
  }
  work.options.keep_records = !arguments.html.empty();
  work.options.log = arguments.choice.run.log;
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
                                    {"the recording", arguments.recording}};
  const auto add = [&read](const scene::RobotChoice& robot) {
    read.push_back({"the robot", robot.urdf});
    read.push_back({"the robot's srdf file", robot.srdf});
  };
  add(work.scene.robot);
  for (const scene::OtherArm& partner : work.scene.partners) add(partner.robot);
  for (const scene::StaticModel& model : work.scene.models) read.push_back({"a model", model.file});
  host::require_apart(read, {{"--log", arguments.choice.run.log},
                             {"--report", arguments.report},
                             {"--html", arguments.html}});
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
  if (!arguments.programs.empty()) return arguments.programs == "two";
  return work.scene.apart && !work.options.log.ends_with(".mcap");
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
  std::vector<std::string> words{"station",
                                 work.scene.file,
                                 "--impaired",
                                 "--link=" + session.link.where,
                                 "--domain=" + std::to_string(session.link.domain),
                                 "--rate=" + std::to_string(work.options.rate_hz),
                                 "--seconds=1e6"};
  for (const scene::Change& change : work.scene.changes) {
    words.push_back("--set=" + change.path + "=" + change.value);
  }
  if (!session.link.key_file.empty()) words.push_back("--key=" + session.link.key_file);
  if (session.link.no_key) words.emplace_back("--no-key");
  if (!session.device.empty()) {
    words.push_back("--device=" + session.device);
    session.device.clear();
  }
  session.link.side = link::Side::site;
  return std::make_unique<runs::StationProgram>(std::move(words));
}

/// A whole scene, its robot's side, or a recording.
int run_session(const Arguments& arguments, const Work& work) {
  const runs::Recording* recording = work.recording ? &*work.recording : nullptr;
  runs::SessionOptions session = arguments.session;
  for (const std::string& file : arguments.choice.hands) {
    session.tracks.push_back(runs::read_hand_track(file));
  }
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
  const int ended_with = runs::exit_status(result);
  return is_whole || ended_with == 3 ? ended_with : 4;
}

/// Everything that a run of the scene does before its first tick.
int check(const Work& work) {
  runs::RunOptions options = work.options;
  options.seconds = 0.0;
  options.fast = true;
  const auto prepared = runs::prepare(work.scene, options);
  const runs::RunResult result = runs::run(*prepared, {}, host::interruption(), [](auto&&) {});
  for (const std::string& warning : result.warnings) {
    std::fprintf(stderr, "teleop: warning: %s\n", warning.c_str());
  }
  std::printf("%s: sound: %zu arm%s, %zu parts, %d pairs, %s Hz\n", work.scene.file.c_str(),
              result.arms.size(), result.arms.size() == 1 ? "" : "s",
              prepared->cell.world().parts().size(), result.pairs,
              to_text(options.rate_hz).c_str());
  return host::has_printed() ? 0 : 4;
}

int list() {
  for (const auto& [name, file] : shipped_scenes()) {
    std::printf("%-16s %s\n", name.c_str(), about_scene(file).c_str());
  }
  return host::has_printed() ? 0 : 4;
}

int list_faults() {
  for (const faults::Fault& fault : faults::all_faults()) {
    if (faults::can_be_had(fault)) std::printf("%-10s  %s\n", to_text(fault.kind), fault.name);
  }
  return host::has_printed() ? 0 : 4;
}

int print_schema() {
  std::printf("%s\n", scene::schema().c_str());
  return host::has_printed() ? 0 : 4;
}

int make_key(const std::string& file) {
  runs::make_link_key(file);
  std::printf(
      "%s: a new key. Bring it to the other machine, as by scp, and keep it from others; then: "
      "--key FILE on both sides\n",
      file.c_str());
  return host::has_printed() ? 0 : 4;
}

int execute(const Arguments& arguments) {
  if (arguments.command == Command::key) return make_key(arguments.key_file);
  if (arguments.command == Command::list) return arguments.faults ? list_faults() : list();
  if (arguments.schema) return print_schema();
  const Work work = work_of(arguments);
  if (arguments.command == Command::check) return check(work);
  require_files_apart(arguments, work);
  if (arguments.command == Command::station) return run_station(arguments, work);
  return run_session(arguments, work);
}

}  // namespace
}  // namespace repel::teleop

int main(int argc, char** argv) {
  using namespace repel;
  return host::start(argc, argv, "teleop",
                     "Drives a simulated arm through a world of virtual walls.", 1,
                     teleop::describe, teleop::execute, teleop::reword);
}
