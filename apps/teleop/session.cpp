#include "session.hpp"

#include <charconv>
#include <cstdio>
#include <memory>
#include <optional>

#include "cell.hpp"
#include "log.hpp"
#include "mcap_log.hpp"
#ifdef REPEL_TELEOP_VISUAL
#include "live_show.hpp"
#endif

namespace repel::teleop {
namespace {

/// Ticks that the log may be behind: some seconds of them.
constexpr std::size_t log_room = 2048;

struct Place {
  std::string address;
  std::uint16_t port = 0;
};

std::optional<Place> place_of(const std::string& listen) {
  const std::size_t colon = listen.rfind(':');
  if (colon == std::string::npos || colon == 0) return std::nullopt;
  Place place{listen.substr(0, colon), 0};
  if (place.address.front() == '[' && place.address.back() == ']') {
    place.address = place.address.substr(1, place.address.size() - 2);
  }
  const char* begin = listen.data() + colon + 1;
  const char* end = listen.data() + listen.size();
  const auto [last, error] = std::from_chars(begin, end, place.port);
  if (error != std::errc() || last != end || begin == end) return std::nullopt;
  return place;
}

std::unique_ptr<TickLog> log_for(const std::string& path, const Heading& heading,
                                 const scene::Scene& scene, const RunOptions& options) {
  if (path.empty()) return nullptr;
  if (path.ends_with(".mcap")) return mcap_log(path, heading, scene, options);
  return csv_log(path, heading);
}

#ifdef REPEL_TELEOP_VISUAL
visual::Cast cast_of(const scene::Scene& scene, const RunOptions& options, const Heading& heading,
                     const Recording* recording) {
  visual::Cast cast;
  cast.scene = scene.name;
  cast.rate_hz = options.rate_hz;
  cast.replay = recording != nullptr;
  cast.duration = cast.replay ? options.seconds : 0.0;
  for (std::size_t i = 0; i < heading.arms.size(); ++i) {
    const ArmHeading& arm = heading.arms[i];
    visual::ArmCast& added = cast.arms.emplace_back();
    added.name = arm.name;
    added.tool = arm.tool;
    added.links = arm.links;
    for (const JointType type : arm.joints) {
      added.joints.emplace_back(type == JointType::revolute ? "revolute" : "prismatic");
    }
    added.modules = arm.modules;
    added.phases = arm.phases;
    for (const scene::Module& module : scene.station(i).network.modules) {
      const auto* ball = std::get_if<network::SpaceballOptions>(&module.options);
      if (ball == nullptr) continue;
      added.max_speed = ball->saturation;
      added.max_turn = ball->angular_saturation;
    }
  }
  return cast;
}

/// The server and what it shows, for as long as it exists.
class View {
 public:
  View(const visual::Cast& cast, const World& world, Tap& tap, Controls& controls,
       const SessionOptions& session, const std::string& device)
      : show_(cast, world, tap, controls, device),
        server_(options_of(session), visual::load_assets(session.page), show_) {
    std::fprintf(stderr, "Live view: %s\n", server_.url().c_str());
  }

 private:
  static visual::ServerOptions options_of(const SessionOptions& session) {
    const Place place = place_of(session.listen).value_or(Place{});
    const bool loopback = place.address.starts_with("127.") || place.address == "::1";
    if (!loopback) {
      std::fprintf(stderr, "Whoever reaches %s can look on and drive.\n", session.listen.c_str());
    }
    visual::ServerOptions options;
    options.address = place.address;
    options.port = place.port;
    return options;
  }

  LiveShow show_;
  visual::Server server_;
};
#endif

}  // namespace

std::string listen_complaint(const std::string& listen) {
  return place_of(listen) ? "" : "'" + listen + "'; allowed: ADDRESS:PORT, as 127.0.0.1:8448";
}

RunResult run_session(const scene::Scene& scene, const RunOptions& options,
                      const SessionOptions& session, const Recording* recording,
                      const std::atomic<bool>& stop,
                      const std::function<void(const Progress&)>& show) {
  const Device device = open_device(session.device);
  if (!session.view && options.log.empty()) {
    return run(scene, options, {nullptr, nullptr, device.link.get(), recording}, stop, show);
  }
  const scene::Scene ready = as_run(scene, options);
  const Cell cell(ready, options.backend != "ideal");
  const Heading heading = heading_of(ready, cell, options.rate_hz);
  TapOptions tap_options;
  tap_options.arms = static_cast<int>(heading.arms.size());
  tap_options.log = options.log.empty() ? 0 : log_room;
  Tap tap(cell.world, tap_options);
  Controls controls;
  controls.may_restart = options.log.empty();
  Company company{&tap, nullptr, device.link.get(), recording};
  const std::unique_ptr<TickLog> log = log_for(options.log, heading, scene, options);
  std::optional<LogThread> writing;
  if (log != nullptr) writing.emplace(tap.log(), *log);
#ifdef REPEL_TELEOP_VISUAL
  std::optional<View> view;
  if (session.view) {
    company.controls = &controls;
    view.emplace(cast_of(ready, options, heading, recording), cell.world, tap, controls, session,
                 device.name);
  }
#else
  if (session.view) {
    throw SetupError("the live view is not built in; to have it: apt-get install libboost-dev");
  }
#endif
  RunResult result = run(scene, options, company, stop, show);
  while (result.begins_anew) {
    controls.restart = false;
    result = run(scene, options, company, stop, show);
  }
  if (writing) {
    result.log_dropped = writing->close();
    const std::string& failure = writing->failure();
    if (!failure.empty()) result.warnings.push_back("the log ends early: " + failure);
  }
  return result;
}

}  // namespace repel::teleop
