// SPDX-License-Identifier: BSD-3-Clause
#include <repel/runs/engine/session.hpp>

#include <unistd.h>

#include <cstdio>
#include <memory>
#include <optional>

#include <repel/host/part_file.hpp>
#include <repel/link/link_thread.hpp>
#include <repel/runs/records/log.hpp>
#include <repel/runs/records/mcap_log.hpp>
#include <repel/runs/view/view.hpp>

namespace repel::runs {
namespace {

/// How many ticks the log may lag behind: a few seconds.
constexpr std::size_t log_room = 2048;

/// The log of a run: file, format and writing thread.
class RunLog {
 public:
  RunLog(Tap& tap, const Heading& heading, const PreparedRun& prepared, const RunOptions& options,
         BesideTicks& beside)
      : part_(options.log),
        log_(options.log.ends_with(".mcap")
                 ? mcap_log(part_.name(), heading, prepared.scene, options, prepared.cell,
                            prepared.shown, beside)
                 : csv_log(part_.name(), heading, !options.fast)),
        thread_(tap.log(), *log_, [this](const std::string& trouble) { note(trouble); }) {}

  /// Completes the file and moves it to its target, or keeps the incomplete temporary file.
  void close(RunResult& result) {
    result.log_dropped = thread_.close();
    if (trouble_.empty()) {
      try {
        part_.put_in_place();
      } catch (const SetupError& error) {
        note(error.what());
      }
    } else {
      part_.keep();
    }
    result.log_trouble = trouble_;
  }

 private:
  /// Printed on a new line; clears the status line on a terminal.
  void note(const std::string& trouble) {
    trouble_ = trouble;
    const char* before = isatty(STDERR_FILENO) != 0 ? "\r\033[K" : "";
    std::fprintf(stderr, "%steleop: the log is not whole: %s; the run goes on\n", before,
                 trouble.c_str());
  }

  std::string trouble_;  ///< written by the thread, read after it has ended
  host::PartFile part_;
  std::unique_ptr<TickLog> log_;
  LogThread thread_;
};

/// The end of the link to the station.
class RemoteEnd {
 public:
  RemoteEnd(const scene::Scene& scene, const RunOptions& options) : link(remote_options(scene)) {
    if (!options.log.ends_with(".mcap")) return;
    throw SetupError("--log " + options.log +
                     ": what a station sent is not in a recording, so it could not be replayed; "
                     "allowed: a CSV file, or one program, --programs one");
  }
  void open(const LinkChoice& choice, const scene::Scene& scene) {
    thread_.emplace(link, open_link(choice, scene));
    say_exposure(*thread_);
  }
  /// Nothing passes any more. What did is noted.
  void close(LinkResult& result) {
    thread_->stop();
    note_link(link, *thread_, result);
  }

  network::RemoteLink link;

 private:
  std::optional<link::LinkThread> thread_;
};

}  // namespace

RunResult run_session(const scene::Scene& scene, const RunOptions& options,
                      const SessionOptions& session, const Recording* recording,
                      const std::atomic<bool>& stop, const std::atomic<bool>& at_once,
                      const std::function<void(const Progress&)>& show) {
  if (!scene.cameras.empty() && !options.fast && options.log.ends_with(".mcap")) {
    throw SetupError("--log " + options.log +
                     ": by the clock no two runs see the same, so a recording of a scene with a "
                     "camera could not be replayed; allowed: with --fast, or a CSV file");
  }
  const Device device = open_device(session.device);
  std::optional<RemoteEnd> remote;
  if (session.link.side) remote.emplace(scene, options);
  if (remote) faults::require_no_operator(options.faults);
  std::unique_ptr<PreparedRun> prepared =
      prepare(scene, options, recording, remote ? &remote->link : nullptr);
  require_passive_grip(device, prepared->cell.network(0));
  Attachments attached{nullptr, nullptr, device.link.get(), recording, nullptr, &at_once};
  attached.on_tick = session.on_tick;
  attached.hands = session.hands;
  if (session.tracks.size() > prepared->cell.arms()) {
    throw SetupError(std::to_string(session.tracks.size()) + " hands for " +
                         std::to_string(prepared->cell.arms()) +
                         " arms; allowed: at most one for each",
                     scene.file);
  }
  attached.tracks = session.tracks;
  if (remote) {
    remote->open(session.link, scene);
    attached.remote = &remote->link;
  }
  const auto run_once = [&] {
    RunResult result = run(*prepared, attached, stop, show);
    if (!remote) return result;
    remote->close(*result.link);
    if (!result.link->exposure.empty()) result.warnings.push_back(result.link->exposure);
    return result;
  };
  if (!session.view && options.log.empty()) return run_once();
  const Heading heading = heading_of(prepared->scene, prepared->cell);
  TapOptions tap_options;
  tap_options.arms = static_cast<int>(heading.arms.size());
  tap_options.log = options.log.empty() ? 0 : log_room;
  Tap tap(prepared->cell.world(), tap_options);
  attached.tap = &tap;
  Controls controls;
  controls.may_restart = options.log.empty() && !remote;
  if (remote) controls.no_driving = "the operator is at the station";
  controls.over_device = session.page_drives;
  controls.may_change = !options.log.ends_with(".mcap");
  BesideTicks beside;
  std::optional<RunLog> log;
  if (!options.log.empty()) log.emplace(tap, heading, *prepared, options, beside);
  if (options.log.ends_with(".mcap")) attached.beside = &beside;
  std::unique_ptr<View> view;
  if (session.view) {
    attached.controls = &controls;
    // To pages at a site, the station is the master.
    view = open_view(*prepared, heading, recording != nullptr, tap, controls, session,
                     remote ? "The station" : device.name);
  }
  const auto run_controlled = [&] {
    controls.changes.open(&prepared->cell.changes());
    RunResult result = run_once();
    controls.changes.open(nullptr);
    return result;
  };
  RunResult result = run_controlled();
  while (result.begins_anew) {
    controls.restart = false;
    prepared = prepare(scene, options, recording);
    result = run_controlled();
  }
  if (log) log->close(result);
  return result;
}

}  // namespace repel::runs
