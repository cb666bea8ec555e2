#include "session.hpp"

#include <unistd.h>

#include <any>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include <repel/link/link_thread.hpp>
#include <repel/network/modules/spaceball.hpp>

#include "listening.hpp"
#include "log.hpp"
#include "mcap_log.hpp"
#include "part_file.hpp"
#ifdef REPEL_TELEOP_VISUAL
#include "arm_inputs_info.hpp"
#include "live_view.hpp"
#endif

namespace repel::teleop {
namespace {

/// How many ticks the log may lag behind: a few seconds.
constexpr std::size_t log_room = 2048;

/// The log of a run: file, format and writing thread.
class RunLog {
 public:
  RunLog(Tap& tap, const Heading& heading, const scene::Scene& scene, const RunOptions& options)
      : part_(options.log),
        log_(options.log.ends_with(".mcap") ? mcap_log(part_.name(), heading, scene, options)
                                            : csv_log(part_.name(), heading)),
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
                     "allowed: a CSV file, or one program, --together");
  }
  void open(const LinkChoice& choice, const scene::Scene& scene) {
    thread_.emplace(link, open_link(choice, scene));
  }
  /// Nothing passes any more. @return what did
  [[nodiscard]] LinkResult close() {
    thread_->stop();
    return link_result(link, thread_->name(), thread_->foreign(), thread_->unsent());
  }

  network::RemoteLink link;

 private:
  std::optional<link::LinkThread> thread_;
};

#ifdef REPEL_TELEOP_VISUAL
/// What is not covered of the meshes, for display.
std::vector<visual::GapsInfo> gaps_info_of(const std::vector<scene::Gaps>& gaps) {
  std::vector<visual::GapsInfo> infos;
  for (std::size_t i = 0; i < gaps.size(); ++i) {
    if (gaps[i].count == 0) continue;
    visual::GapsInfo& info = infos.emplace_back();
    info.part = PartId{static_cast<std::int32_t>(i)};
    info.count = gaps[i].count;
    for (const scene::Gap& gap : gaps[i].deepest) info.deepest.push_back({gap.p_M, gap.depth});
  }
  return infos;
}

visual::SceneInfo scene_info_of(const PreparedRun& prepared, const Heading& heading,
                                const Recording* recording) {
  const scene::Scene& scene = prepared.scene;
  const Cell& cell = prepared.cell;
  const RunOptions& options = prepared.options;
  visual::SceneInfo info;
  info.gaps = gaps_info_of(prepared.gaps);
  info.scene = scene.name;
  info.rate_hz = options.rate_hz;
  info.replay = recording != nullptr;
  info.duration = info.replay ? options.seconds : 0.0;
  const auto spare =
      cell.loose().subspan(scene.loose.size(), static_cast<std::size_t>(scene.spare.count));
  info.spare.assign(spare.begin(), spare.end());
  for (std::size_t i = 0; i < heading.arms.size(); ++i) {
    const ArmHeading& arm = heading.arms[i];
    visual::ArmInfo& added = info.arms.emplace_back();
    added.name = arm.name;
    added.tool = arm.tool;
    added.links = arm.links;
    for (const JointType type : arm.joints) {
      added.joints.emplace_back(type == JointType::revolute ? "revolute" : "prismatic");
    }
    added.modules = arm.modules;
    added.phases = arm.phases;
    for (const network::Phase& phase : scene.arm_setup(i).script) {
      const double rate = std::abs(phase.lever_rate);
      if (rate > added.max_lever_rate) added.max_lever_rate = rate;
    }
    for (const scene::Module& module : scene.arm_setup(i).network.modules) {
      const auto* ball = std::any_cast<network::SpaceballOptions>(&module.options);
      if (ball == nullptr) continue;
      added.max_speed = ball->saturation;
      added.max_turn = ball->angular_saturation;
    }
    note_inputs(scene.arm_setup(i).network, added);
  }
  return info;
}

/// The live view and its server, for as long as this object exists.
class View {
 public:
  View(const visual::SceneInfo& info, const World& world, Tap& tap, Controls& controls,
       const SessionOptions& session, const std::string& device)
      : show_(info, world, tap, controls, device,
              !session.view_only && (device.empty() || session.page_drives)),
        server_(options_of(session), visual::load_assets(session.page), show_) {
    announce(session, server_.url());
  }

 private:
  static visual::ServerOptions options_of(const SessionOptions& session) {
    const Place place = place_of(session.listen).value_or(Place{});
    visual::ServerOptions options;
    options.address = place.address;
    options.port = place.port;
    options.secret = session.secret;
    return options;
  }

  LiveView show_;
  visual::Server server_;
};
#endif

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
  std::unique_ptr<PreparedRun> prepared =
      prepare(scene, options, recording, remote ? &remote->link : nullptr);
  require_passive_grip(device, prepared->cell.network(0));
  Attachments attached{nullptr, nullptr, device.link.get(), recording, nullptr, &at_once};
  if (remote) {
    remote->open(session.link, scene);
    attached.remote = &remote->link;
  }
  const auto run_once = [&] {
    RunResult result = run(*prepared, attached, stop, show);
    if (remote) result.link = remote->close();
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
  controls.over_device = session.page_drives;
  controls.may_change = !options.log.ends_with(".mcap");
  std::optional<RunLog> log;
  if (!options.log.empty()) log.emplace(tap, heading, prepared->scene, options);
#ifdef REPEL_TELEOP_VISUAL
  std::optional<View> view;
  if (session.view) {
    attached.controls = &controls;
    view.emplace(scene_info_of(*prepared, heading, recording), prepared->cell.world(), tap,
                 controls, session, device.name);
  }
#else
  if (session.view) {
    throw SetupError("the live view is not built in; to have it: apt-get install libboost-dev");
  }
#endif
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

}  // namespace repel::teleop
